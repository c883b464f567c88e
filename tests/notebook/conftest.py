"""Fixtures: pictures without a notebook, by a clock that tests move on."""

from collections.abc import Iterator
from functools import partial
from typing import Any

import pytest

from glrt.gpu.context import Context
from glrt.notebook.live import Live
from glrt.notebook.shared_context import SharedContext
from glrt.settings import settings_for
from glrt.view.state.idle_kernel import IdleKernel
from tests.notebook.answers import Opening
from tests.support.mixed_scene import everything
from tests.support.sessions import Clock, Stage
from tests.view.conftest import clock, dispatches_by_clock

__all__ = ["clock", "dispatches_by_clock"]


STEP = 0.01  # seconds of the clock at which a frame has a few samples


class Given(SharedContext):
    """A context that is open already."""

    def __init__(self, context: Context) -> None:
        super().__init__()
        self._context = context


@pytest.fixture
def opened(fresh: Context, clock: Clock, dispatches_by_clock: None) -> Iterator[Opening]:
    """Opens pictures of one scene, by the given settings, in one context.

    The processes that compile ahead are played if there is a `stage`; else there are none.
    """
    opened, shared = list[Live](), Given(fresh)
    clock.step = STEP

    def opening(stage: Stage | None = None, **given: Any) -> Live:
        scene = everything()
        sizes = {"width": 16, "height": 16, "bounces": 3, "samples": 1000}
        settings = settings_for(scene.render, **{**sizes, **given})
        at_rest = partial(IdleKernel, clock, stage) if stage else lambda: None
        ways: dict[str, Any] = {"shared": shared, "clock": clock, "at_rest": at_rest}
        opened.append(Live(scene, settings, **ways))
        return opened[-1]

    yield opening
    for live in opened:
        live.rest()


@pytest.fixture
def live(opened: Opening) -> Live:
    return opened()
