"""Tour of five steps for newcomers; it is closed for ever, or until the next start."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.controls import replaced
from glrt.view.widgets.boxes import box
from glrt.view.widgets.fields import button, tip

STEPS = (
    (
        "Look around",
        "Drag in the picture to turn about the pivot, use the wheel to come nearer, W A S D to "
        "walk. The picture is coarse while it moves. Home goes back to the first view. F6 and the "
        "arrow keys move in the panel instead, Escape goes back.",
    ),
    (
        "Change the light",
        "Drag the intensity or a colour in the tab Light. The mark next to each control shows what "
        "an edit costs. Ring with a dot: all samples stay. Disk: they are discarded. Square: a "
        "kernel is compiled first.",
    ),
    (
        "Edit objects",
        "Click an object: it is outlined, its handles move it, and the panel shows its "
        "material. The button add, in the tab Scene, makes a new object. Everything can be undone "
        "by Ctrl-Z.",
    ),
    (
        "Ask a pixel",
        "P, then a click, shows the paths of a pixel and why it is bright; Escape, twice, ends "
        "that. I shows its values, Ctrl and the wheel zoom.",
    ),
    (
        "Keep what you have",
        "Ctrl-S saves the scene, Ctrl-E the picture, which carries the recipe to make it "
        "again. Below the picture stand its error, and when it will be small enough.",
    ),
)
_WIDTH = 22.0  # em, the height of a letter
_BELOW = 4.2  # em: from the top of the window, so that the toolbar stays in sight
_LEAST = 14.0  # em: least width of lines next to the box


def draw_tour(app: App) -> None:
    """Draw the present step in a box upper right, above the picture, which stays usable."""
    if not app.preferences.tour or app.tour_step is None:
        return
    area = imgui.get_main_viewport()
    place = area.pos + ImVec2(area.size.x - hello_imgui.em_size(1), hello_imgui.em_size(_BELOW))
    size = area.size.x, area.size.y
    when = imgui.Cond_.appearing if size == app.tour_beside else imgui.Cond_.always
    app.tour_beside = size
    imgui.set_next_window_pos(place, when.value, ImVec2(1.0, 0.0))
    imgui.set_next_window_size(ImVec2(hello_imgui.em_size(_WIDTH), 0.0))
    title, text = STEPS[app.tour_step]
    number = f"{app.tour_step + 1} of {len(STEPS)}"
    flags = imgui.WindowFlags_.no_focus_on_appearing.value
    with box(f"{title} ({number})###tour", flags, has_title=True) as drawn:
        if drawn.is_shown:
            below = imgui.get_cursor_pos_y() + _tallest(imgui.get_content_region_avail().x)
            imgui.text_wrapped(text)
            imgui.set_cursor_pos_y(below + imgui.get_style().item_spacing.y)
            _answers(app, app.tour_step)
    if not drawn.is_open:
        app.tour_step = None


def _tallest(width: float) -> float:
    """Return the height of the longest text, so that the buttons stay in place between steps."""
    return max(imgui.calc_text_size(text, wrap_width=width).y for _, text in STEPS)


def _answers(app: App, step: int) -> None:
    is_last = step + 1 == len(STEPS)
    if button("finish###next" if is_last else "next###next"):
        app.tour_step = None if is_last else step + 1
        if is_last:
            app.prefer(replaced(app.preferences, tour=False))
    imgui.same_line()
    if button("back", step > 0):
        app.tour_step = step - 1
    imgui.same_line()
    if button("do not show again"):
        app.prefer(replaced(app.preferences, tour=False))
    tip("Tick tour in the tab Window to see it again; x closes it until then")
