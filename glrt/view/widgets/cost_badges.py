"""Tags for the cost of an edit, at the right edge of a row of the panel."""

from imgui_bundle import hello_imgui, imgui

from glrt.settings import Cost
from glrt.view.controls import MEANING, Control

# Hues distinguish the classes in both themes; each is shown with the word for its class.
COLORS = {
    Cost.FREE: (0.30, 0.66, 0.36, 1.0),
    Cost.RELIGHT: (0.30, 0.58, 0.90, 1.0),
    Cost.RESTART: (0.85, 0.58, 0.13, 1.0),
    Cost.RECOMPILE: (0.88, 0.36, 0.36, 1.0),
}


def legend() -> None:
    """Draw the classes of cost and their meanings."""
    for cost, meaning in MEANING.items():
        imgui.text_colored(COLORS[cost], cost.value)
        imgui.same_line(hello_imgui.em_size(5.5))
        imgui.text_wrapped(meaning)


def tag(cost: Cost) -> None:
    """Draw the cost of an edit at the right edge; in a new line if the label leaves no room."""
    end = imgui.get_item_rect_max().x - imgui.get_window_pos().x + hello_imgui.em_size(0.5)
    own = _tags_end() - imgui.calc_text_size(cost.value).x
    if end <= own:
        imgui.same_line(max(end, tags_start()))
    else:
        imgui.set_cursor_pos_x(own)
    imgui.text_colored(COLORS[cost], cost.value)


def tags(control: Control) -> None:
    if len(control.costs) == 1:
        return tag(control.cost)
    return _tags_below(control)


def _tags_below(control: Control) -> None:
    """Draw a line of costs that depend on the value."""
    imgui.indent()
    for number, (cost, where) in enumerate(control.costs):
        if number:
            imgui.same_line()
        imgui.text_colored(COLORS[cost], f"{cost.value} {where}")
    imgui.unindent()


def tags_start() -> float:
    """Return where the widest tag begins, in pixels from the window's left edge."""
    return _tags_end() - max(imgui.calc_text_size(cost.value).x for cost in Cost)


def _tags_end() -> float:
    """Return the right edge of the panel's content, in pixels from the window's left edge."""
    style = imgui.get_style()
    return imgui.get_window_width() - style.scrollbar_size - style.window_padding.x
