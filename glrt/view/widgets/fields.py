"""Widgets for controls, with the cost of an edit: a value in, the edited value out."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from imgui_bundle import hello_imgui, imgui

from glrt.settings import Cost
from glrt.view.controls import MEANING, Control, Kind
from glrt.view.widgets.cost_badges import tags
from glrt.view.widgets.explanations import explanation_of
from glrt.view.widgets.finder import FINDER
from glrt.view.widgets.reset import by_gestures, gesture_texts
from glrt.view.widgets.rows import LEAST, THREE, WORDS, Row
from glrt.view.widgets.slider_text import Slider, share_of, text_next_to_grip
from glrt.view.widgets.steady_widget import ANCHOR
from glrt.view.widgets.tips import explain

_MOST_DIGITS = 20  # of an integer: more are beyond any limit, and Python reads 4300 at most
_LEAST: dict[Kind, float] = {"choice": WORDS, "vector": THREE, "color": THREE, "switch": 0.0}
_MOST_ROWS = 14  # of a list without scrolling
_TOLD = 8.0  # em: from the left edge of a list to the explanations of its words
_NO_TOOLTIP = imgui.ColorEditFlags_.no_tooltip.value
_LOGARITHMIC = imgui.SliderFlags_.logarithmic.value


def edited(control: Control, value: Any, name: str = "") -> Any:
    """Draw the widget of a control; return the new value, or None if it was not touched.

    `name` distinguishes controls with the same label, such as those of two lamps.
    """
    label = f"{control.label}##{name}" if name else control.label
    if FINDER.lists(label, control, value):
        return None
    corner, told = imgui.get_cursor_screen_pos(), _told(control)
    row = Row(control.label, _LEAST.get(control.kind, LEAST))
    drawn = _by_label(control, imgui.get_id(label), value)
    explain(told)
    below = row.draw(lambda: _draw(control, label, value))
    below = by_gestures(below, control, 0, value, is_label=False)
    tip(told, imgui.get_id(label))
    tags(control.costs)
    FINDER.mark(label, corner)
    changed, new = drawn if drawn[0] else below
    return _clamped(control, new) if changed else None


def compact(control: Control, value: Any, width: float) -> Any:
    """Draw the same widget alone, `width` pixels wide: its tooltip has the costs."""
    imgui.set_next_item_width(width)
    drawn = _draw(control, f"##{control.label}", value)
    changed, new = by_gestures(drawn, control, 0, value, is_label=False)
    explain(_told(control))
    return _clamped(control, new) if changed else None


def _by_label(control: Control, widget: int, value: Any) -> tuple[bool, Any]:
    """Return what a gesture on the label drawn last does; a click on that of a switch turns it."""
    if control.kind == "switch":
        return imgui.is_item_clicked(), not value
    return by_gestures((False, value), control, widget, value, is_label=True)


def button(label: str, is_enabled: bool = True) -> bool:
    """Draw a button, grey unless it is enabled; return whether it was pressed."""
    if FINDER.lists(label):
        return False
    imgui.begin_disabled(not is_enabled)
    pressed = imgui.button(label)
    ANCHOR.note()
    FINDER.mark(label)
    imgui.end_disabled()
    return pressed


def named(label: str, value: str, name: str) -> str:
    """Draw a box for a name; return a new name once its input ends, else ""."""
    flags = imgui.InputTextFlags_.auto_select_all.value

    def draw() -> tuple[str, bool]:
        _, text = imgui.input_text(f"{label}##{name}", value, flags)
        return text, imgui.is_item_deactivated_after_edit()

    text, is_done = Row(label, WORDS).draw(draw)
    ANCHOR.note()
    tags(((Cost.FREE, ""),))
    return text.strip() if is_done and text.strip() != value else ""


def beside(text: str) -> None:
    """Continue in this line if a button with this text fits there."""
    imgui.same_line()
    width = imgui.calc_text_size(text).x + 2 * imgui.get_style().frame_padding.x
    if imgui.get_content_region_avail().x < width:
        imgui.new_line()


def tip(text: str, widget: int = 0) -> None:
    """Show a tooltip, in short lines, when the mouse rests on the item drawn last.

    `widget`: see `Anchor.note`.
    """
    ANCHOR.note(widget)
    explain(text)


def _told(control: Control) -> str:
    """Return the text of a control's tooltip: what it does, its unit and its costs."""
    help_text = control.help[:1].upper() + control.help[1:]
    unit = f" [{control.unit}]" if control.unit else ""
    costs = (
        f"{cost.value} {where}".strip() + f": {MEANING[cost]}" for cost, where in control.costs
    )
    why = explanation_of(control)
    return "\n".join(
        [f"{help_text}{unit}", *gesture_texts(control), *costs, *(["", why] if why else [])]
    )


def _draw(control: Control, label: str, value: Any) -> tuple[bool, Any]:
    if control.kind == "switch":
        return imgui.checkbox(label, value)
    if control.kind == "choice":
        if control.told:
            return _choice_text(control, label, value)
        words = map(str, control.choices)
        names = [word.lower() if word in ("True", "False") else word for word in words]
        chosen = control.choices.index(value)
        changed, index = imgui.combo(label, chosen, names, min(len(names), _MOST_ROWS))
        return changed, control.choices[index]
    if control.kind == "color":
        return _color(control, label, value)
    if control.kind == "vector":
        changed, parts = imgui.drag_float3(label, list(value), 0.01, format="%.3f")
        return changed, tuple(parts)
    return _number(control, label, value)


