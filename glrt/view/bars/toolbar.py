"""Bar above the picture: files, the view, and what is changed most often."""

from collections.abc import Callable
from functools import partial
from typing import Any

from imgui_bundle import hello_imgui, imgui

from glrt.view.app import App
from glrt.view.controls import Control
from glrt.view.panels.compare import VIEW
from glrt.view.panels.panel import SETTINGS
from glrt.view.panels.shortcuts import COMMANDS
from glrt.view.state.keys import MEANING, Action, label
from glrt.view.widgets.fields import compact
from glrt.view.widgets.tips import explain

BUTTONS: dict[str, Action] = {
    "open": "open",
    "save": "save_scene",
    "save picture": "save",
    "home": "home",
    "fit": "fit",
    "find": "palette",
    "keys": "keys",
}
CHOICES = ("method", "exposure")
_WIDTH = 7.0  # em, of a list or a slider


def draw_toolbar(app: App) -> None:
    """Draw as many widgets as the picture has room for, in one line."""
    line = _Line()
    for text, action in BUTTONS.items():
        line.draw(_width_of(text), partial(_button, app, text, action))
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
    if imgui.button(text):
        COMMANDS[action](app)
    keys = " or ".join(map(label, app.preferences.bindings[action]))
    explain(f"{MEANING[action]} ({keys})" if keys else MEANING[action])


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
    return float(imgui.calc_text_size(text).x + 2 * imgui.get_style().frame_padding.x)
