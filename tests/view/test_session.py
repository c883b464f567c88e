"""What the window edits, without a window: edits, costs, previews, and the time of a frame."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import moderngl
import pytest

from glrt.errors import RenderError, SceneError
from glrt.gpu.context import Context
from glrt.methods.light_layers import NONE, ONE
from glrt.rendering import renderer, tracer
from glrt.rendering.film import Film
from glrt.rendering.renderer import Renderer
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Cost, settings_for
from glrt.view.state.controls import replaced
from glrt.view.state.frame_budget import LEAST, FrameBudget
from glrt.view.state.preview_size import STILL
from glrt.view.state.session import ANNOUNCED, FIRST_SAMPLES, Session
from tests.support.builders import MATTE, lamp, sphere
from tests.support.mixed_scene import everything


class Clock:
    """Time that passes as told: each reading of the clock costs a step."""

    def __init__(self) -> None:
        self.now, self.step = 100.0, 0.001

    def __call__(self) -> float:
        self.now += self.step
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """The one by which dispatches are timed, too: on a busy machine a frame could take several."""
    clock = Clock()
    for module in (renderer, tracer):
        monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=clock))
    return clock


@pytest.fixture
def session(context: Context, clock: Clock) -> Iterator[Session]:
    scene = everything()
    settings = settings_for(scene.render, width=16, height=16, bounces=3, samples=1000)
    opened = Session(scene, settings, context, clock)
    with context.gl:
        yield opened
        opened.release()


def start(session: Session) -> None:
    for _ in range(ANNOUNCED + 1):
        session.advance(0.01)


def aside(scene: Scene) -> Scene:
    camera = scene.camera
    x, y, z = camera.position
    return replaced(scene, camera=replaced(camera, position=(x + 0.01, y, z)))


def test_the_first_frames_announce_the_kernel(session: Session) -> None:
    session.advance(0.01)
    assert "Compiling" in session.busy
    assert session.samples == 0
    start(session)
    assert session.busy == ""
    assert session.samples > 0


def test_edits_of_a_frame_cost_one_restart(session: Session) -> None:
    start(session)
    before = session.restarts
    session.edit(seed=1)
    session.edit(bounces=2)
    session.edit(aside(session.scene))
    session.advance(0.01)
    assert session.restarts == before + 1
    assert session.last_cost is Cost.RESTART


def test_a_free_edit_loses_no_sample(session: Session) -> None:
    start(session)
    samples = session.samples
    session.edit(exposure=1.0)
    session.edit(samples=2000)
    session.advance(0.01)
    assert session.samples > samples
    assert session.last_cost is Cost.FREE


def test_an_edit_that_is_taken_back_within_a_frame_costs_nothing(session: Session) -> None:
    start(session)
    samples = session.samples
    session.edit(method="naive")
    session.advance(0.01)
    assert session.busy
    session.undo()
    session.advance(0.01)
    assert session.busy == ""
    assert session.samples > samples


def test_a_refused_setting_is_told_and_changes_nothing(session: Session) -> None:
    start(session)
    before = session.state
    session.edit(bounces=-1)
    assert "bounces" in session.problem
    assert session.state == before
    assert not session.history.can_undo


def test_what_the_renderer_refuses_is_told_and_the_old_scene_goes_on(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise SceneError("too many shapes")

    start(session)
    before, samples = session.state, session.samples
    with monkeypatch.context() as patch:
        patch.setattr(Renderer, "update", refuse)
        session.edit(aside(session.scene))
        session.advance(0.01)
    assert session.problem == "too many shapes"
    assert session.state == before
    session.advance(0.01)
    assert session.samples > samples


def test_a_count_of_samples_for_each_frame_is_kept(session: Session) -> None:
    start(session)
    samples = session.samples
    session.advance(10.0, count=3)
    assert session.samples == samples + 3


def test_rendering_ends_at_the_target(session: Session) -> None:
    start(session)
    session.restart()
    session.edit(samples=5)
    for _ in range(5):
        session.advance(1.0)
    assert session.samples == 5
    assert session.is_done


def test_a_paused_session_shows_one_sample_of_what_is_new(session: Session) -> None:
    start(session)
    session.paused = True
    session.edit(seed=9)
    for _ in range(3):
        session.advance(1.0)
    assert session.samples == 1
    assert session.is_done
    session.paused = False
    assert not session.is_done


def test_a_moving_camera_is_shown_coarsely_when_samples_are_slow(
    session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    start(session)
    clock.step = 0.02
    with monkeypatch.context() as patch:
        patch.setattr(Renderer, "advance", lambda renderer, *_: renderer.step(1))
        session.restart()
        for _ in range(FIRST_SAMPLES):
            session.advance(0.01)  # learns that a sample takes twice the time of a frame
    session.edit(aside(session.scene), "camera")
    session.advance(0.01)
    assert session.renderer
    assert session.is_preview
    assert session.renderer.size == (8, 8)
    assert session.settings.width == 16, "what the user asked for stays"
    clock.now += STILL
    session.advance(0.01)
    assert not session.is_preview
    assert session.renderer.size == (16, 16)


def test_a_fast_renderer_moves_at_full_size(session: Session) -> None:
    start(session)
    session.edit(aside(session.scene), "camera")
    session.advance(0.1)
    assert not session.is_preview


def test_light_is_weighed_without_a_restart(session: Session) -> None:
    start(session)
    samples, restarts = session.samples, session.restarts
    session.edit(with_lights(session.scene, {"lamp": 0.0}))
    assert session.cost_of_light("lamp") is Cost.RELIGHT
    session.advance(0.01)
    assert session.last_cost is Cost.RELIGHT
    assert session.samples > samples
    assert session.restarts == restarts
    assert session.weights != (ONE,)


def test_bounces_are_weighed_while_their_control_is_open(session: Session) -> None:
    start(session)
    session.by_length = True
    assert session.cost_of_light("lamp") is Cost.RESTART
    assert session.cost_of_fewer_bounces() is Cost.RELIGHT
    start(session)
    restarts, samples = session.restarts, session.samples
    session.edit(bounces=1)
    session.advance(0.01)
    assert (session.restarts, session.last_cost) == (restarts, Cost.RELIGHT)
    assert session.samples > samples
    assert session.weights == (ONE, ONE, NONE, NONE)
    session.alone = 2
    assert session.weights == (NONE, NONE, ONE, NONE)
    session.by_length = False
    start(session)
    assert session.restarts == restarts + 1
    assert session.settings.bounces == 1


def test_without_compute_another_light_restarts(context: Context, clock: Clock) -> None:
    """A fragment shader keeps no layers, and the session says so."""
    scene = everything()
    settings = settings_for(scene.render, width=16, height=16, bounces=3, samples=1000)
    session = Session(scene, settings, context, clock, pipeline="fragment")
    with context.gl:
        start(session)
        assert session.renderer
        assert session.renderer.pipeline == "fragment"
        session.by_length = True
        edits: list[dict[str, Any]] = [
            {"scene": with_lights(scene, {"lamp": 0.5})},
            {"bounces": 2},
        ]
        for edit in edits:
            restarts = session.restarts
            assert session.cost_of_light("lamp") is Cost.RESTART
            assert session.cost_of_fewer_bounces() is Cost.RESTART
            session.edit(**edit)
            start(session)
            assert (session.restarts, session.last_cost) == (restarts + 1, Cost.RESTART)
        assert not session.problem
        session.release()


def test_layers_that_are_too_wide_for_the_driver_are_not_kept(session: Session) -> None:
    session.room.largest = 40  # pixels: two layers of 16 fit side by side, three do not
    start(session)
    assert not session.lacks_room
    assert session.renderer
    assert session.renderer.plan.layers == 2
    session.by_length = True
    start(session)
    assert session.lacks_room
    assert session.renderer.plan.layers == 0
    assert session.cost_of_fewer_bounces() is Cost.RESTART
    session.by_length = False
    session.edit(width=24)
    start(session)
    assert session.lacks_room
    assert session.cost_of_light("lamp") is Cost.RESTART
    session.edit(with_lights(session.scene, {"lamp": 0.5}))
    session.advance(0.01)
    assert session.last_cost is Cost.RESTART
    assert session.samples > 0
    session.edit(width=16)
    start(session)
    assert session.renderer.plan.layers == 2
    assert session.problem == ""


@pytest.mark.parametrize("is_open", [False, True])
def test_layers_that_the_driver_has_no_memory_for_are_not_kept(
    session: Session, monkeypatch: pytest.MonkeyPatch, is_open: bool
) -> None:
    texture = Film._texture

    def poor(film: Film, across: int, down: int) -> moderngl.Texture:
        if across * down > 1000:
            raise RenderError("no room on the driver")
        return texture(film, across, down)

    if is_open:
        session.edit(width=8, height=8)
        start(session)
    with monkeypatch.context() as patch:
        patch.setattr(Film, "_texture", poor)
        session.edit(width=16, height=16)
        start(session)
        assert session.renderer
        assert session.renderer.size == (16, 16)
        assert session.renderer.plan.layers == 0
        assert session.lacks_room
        assert (session.problem, session.samples > 0) == ("", True)
        session.edit(width=64)
        start(session)
        assert "no room" in session.problem
        assert session.renderer.size == (16, 16)
        assert session.samples > 0


def test_undo_brings_back_scene_and_settings(session: Session) -> None:
    start(session)
    opened = session.state
    session.edit(aside(session.scene), "camera")
    session.edit(aside(session.scene), "camera")
    session.edit(bounces=1)
    session.undo()
    assert session.settings.bounces == 3
    session.undo()
    assert session.state == opened
    session.redo()
    assert session.scene.camera.position[0] == pytest.approx(opened.scene.camera.position[0] + 0.02)


def test_another_scene_can_be_opened(session: Session) -> None:
    start(session)
    ball = {"camera": Camera(position=(0, 0, 3), look_at=(0, 0, 0)).model_dump()}
    other = everything([sphere([0, 0, 0], 1, "l")], materials={"l": lamp(), "m": MATTE}, **ball)
    session.edit(other)
    start(session)
    assert session.problem == ""
    assert session.renderer
    assert session.renderer.scene == other


def test_a_pace_leaves_the_window_its_time() -> None:
    pace = FrameBudget(10)
    assert pace.seconds == pytest.approx(0.1)
    for _ in range(60):
        pace.record(frame=0.1, rendering=0.07)
    assert pace.seconds == pytest.approx(0.07, abs=1e-6)
    for _ in range(60):
        pace.record(frame=0.5, rendering=0.1)
    assert pace.seconds == pytest.approx(LEAST / 10)
