"""The window's session without a window: edits, costs, and the time of a frame."""

import pytest

from glrt.core.errors import SceneError
from glrt.rendering.renderer import Renderer
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.settings import Cost, Settings
from glrt.view.controls import replaced
from glrt.view.edits.edited_state import plain
from glrt.view.edits.scene_edits import with_renamed_material
from glrt.view.state.frame_budget import LEAST, FrameBudget
from glrt.view.state.session import Session
from glrt.view.tabs.kept import SETTINGS
from tests.support.builders import MATTE, lamp, sphere
from tests.support.mixed_scene import everything
from tests.support.sessions import start


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


def test_the_film_of_the_window_has_the_samples_of_each_pixel_alone() -> None:
    """So a picture whose pixels share random numbers opens with others, and the list lacks them."""
    assert plain(Settings(sampler="shared")).sampler == "sobol"
    assert plain(Settings(sampler="sobol256")).sampler == "sobol256"
    others = ("sobol", "sobol64", "sobol256", "sobol1024", "independent")
    assert SETTINGS["sampler"].choices == others


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


def test_a_refused_setting_is_reported_and_changes_nothing(session: Session) -> None:
    start(session)
    before = session.state
    session.edit(bounces=-1)
    assert "bounces" in session.problem
    assert session.state == before
    assert not session.history.can_undo


def test_what_the_renderer_refuses_is_reported_and_the_old_scene_goes_on(
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


def test_renaming_is_free(session: Session) -> None:
    start(session)
    samples, restarts = session.samples, session.restarts
    name = next(iter(session.scene.materials))
    session.edit(with_renamed_material(session.scene, name, "another"))
    assert session.is_behind
    session.advance(0.01)
    assert not session.is_behind
    assert (session.last_cost, session.restarts) == (Cost.FREE, restarts)
    assert session.samples > samples
    session.undo()
    session.advance(0.01)
    assert (session.last_cost, session.restarts) == (Cost.FREE, restarts)
