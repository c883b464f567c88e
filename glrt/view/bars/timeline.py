"""Strip below the picture of an animated scene: playback, frames, and keys of a value."""

import time
from functools import partial

from imgui_bundle import ImVec2, hello_imgui, imgui
from imgui_bundle import icons_fontawesome_4 as icons

from glrt.core.text import escaped
from glrt.view.app import App
from glrt.view.edits.keyframes import (
    Keys,
    frames_of_keys,
    last_frame,
    target_of,
    values_with_keys,
    without_key,
)
from glrt.view.panels.shortcuts import COMMANDS
from glrt.view.timeline import Timeline
from glrt.view.widgets.tips import explain

_PLAY, _VALUE, _LEAST = 2.2, 11.0, 6.0  # em: the button, the list of values, the slider
_MARK = (1.0, 0.65, 0.1, 1.0)  # of a key
_SAME = 1e-3  # frames


def height_of_timeline(app: App) -> float:
    """Return the height of the strip with the space above it, in pixels; 0 without one."""
    return float(imgui.get_frame_height_with_spacing()) if app.timeline.is_shown else 0.0


def draw_timeline(app: App) -> None:
    """Draw the strip in one line, if there is one."""
    line, scene = app.timeline, app.session.scene
    if not line.is_shown:
        return
    icon = icons.ICON_FA_PAUSE if line.is_playing else icons.ICON_FA_PLAY
    imgui.begin_disabled(scene.animation is None)
    if imgui.button(f"{icon}###play", ImVec2(hello_imgui.em_size(_PLAY), 0.0)):
        line.play(time.perf_counter())
    imgui.end_disabled()
    explain("Plays the animation, or stops it")
    imgui.same_line()
    space = imgui.get_style().item_spacing.x
    told = line.text(scene)
    buttons = sum(map(_width, ("set key", "delete key"))) + 2 * space
    right = imgui.calc_text_size(told).x + hello_imgui.em_size(_VALUE) + buttons + 2 * space
    left = imgui.get_content_region_avail().x
    has_room = left - right > hello_imgui.em_size(_LEAST)
    _slider(app, left - right * has_room)
    if has_room:
        imgui.same_line()
        imgui.text_disabled(told)
        imgui.same_line()
        _keys(app)


def _slider(app: App, width: float) -> None:
    line, scene = app.timeline, app.session.scene
    last = last_frame(scene)
    imgui.set_next_item_width(width)
    moved, frame = imgui.slider_int("##frame", line.frame, 0, last, "frame %d")
    explain("Frame that is shown; yellow marks are keys. It is no edit of the scene")
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    grip = imgui.get_style().grab_min_size / 2
    painter, color = imgui.get_window_draw_list(), imgui.get_color_u32(_MARK)
    for key in frames_of_keys(scene, line.chosen):
        x = low.x + grip + (high.x - low.x - 2 * grip) * min(key / last, 1.0)
        painter.add_line(ImVec2(x, high.y - 0.35 * (high.y - low.y)), ImVec2(x, high.y), color, 2.0)
    if moved:
        line.is_playing = False
        line.show(frame)


def _keys(app: App) -> None:
    """Draw the list of values, and the buttons that set a key and delete it."""
    line, scene = app.timeline, app.session.scene
    values = values_with_keys(scene, app.selected)
    if line.chosen not in values:
        line.chosen = None
    imgui.set_next_item_width(hello_imgui.em_size(_VALUE))
    if imgui.begin_combo("##value", _text(line.chosen) if line.chosen else "value"):
        for each in values:
            mark = " *" if each in scene.moved else ""
            if imgui.selectable(f"{_text(each)}{mark}", each == line.chosen)[0]:
                line.chosen = each
        imgui.end_combo()
    explain("Value that gets keys: of the selected object, its material, camera and light; *: has")
    keys = line.chosen
    imgui.same_line()
    imgui.begin_disabled(keys is None)
    if imgui.button("set key") and keys:
        COMMANDS["set_key"](app)
    imgui.end_disabled()
    explain("Keeps the present value at this frame; undo takes it back")
    imgui.same_line()
    imgui.begin_disabled(not _has_key(app, line))
    if imgui.button("delete key") and keys:
        app.edit_scene("", partial(without_key, keys=keys, frame=line.frame))
    imgui.end_disabled()


def _has_key(app: App, line: Timeline) -> bool:
    frames = frames_of_keys(app.session.scene, line.chosen) if line.chosen else []
    return any(abs(frame - line.frame) < _SAME for frame in frames)


def _text(keys: Keys) -> str:
    return str(escaped(target_of(keys)))


def _width(text: str) -> float:
    return float(imgui.calc_text_size(text).x + 2 * imgui.get_style().frame_padding.x)
