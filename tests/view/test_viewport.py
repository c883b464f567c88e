"""The mouse over the picture, in frames that are slower than the hand; no window is opened."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from imgui_bundle import ImVec2, imgui

from glrt.core.resources import folder
from glrt.image.sources import load
from glrt.scene.scenefile.catalog import find
from glrt.settings import Settings
from glrt.view.files import Files
from glrt.view.messages import SHOWN, Messages
from glrt.view.panels import shortcuts, viewport
from glrt.view.state.preferences import Preferences
from glrt.view.state.zoom import FIT


class Turned:
    """Stands for the window: remembers how far the mouse turned the camera."""

    def __init__(self) -> None:
        self.preferences = Preferences()
        self.turns: list[tuple[float, float]] = []
        self.steps: list[tuple[float, float, float]] = []
        self.awaited = None
        self.is_deaf = self.navigates = self.was_busy = self.has_list_keys = False
        self.shows_start = False
        self.exports = SimpleNamespace(unless_under_way=lambda act: act())  # none is under way

    def turn(self, across: float, down: float, about_camera: bool) -> None:
        assert not about_camera
        self.turns.append((across, down))

    def walk(self, right: float, up: float, forward: float, seconds: float) -> None:
        self.steps.append((right, up, forward))

    def keep_view(self, number: int) -> None:
        raise AssertionError(f"view {number} is kept")

    def recall_view(self, number: int) -> None:
        raise AssertionError(f"view {number} is recalled")


@pytest.fixture
def io() -> Iterator[imgui.IO]:
    context = imgui.create_context()
    io = imgui.get_io()
    io.display_size = ImVec2(1000.0, 500.0)
    io.delta_time = 0.1
    io.backend_flags |= imgui.BackendFlags_.renderer_has_textures.value
    io.set_ini_filename("")
    yield io
    imgui.destroy_context(context)


def frame(app: Turned) -> None:
    """A frame whose picture fills the window."""
    imgui.new_frame()
    imgui.set_next_window_pos(ImVec2(0.0, 0.0))
    imgui.set_next_window_size(imgui.get_io().display_size)
    imgui.begin("Picture")
    imgui.set_cursor_screen_pos(ImVec2(0.0, 50.0))
    imgui.invisible_button("picture", ImVec2(1000.0, 450.0), viewport._EVERY_BUTTON)
    viewport._mouse(app, ImVec2(0, 0), ImVec2(900, 500))  # type: ignore[arg-type]
    imgui.end()
    imgui.render()


def moved(app: Turned, io: imgui.IO, *events: tuple[float, float] | bool) -> None:
    """A frame after these events: the mouse is at a place, or its left button goes down or up."""
    for event in events:
        if isinstance(event, bool):
            io.add_mouse_button_event(0, event)
        else:
            io.add_mouse_pos_event(*event)
    frame(app)


def test_a_quick_move_and_a_click_within_a_frame_leave_the_camera_alone(io: imgui.IO) -> None:
    app = Turned()
    moved(app, io, (900.0, 490.0))
    frame(app)
    moved(app, io, (400.0, 300.0), True)
    moved(app, io, False)
    assert app.turns == []


def test_a_drag_turns_from_where_the_button_went_down(io: imgui.IO) -> None:
    app = Turned()
    moved(app, io, (900.0, 490.0))
    frame(app)
    moved(app, io, (400.0, 300.0), True)
    moved(app, io, (500.0, 350.0))
    moved(app, io, False)
    assert app.turns == [(0.1, 0.1)]


@pytest.mark.parametrize("is_open", [False, True])
def test_arrows_in_an_open_list_leave_the_camera_alone(io: imgui.IO, is_open: bool) -> None:
    app: Any = Turned()
    io.add_key_event(imgui.Key.down_arrow, True)
    imgui.new_frame()
    imgui.begin("Controls")
    if is_open:
        imgui.open_popup("list")
    shortcuts.draw_keys(app)
    imgui.end()
    imgui.render()
    assert app.steps == ([] if is_open else [(0.0, 0.0, -1.0)])


def struck(app: Any, io: imgui.IO, *events: tuple[imgui.Key, bool]) -> None:
    """A frame after keys went down or up, as the backend of GLFW reports them."""
    for key, is_down in events:
        if key == imgui.Key.left_ctrl:
            io.add_key_event(imgui.Key.mod_ctrl, is_down)
        io.add_key_event(key, is_down)
    imgui.new_frame()
    shortcuts.draw_keys(app)
    imgui.render()


@pytest.mark.parametrize("let_go", [(imgui.Key.left_ctrl, imgui.Key.q), (imgui.Key.left_ctrl,)])
def test_a_chord_that_ends_within_a_slow_frame_is_no_step(
    io: imgui.IO, let_go: tuple[imgui.Key, ...]
) -> None:
    """Ctrl is let go in the frame in which Q comes, and Q in it or in a later one."""
    app: Any = Turned()
    closed: list[bool] = []
    app.leave = None
    app.files = SimpleNamespace(close=lambda leave: closed.append(True))
    app.session = SimpleNamespace(history=SimpleNamespace(settle=lambda: None))
    struck(app, io)
    struck(app, io, (imgui.Key.left_ctrl, True))
    struck(app, io, (imgui.Key.q, True), *((key, False) for key in let_go))
    assert closed == [True]
    for _ in range(3):
        struck(app, io)
    struck(app, io, (imgui.Key.q, False))
    assert app.steps == []
    struck(app, io)
    struck(app, io, (imgui.Key.q, True))
    assert app.steps == [(0.0, -1.0, 0.0)]


def test_a_wheel_turned_with_ctrl_let_go_in_the_same_frame_zooms(io: imgui.IO) -> None:
    app: Any = Turned()
    app.zoom, app.session = FIT, SimpleNamespace(settings=Settings())
    moved(app, io, (400.0, 300.0))
    io.add_key_event(imgui.Key.mod_ctrl, True)
    io.add_key_event(imgui.Key.left_ctrl, True)
    frame(app)
    io.add_mouse_wheel_event(0.0, 1.0)
    io.add_key_event(imgui.Key.mod_ctrl, False)
    io.add_key_event(imgui.Key.left_ctrl, False)
    frame(app)
    assert app.zoom != FIT


def files(folder: Path, source: str = "") -> Files:
    """The open files, without a session's renderer."""
    session: Any = SimpleNamespace(scene=load("cornell"), problem="", settings=Settings())
    recent = folder / "recent.json"
    return Files(session, Messages(session), source, recent, lambda _: None, lambda _: None)


