"""A double click that sets the default of a control."""

from typing import Any

from imgui_bundle import imgui

from glrt.view.controls import Control


def can_reset(control: Control) -> bool:
    """Whether a double click resets a control; two clicks on a switch leave it as it was."""
    return control.default is not None and control.kind != "switch"


def reset_or(drawn: tuple[bool, Any], control: Control, is_label: bool) -> tuple[bool, Any]:
    """The default after a double click on a label or slider; else what was drawn.

    On other widgets a double click has a meaning of its own, such as to type a number.
    """
    is_slider = control.slider is not None and control.kind in ("integer", "number")
    is_meant = can_reset(control) and (is_label or is_slider) and imgui.is_item_hovered()
    if not is_meant or not imgui.is_mouse_double_clicked(0):
        return drawn
    imgui.internal.clear_active_id()  # else the slider goes back to the mouse
    return True, control.default


def default_text(control: Control) -> list[str]:
    """A line of the tooltip about the default; none if there is none."""
    if not can_reset(control):
        return []
    parts = control.default if isinstance(control.default, tuple) else (control.default,)
    told = ", ".join(f"{part:.3g}" if isinstance(part, float) else str(part) for part in parts)
    return [f"A double click sets the default: {told}"]
