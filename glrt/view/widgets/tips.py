"""Tooltips in short lines."""

from imgui_bundle import ImVec2, hello_imgui, imgui

_WIDTH = 28.0  # em
_GAP = 0.5  # em, from the panel to a tooltip at its side
_NARROW = 0.5  # of the display's width: panels below that have their tooltips at their side
_RESTS = imgui.HoveredFlags_.for_tooltip.value


def explain(text: str) -> None:
    """Show a tooltip when the mouse rests on the item drawn last, unless a button is down.

    Items of the panels have it at the side of the panel, where it covers no other row.
    """
    if imgui.is_mouse_down(0) or not imgui.is_item_hovered(_RESTS):
        return
    _place()
    if imgui.begin_tooltip():
        imgui.push_text_wrap_pos(hello_imgui.em_size(_WIDTH))
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()


def _place() -> None:
    """Place the next tooltip to the left of a panel, else to its right, at the item drawn last."""
    screen, corner, size = (
        imgui.get_main_viewport(),
        imgui.get_window_pos(),
        imgui.get_window_size(),
    )
    is_panel = size.x < _NARROW * screen.size.x and size.y > _NARROW * screen.size.y
    gap, width = hello_imgui.em_size(_GAP), hello_imgui.em_size(_WIDTH)
    if not is_panel:
        return
    top = imgui.get_item_rect_min().y
    if corner.x - screen.pos.x > width + gap:
        left, pivot = corner.x - gap, 1.0
    else:
        left, pivot = corner.x + size.x + gap, 0.0
    imgui.set_next_window_pos(ImVec2(left, top), imgui.Cond_.always.value, ImVec2(pivot, 0.0))
