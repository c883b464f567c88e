"""Tooltips in short lines."""

from imgui_bundle import hello_imgui, imgui

_WIDTH = 28.0  # em


def explain(text: str) -> None:
    """Show a tooltip when the mouse rests on the item drawn last, unless a button is down."""
    if not imgui.is_mouse_down(0) and imgui.begin_item_tooltip():
        imgui.push_text_wrap_pos(hello_imgui.em_size(_WIDTH))
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()
