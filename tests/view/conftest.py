"""Fixtures: sessions without a window, by a clock that tests move on."""

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from glrt.gpu.context import Context
from glrt.rendering import renderer, tracer
from glrt.rendering.pipelines import Fast
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from glrt.view.state.idle_kernel import IdleKernel
from glrt.view.state.session import ANNOUNCED, Session
from tests.support.mixed_scene import everything
from tests.support.sessions import Clock, Opening, frames


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def dispatches_by_clock(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """Dispatches are timed by it, too: on a busy machine a frame could take several."""
    for module in (renderer, tracer):
        monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=clock))


@pytest.fixture
def session(fresh: Context, clock: Clock, dispatches_by_clock: None) -> Iterator[Session]:
    scene = everything()
    settings = settings_for(scene.render, width=16, height=16, bounces=3, samples=1000)
    opened = Session(scene, settings, fresh, clock)
    with fresh.gl:
        yield opened
        opened.release()


@pytest.fixture
def opened(fresh: Context, clock: Clock) -> Iterator[Opening]:
    """Opens a session whose processes are played, and lets it get its first samples."""
    sessions: list[Session] = []

    def opening(stage: Callable[[Renderer, Fast], Any], **ways: Any) -> Session:
        scene = ways.pop("scene", everything())
        pipeline = ways.pop("pipeline", "auto")
        sizes = {"width": 24, "height": 16, "bounces": 3, "samples": 1000}
        settings = settings_for(scene.render, **{**sizes, **ways})
        rest = IdleKernel(clock, stage)
        session = Session(scene, settings, fresh, clock, pipeline, rest)
        sessions.append(session)
        frames(session, ANNOUNCED + 1)
        return session

    with fresh.gl:
        yield opening
        for session in sessions:
            session.release()
