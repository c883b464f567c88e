"""Gestures on the label of a control: a double click sets a value back, a drag changes it."""

from typing import Any

from imgui_bundle import imgui

from glrt.view.controls import Control
from glrt.view.widgets.scrub import SCRUB, can_scrub


def can_reset(control: Control) -> bool:
    """Whether a double click resets a control; two clicks on a switch leave it as it was."""
    return control.default is not None and control.kind != "switch"


def by_gestures(
    drawn: tuple[bool, Any], control: Control, widget: int, value: Any, is_label: bool
) -> tuple[bool, Any]:
    """Return the result of a gesture on the item drawn last; without one, what was drawn.

    A double click on a label or a slider sets the default; on other widgets it has a meaning of
    its own, such as to type a number. A drag on a label changes the value. `widget` is the id of
    the item, `is_label` whether the mouse is over its label, if it is over the item.
    """
    is_slider = control.slider is not None and control.kind in ("integer", "number")
    is_meant = can_reset(control) and (is_label or is_slider) and imgui.is_item_hovered()
    if is_meant and imgui.is_mouse_double_clicked(0):
        imgui.internal.clear_active_id()  # else the slider goes back to the mouse
        SCRUB.stop()
        return True, control.default
    moved = SCRUB.follow(control, widget, value, is_label)
    return drawn if moved is None else (True, moved)


def gesture_texts(control: Control) -> list[str]:
    """Return lines of the tooltip about these gestures; none for a control that has none."""
    dragged = ["A drag on the label changes it"] if can_scrub(control) else []
    if control.slider is not None:
        dragged.append("Ctrl and a click: type a value")
    if not can_reset(control):
        return dragged
    parts = control.default if isinstance(control.default, tuple) else (control.default,)
    told = ", ".join(f"{part:.3g}" if isinstance(part, float) else str(part) for part in parts)
    sets = "goes back to the scene's value" if control.is_of_scene else "sets the default"
    return [*dragged, f"A double click on the label {sets}: {told}"]