def _choice_text(control: Control, label: str, value: Any) -> tuple[bool, Any]:
    """Draw a list that explains each of its words."""
    chosen = value
    if not imgui.begin_combo(label, str(value), imgui.ComboFlags_.height_large.value):
        return False, value
    for word, told in zip(control.choices, control.told, strict=True):
        imgui.push_id(word)
        if imgui.selectable(word, word == value)[0]:
            chosen = word
        if word == value and imgui.is_window_appearing():
            imgui.set_item_default_focus()
        imgui.same_line(max(0.0, hello_imgui.em_size(_TOLD)))
        imgui.text_disabled(told)
        imgui.pop_id()
    imgui.end_combo()
    return chosen != value, chosen


def _color(control: Control, label: str, value: Any) -> tuple[bool, Any]:
    if control.high is None or control.high > 1:
        return _radiance(label, value)
    changed, parts = imgui.color_edit3(label, list(value), imgui.ColorEditFlags_.float.value)
    return changed, tuple(parts)


def _radiance(label: str, value: Any) -> tuple[bool, Any]:
    """Draw three numbers of any size and a patch of their hue, which a click changes."""
    name, brightest = label.partition("##")[0], max(*value, 0.0) or 1.0
    patch, room = imgui.get_frame_height(), imgui.get_style().item_inner_spacing.x
    imgui.push_id(label)
    imgui.begin_group()
    imgui.set_next_item_width(imgui.calc_item_width() - patch - room)
    changed, parts = imgui.drag_float3(
        f"##{name}", list(value), 0.005 * brightest, 0.0, 0.0, "%.3g"
    )
    imgui.same_line(0.0, room)
    if hue := _hue([part / brightest for part in value]):
        changed, parts = True, [brightest * part for part in hue]
    imgui.end_group()
    imgui.pop_id()
    return changed, tuple(parts)


def _hue(hue: list[float]) -> list[float] | None:
    """Draw a patch of a colour; return the hue picked after a click on it, largest part 1."""
    if imgui.color_button("hue", [*hue, 1.0], _NO_TOOLTIP):
        imgui.open_popup("picker")
    picked = False
    if imgui.begin_popup("picker"):
        picked, hue = imgui.color_picker3("##picker", hue, imgui.ColorEditFlags_.float.value)
        imgui.end_popup()
    return [part / max(*hue, 1e-6) for part in hue] if picked else None


def _number(control: Control, label: str, value: Any) -> tuple[bool, Any]:
    """Draw a slider over the useful range; after Ctrl and a click, any number can be typed."""
    flags = _LOGARITHMIC if control.is_logarithmic else 0
    if control.slider is None:
        return _free_number(control, label, value)
    low, high = control.slider
    if control.kind == "integer":
        form = _text_next_to_grip(control, "%d", value)
        return imgui.slider_int(label, value, int(low), int(high), form, flags)
    form = _text_next_to_grip(control, "%.3g", value)
    return imgui.slider_float(label, value, float(low), float(high), form, flags)


def _text_next_to_grip(control: Control, form: str, value: float) -> str:
    low, high = control.slider or (0.0, 1.0)
    width, grip = imgui.calc_item_width(), imgui.get_style().grab_min_size
    if control.kind == "integer":
        grip = max(grip, width / (high - low + 1))
    share = share_of(value, low, high, control.is_logarithmic)
    text, space = (imgui.calc_text_size(part).x for part in (form % value, " "))
    return text_next_to_grip(form, Slider(width, grip, share), text, space)


def _free_number(control: Control, label: str, value: Any) -> tuple[bool, Any]:
    if control.kind == "integer":
        return _typed_integer(label, value)
    return imgui.drag_float(label, value, max(abs(value) * 0.005, 1e-6), format="%.4g")


def _typed_integer(label: str, value: int) -> tuple[bool, int]:
    """Draw a text box for an integer: the integers of Dear ImGui end at 2^31."""
    flags = imgui.InputTextFlags_.chars_decimal | imgui.InputTextFlags_.enter_returns_true
    changed, text = imgui.input_text(label, str(value), int(flags))
    digits = text[:_MOST_DIGITS]
    return changed and text.isdecimal(), int(digits) if digits.isdecimal() else value


def _clamped(control: Control, value: Any) -> Any:
    """Return the nearest valid value: a typed one may be out of range."""
    if isinstance(value, tuple):
        return tuple(_clamped(control, part) for part in value)
    if isinstance(value, bool | str):
        return value
    low = -math.inf if control.low is None else control.low
    high = math.inf if control.high is None else control.high
    near = max(low, min(value, high))
    return int(near) if isinstance(value, int) else float(str(np.float32(near)))


def edited_fields(
    controls: tuple[Control, ...], values: Mapping[str, Any], name: str = "", opened: Any = None
) -> dict[str, Any]:
    """Draw the widgets of several fields; return the edited fields with their new values.

    `opened` has the fields as the scene was opened; a double click on a widget goes back to them.
    """
    before = dict(opened) if opened else {}
    drawn = {c.name: edited(c.back_to(before.get(c.name)), values[c.name], name) for c in controls}
    return {field: value for field, value in drawn.items() if value is not None}
