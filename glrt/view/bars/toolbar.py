"""Bar above the picture: files, the view, and what is changed most often."""

from collections.abc import Callable
from functools import partial
from typing import Any

from imgui_bundle import ImVec2, hello_imgui, imgui
from imgui_bundle import icons_fontawesome_4 as icons

from glrt.view.app import App
from glrt.view.bars.camera_menu import draw_camera_menu, open_camera_menu
from glrt.view.controls import Control
from glrt.view.panels.compare import VIEW
from glrt.view.panels.shortcuts import COMMANDS
from glrt.view.state.keys import MEANING, Action, label
from glrt.view.tabs.kept import SETTINGS
from glrt.view.widgets.fields import compact
from glrt.view.widgets.tips import explain

BUTTONS: dict[str, Action] = {
    "open": "open",
    "save": "save_scene",
    "export": "export",
    "undo": "undo",
    "redo": "redo",
    "pause": "pause",
    "fit": "fit",
    "find": "palette",
    "keys": "keys",
}
ICONS = {"undo": icons.ICON_FA_UNDO, "redo": icons.ICON_FA_REDO, "pause": icons.ICON_FA_PAUSE}
CHOICES = ("method", "exposure")
_NO_UNDO = "Nothing to undo: nothing was edited since the scene was opened"
_NO_REDO = "Nothing to redo: nothing was undone since the last edit"
_ALSO_GREY = int(imgui.HoveredFlags_.allow_when_disabled)
_ICON = 1.1  # em, of the widest of them
_WIDTH = 5.6  # em, of a list or a slider


def draw_toolbar(app: App) -> None:
    """Draw as many widgets as the picture has room for, in one line."""
    line = _Line()
    for text, action in BUTTONS.items():
        line.draw(_width_of(text), partial(_button, app, text, action))
    line.draw(_width_of("camera"), partial(_camera, app))
    _choice(line, VIEW, app.show.view, partial(_look, app))
    for name in CHOICES:
        _choice(
            line, SETTINGS[name], getattr(app.session.settings, name), partial(_edit, app, name)
        )


def _look(app: App, view: Any) -> None:
    app.show.view = view


def _edit(app: App, name: str, value: Any) -> None:
    app.session.edit(gesture=f"{[name]}", **{name: value})


class _Line:
    """A line of widgets that ends where there is no room for the next one."""

    def __init__(self) -> None:
        self._left, self._is_first = imgui.get_content_region_avail().x, True

    def draw(self, width: float, widget: Callable[[], None]) -> None:
        self._left -= width + imgui.get_style().item_spacing.x
        if self._left < 0:
            return
        if not self._is_first:
            imgui.same_line()
        self._is_first = False
        widget()


def _button(app: App, text: str, action: Action) -> None:
    """Draw the button of an action, grey where the action has nothing to do."""
    width = _width_of(text)
    if icon := ICONS.get(text):
        is_paused = action == "pause" and app.session.paused
        text = f"{icons.ICON_FA_PLAY if is_paused else icon}###{text}"
    imgui.begin_disabled(not _is_useful(app, action))
    if imgui.button(text, ImVec2(width, 0.0)):
        COMMANDS[action](app)
    imgui.end_disabled()
    if imgui.is_item_hovered(_ALSO_GREY):  # two scenes are compared for the texts of undo
        keys = " or ".join(map(label, app.preferences.bindings[action]))
        told = _told(app, action)
        explain(f"{told} ({keys})" if keys else told)


def _camera(app: App) -> None:
    """Draw the button of the menu of views, and the menu."""
    if imgui.button("camera"):
        open_camera_menu()
    draw_camera_menu(app)
    explain("See a side of the scene, a view that was kept, or by a camera of a file")


def _is_useful(app: App, action: Action) -> bool:
    """Whether an action does something at present."""
    history = app.session.history
    if action == "undo":
        return history.can_undo
    return history.can_redo if action == "redo" else True


def _told(app: App, action: Action) -> str:
    """Return what an action does at present, or why it does nothing."""
    if action == "undo":
        return app.session.undoes or _NO_UNDO
    if action == "redo":
        return app.session.redoes or _NO_REDO
    return MEANING[action]


def _choice(line: _Line, control: Control, value: Any, use: Callable[[Any], None]) -> None:
    """Draw a widget behind its name; `use` takes a new value."""
    width = hello_imgui.em_size(_WIDTH)

    def draw() -> None:
        imgui.align_text_to_frame_padding()
        imgui.text_disabled(control.label)
        imgui.same_line()
        new = compact(control, value, width)
        if new is not None:
            use(new)

    name = imgui.calc_text_size(control.label).x + imgui.get_style().item_spacing.x
    line.draw(name + width, draw)


def _width_of(text: str) -> float:
    written = hello_imgui.em_size(_ICON) if text in ICONS else imgui.calc_text_size(text).x
    return float(written + 2 * imgui.get_style().frame_padding.x)
