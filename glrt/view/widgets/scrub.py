"""A drag on the label of a number or a colour, which changes the value."""

from typing import Any

from imgui_bundle import imgui

from glrt.view.controls import Control

_ACROSS = 300.0  # pixels of a drag over the range of a slider
_STEP = 0.005  # of a value, a pixel, where there is no range
_STOP = 100.0  # pixels that double the brightness of a colour, or halve it
_FINE, _COARSE = 0.1, 10.0  # with Alt, and with Shift


def can_scrub(control: Control) -> bool:
    """Whether a drag on its label changes a control: a number, an integer or a colour."""
    return control.kind in ("number", "integer", "color")


def after_drag(control: Control, value: Any, pixels: float) -> Any:
    """Return the value after a drag by so many pixels to the right, within the slider's range."""
    if control.kind == "color":
        return tuple(part * 2 ** (pixels / _STOP) for part in value)
    if control.slider is None:
        step = 1 / 4 if control.kind == "integer" else max(abs(value) * _STEP, 1e-6)
        moved = value + pixels * step
    else:
        low, high = control.slider
        if control.is_logarithmic and value > 0:
            moved = value * (high / low) ** (pixels / _ACROSS)
        else:
            moved = value + pixels * (high - low) / _ACROSS
        moved = max(min(low, value), min(moved, max(high, value)))
    return round(moved) if control.kind == "integer" else moved


class Scrub:
    """The drag on a label that is under way: from which value, and how far."""

    def __init__(self) -> None:
        """Begin without a drag."""
        self._widget: int | None = None
        self._value: Any = None
        self._pressed = 0.0  # when the button was pressed, in seconds of Dear ImGui
        self._pixels = 0.0
        self._has_moved = False

    def follow(self, control: Control, widget: int, value: Any, is_label: bool) -> Any:
        """Return the new value of the item drawn last while its label is dragged; else None.

        `widget` is its id. `is_label`: whether the mouse is over the label, if over the item.
        """
        if not can_scrub(control):
            return None
        io = imgui.get_io()
        if is_label and imgui.is_item_hovered():
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
            if imgui.is_mouse_clicked(0):
                self._widget, self._value = widget, value
                self._pressed = io.mouse_clicked_time[0]
                self._pixels, self._has_moved = 0.0, False
                return None
        if widget != self._widget:
            return None
        if not imgui.is_mouse_down(0) or io.mouse_clicked_time[0] != self._pressed:
            self.stop()
            return None
        self._has_moved |= imgui.is_mouse_dragging(0)
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        pace = _COARSE if io.key_shift else _FINE if io.key_alt else 1.0
        self._pixels += pace * io.mouse_delta.x
        moved = after_drag(control, self._value, self._pixels)
        return moved if self._has_moved and moved != value else None

    @property
    def is_under_way(self) -> bool:
        """Whether a label is dragged."""
        return self._widget is not None and bool(imgui.is_mouse_down(0))

    def stop(self) -> None:
        """End the drag."""
        self._widget = None


SCRUB = Scrub()  # of the mouse: there is only one
