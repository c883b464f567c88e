"""The history of views is prepared, so that the first edit does not wait for it."""

from typing import Any

import pytest

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import SurfacePass
from glrt.rendering.history.temporal import Mode, Temporal, Way
from glrt.settings import settings_for
from glrt.view.state.session import Session
from tests.support.sessions import Clock, start, walked


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_no_frame_does_all_that_the_next_edit_would_wait_for(
    context: Context, clock: Clock, dispatches_by_clock: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first sample, the surfaces of the view, and the passes of history are of four frames."""
    scene, done = load("lamps"), list[str]()
    settings = settings_for(scene.render, width=24, height=16, bounces=2, samples=64)
    fill, rehearse = SurfacePass.fill, Temporal._rehearse

    def filled(self: SurfacePass, *given: Any) -> None:
        done.append("surfaces")
        fill(self, *given)

    def rehearsed(self: Temporal, *given: Any) -> None:
        done.append("passes")
        rehearse(self, *given)

    monkeypatch.setattr(SurfacePass, "fill", filled)
    monkeypatch.setattr(Temporal, "_rehearse", rehearsed)
    with context.gl:
        session = Session(scene, settings, context, clock)
        session.moving.use(Way("reproject"))
        start(session)
        session.restart()
        while session.samples < 1:
            session.advance(0.01, count=1)
        done.clear()
        session.moving._temporal.surfaces.leave()
        session.moving._temporal._unprepared = [False, True]
        frames = []
        for _ in range(4):
            session.advance(0.01, count=1)
            frames.append(tuple(done))
            done.clear()
        assert frames == [("surfaces",), ("passes",), ("passes",), ()]
        session.release()


@pytest.mark.slow_cases("ataa")
@pytest.mark.parametrize("mode", ["reproject", "taa", "ataa", "wrls"])
def test_the_first_edit_waits_for_no_shader(
    context: Context,
    mode: Mode,
    clock: Clock,
    dispatches_by_clock: None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They are compiled with the first sample; and the picture is as it would be otherwise."""
    scene, compiled, pictures = load("lamps"), list[str](), []
    settings = settings_for(scene.render, width=24, height=16, bounces=2, samples=8)
    work = DrawnPass._compile

    def noted(self: DrawnPass, chosen: tuple[bool, ...]) -> Any:
        compiled.append(self._shader)
        return work(self, chosen)

    monkeypatch.setattr(DrawnPass, "_compile", noted)
    for prepares in (True, False):
        with monkeypatch.context() as patch, context.gl:
            if not prepares:
                patch.setattr(Temporal, "prepare", lambda *_: None)
            fresh = Context(context.gl, context.route, context.device)  # no pace is known
            session = Session(scene, settings, fresh, clock)
            session.moving.use(Way(mode))
            start(session)
            while not session.is_done:
                session.advance(0.01)
            before = len(compiled)
            session.edit(walked(session.scene), "camera")
            session.advance(0.01, count=1)
            assert session.renderer
            assert (len(compiled) == before) is prepares
            with context.gl:
                texture = session.moving.texture(session.renderer, session.weights)
            assert texture
            with context.gl:
                pictures.append((session.samples, read_texture(texture)[..., :3].tobytes()))
            session.release()
    assert pictures[0] == pictures[1]