def test_a_file_that_is_there_is_not_what_a_window_saves_to_by_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("scene.toml", "picture.png", "picture-2.png"):
        Path(name).touch()
    opened = files(tmp_path)
    assert (opened.scene_path, opened.picture_path) == ("scene-2.toml", "picture-3.png")


def test_pictures_are_saved_next_to_what_is_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There their recipes find the files of the scene. Elsewhere it is the working folder."""
    away = tmp_path / "away"
    away.mkdir()
    monkeypatch.chdir(away)
    text = Path(find("cornell")).read_text()
    (tmp_path / "room.toml").write_text(text)
    (tmp_path / "picture.png").touch()
    assert files(tmp_path, f"{tmp_path}/room.toml").picture_path == f"{tmp_path}/picture-2.png"
    assert files(tmp_path, "../room.toml").picture_path == "../picture-2.png"
    assert files(tmp_path, "cornell").picture_path == "picture.png"
    (away / "here.toml").write_text(text)
    assert files(tmp_path, "here.toml").picture_path == "picture.png"


def test_a_scene_is_saved_to_the_file_that_it_came_from_and_to_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text((folder("scenes") / "cornell.toml").read_text())
    opened = files(tmp_path, "mine.toml")
    assert opened.scene_path == "mine.toml"
    monkeypatch.setattr(Files, "_take", lambda *_: None)
    opened.open("lamps")
    assert opened.scene_path == "scene.toml"
    opened.open("mine.toml")
    assert opened.scene_path == "mine.toml"


def test_a_message_goes_after_a_while_and_comes_back_when_it_is_reported_again() -> None:
    nobody: Any = None
    messages = Messages(nobody)
    assert messages.recent(messages.told + 1.0) == ""
    for _ in range(2):
        messages.report("Saved picture.png")
        assert messages.recent(messages.told + 0.5 * SHOWN) == "Saved picture.png"
        assert messages.recent(messages.told + 1.5 * SHOWN) == ""
