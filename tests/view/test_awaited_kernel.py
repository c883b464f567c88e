"""An edit that needs another kernel waits while another process compiles it; nothing stops."""

from collections.abc import Callable
from threading import Event
from typing import Any

import pytest

from glrt.plan.plan import Layering
from glrt.settings import settings_for
from glrt.view import edit_compiler
from glrt.view.edit_compiler import begin_for
from glrt.view.edits.edited_state import State
from glrt.view.kernel_notes import Driver
from glrt.view.scene_compiler import Part
from glrt.view.state.awaited_kernel import PAUSE, AwaitedKernel
from glrt.view.state.session import ANNOUNCED, Session
from tests.support.mixed_scene import everything
from tests.support.sessions import Clock, frames, start, walked


class Compiling:
    """A process that compiles for as long as a test wants."""

    def __init__(self, state: State) -> None:
        self.state, self.is_over, self.is_ended = state, False, False
        self.learned: list[float] = []

    def end(self) -> None:
        self.is_ended = True

    def learn(self, seconds: float) -> None:
        self.learned.append(seconds)


@pytest.fixture
def begun(session: Session, clock: Clock) -> list[Compiling]:
    """The processes that were begun for a session with a picture."""
    start(session)
    found: list[Compiling] = []

    def begin(state: State, _layering: Layering, _tree: object) -> Compiling:
        found.append(Compiling(state))
        return found[-1]

    session.ahead = AwaitedKernel(begin, clock)
    return found


def test_the_old_picture_stays_until_the_kernel_is_there(
    session: Session, begun: list[Compiling]
) -> None:
    before = session.restarts
    session.edit(method="naive")
    frames(session, ANNOUNCED + 20)
    assert "Compiling" in session.busy
    assert (session.restarts, len(begun)) == (before, 1)
    assert begun[0].state.settings.method == "naive"
    begun[0].is_over = True
    frames(session, 1)
    assert session.renderer
    assert session.renderer.settings.method == "naive"
    assert session.busy == ""
    assert begun[0].learned == [session.taken]


def test_a_move_of_the_camera_compiles_nothing_and_ends_no_process(
    session: Session, begun: list[Compiling]
) -> None:
    session.edit(walked(session.scene))
    frames(session, 2)
    assert begun == []
    session.edit(method="naive")
    frames(session, ANNOUNCED + 1)
    session.edit(session.opened.scene)
    frames(session, 3)
    assert len(begun) == 1
    assert not begun[0].is_ended


def test_undo_ends_the_process(session: Session, begun: list[Compiling]) -> None:
    session.edit(method="naive")
    frames(session, ANNOUNCED + 1)
    session.undo()
    frames(session, 1)
    assert begun[0].is_ended
    assert session.busy == ""


def test_one_kernel_after_the_other_is_compiled_after_a_pause_alone(
    session: Session, begun: list[Compiling], clock: Clock
) -> None:
    session.edit(method="naive")
    frames(session, ANNOUNCED + 1)
    session.edit(method="nee")
    frames(session, 2)
    assert begun[0].is_ended
    assert len(begun) == 1
    clock.now += PAUSE
    frames(session, 1)
    assert [one.state.settings.method for one in begun] == ["naive", "nee"]


def test_a_view_waits_for_the_kernel_of_its_aovs(session: Session, begun: list[Compiling]) -> None:
    samples = session.samples
    session.aovs = ("depth",)
    frames(session, 3)
    assert [one.state.settings.aov for one in begun] == [("depth",)]
    assert session.samples == samples
    begun[0].is_over = True
    frames(session, 3)
    assert session.renderer
    assert session.renderer.settings.aov == ("depth",)
    assert session.samples > samples


def test_a_kernel_is_compiled_once_for_each_window_and_driver(
    tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    parts: list[Part] = []

    def compile_for(part: Part, _goes_on: object) -> bool:
        parts.append(part)
        return True

    monkeypatch.setattr(edit_compiler, "compile_for", compile_for)
    scene = everything()

    def compiled(method: Any, version: str = "") -> int:
        state = State(scene, settings_for(scene.render, method=method))
        driver = Driver("llvmpipe", "compute", version)
        work = begin_for(lambda: driver, state, "groups", None)
        work._thread.join()
        assert work.is_over
        return len(parts)

    assert [compiled("nee"), compiled("nee"), compiled("naive")] == [1, 1, 2]
    assert compiled("nee", "another") == 3


def test_a_process_that_nobody_waits_for_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, is_there = everything(), Event()

    def compile_for(_part: Part, goes_on: Callable[[], object]) -> bool:
        is_there.wait(100)
        goes_on()
        pytest.fail("nobody waits for it")

    monkeypatch.setattr(edit_compiler, "compile_for", compile_for)
    state = State(scene, settings_for(scene.render, method="whitted"))
    driver = Driver("no driver of this name", "compute")
    work = begin_for(lambda: driver, state, "none", None)
    work.end()
    is_there.set()
    work._thread.join(100)
    assert work.is_over
    assert work._note is None
