"""Light is weighed without a restart: what it costs, and where layers have no room."""

import math
from typing import Any

import moderngl
import pytest

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.plan.plan import NONE, ONE
from glrt.rendering.film import Film
from glrt.scene.scene import with_lights
from glrt.settings import Cost, settings_for
from glrt.view.state.costs import cost_of_light, reach_of_bounces
from glrt.view.state.session import Session
from tests.support.mixed_scene import everything
from tests.support.sessions import Clock, start


def test_light_is_weighed_without_a_restart(session: Session) -> None:
    start(session)
    samples, restarts = session.samples, session.restarts
    session.edit(with_lights(session.scene, {"lamp": 0.0}))
    assert cost_of_light(session, "lamp") is Cost.RELIGHT
    session.advance(0.01)
    assert session.last_cost is Cost.RELIGHT
    assert session.samples > samples
    assert session.restarts == restarts
    assert session.weights != (ONE,)


@pytest.mark.slow
def test_light_restarts_while_terms_of_light_are_shown(session: Session) -> None:
    """Weights do not reach the terms; the label says so."""
    session.aovs = ("direct",)
    start(session)
    assert cost_of_light(session, "lamp") is Cost.RESTART
    session.edit(with_lights(session.scene, {"lamp": 0.5}))
    session.advance(0.01)
    assert session.last_cost is Cost.RESTART
    assert session.weights == (ONE,)
    session.by_length = True
    assert reach_of_bounces(session) is None


def test_bounces_are_weighed_while_their_control_is_open(session: Session) -> None:
    start(session)
    session.by_length = True
    assert cost_of_light(session, "lamp") is Cost.RESTART
    assert reach_of_bounces(session)
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


@pytest.mark.usefixtures("dispatches_by_clock")
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
            assert cost_of_light(session, "lamp") is Cost.RESTART
            assert reach_of_bounces(session) is None
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
    assert reach_of_bounces(session) is None
    session.by_length = False
    session.edit(width=24)
    start(session)
    assert session.lacks_room
    assert cost_of_light(session, "lamp") is Cost.RESTART
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

    def poor(film: Film, size: tuple[int, int]) -> moderngl.Texture:
        if math.prod(size) > 1000:
            raise RenderError("no room on the driver")
        return texture(film, size)

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
        session.edit(width=4096)  # a preview of it, too, is too large
        start(session)
        assert "no room" in session.problem
        assert session.renderer.size == (16, 16)
        assert session.samples > 0
