"""Frames in parts: the same bits, whatever interrupts them, and the last whole one stays."""

from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.rendering import renderer as renderer_module
from glrt.rendering import schedule as schedule_module
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import HEADLESS, INTERACTIVE
from glrt.rendering.stopping import Interruption, Limits, render_to_limit
from glrt.settings import Cost
from tests.support.images import same_bits
from tests.support.mixed_scene import everything
from tests.support.renders import rendered, rendering, same


@pytest.fixture
def tiny_dispatches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every dispatch takes one tile and one sample."""
    monkeypatch.setattr(schedule_module, "FIRST_TILES", 1)
    for name, policy in (("HEADLESS", HEADLESS), ("INTERACTIVE", INTERACTIVE)):
        monkeypatch.setattr(renderer_module, name, policy._replace(limit=1e-12))


SHAPES: list[dict[str, Any]] = [
    {},
    {"width": 37, "height": 23},
    {"width": 50, "height": 9, "crop": (3, 1, 41, 7)},
]


@pytest.mark.usefixtures("tiny_dispatches")
@pytest.mark.parametrize("shape", SHAPES, ids=["square", "odd", "crop"])
def test_a_frame_in_parts_gives_the_same_bits(context: Context, shape: dict[str, Any]) -> None:
    with rendering(everything(), context, **shape) as renderer:
        dispatches: list[float] = []

        def note(renderer: Renderer) -> bool:
            dispatches.append(renderer.work)
            return True

        renderer.render(3, note)
        whole = Renderer(everything(), renderer.settings, context)
        whole.step(3)
        assert len(dispatches) >= 12
        assert dispatches == sorted(dispatches)
        assert same(renderer.image(), whole.image())
        whole.release()


@pytest.mark.usefixtures("tiny_dispatches")
def test_the_last_complete_picture_stays_until_the_next_one_is(context: Context) -> None:
    with rendering(everything(), context, width=40, height=40) as renderer:
        renderer.render(2)
        complete = renderer.image()
        while renderer.work < 2.5:
            assert not renderer.advance(0.0, 9)
        assert renderer.samples == 2
        assert same(renderer.image(), complete)
        before = renderer.display()
        renderer.update(seed=1)
        assert not renderer.advance(0.0, 9)
        assert same_bits(renderer.display(), before), "the old picture stays after a restart"


@pytest.mark.usefixtures("tiny_dispatches")
def test_a_restart_drops_the_frame_that_has_begun(context: Context) -> None:
    expected = rendered(everything(), context, 2, width=40, height=40, seed=4)
    with rendering(everything(), context, width=40, height=40) as renderer:
        renderer.render(1)
        for _ in range(5):
            renderer.advance(0.0, 9)
        assert 1 < renderer.work < 2
        assert renderer.update(seed=4) is Cost.RESTART
        assert renderer.work == 0
        assert same(renderer.render(2).image(), expected)


def test_advance_reports_when_the_picture_changed_and_stops_at_its_target(context: Context) -> None:
    with rendering(everything(), context, samples=40) as renderer:
        assert renderer.advance(10.0, 3)
        assert renderer.samples == 3
        assert not renderer.advance(10.0, 3)
        assert renderer.advance(10.0)
        assert renderer.samples == 40
        assert same(renderer.image(), rendered(everything(), context, 40))


def test_advance_ends_with_its_time(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each look at this clock is 10 ms after the last."""
    ticks = iter(range(1_000_000))
    with rendering(everything(), context) as renderer:
        monkeypatch.setattr("glrt.rendering.renderer.time.perf_counter", lambda: next(ticks) * 0.01)
        renderer.advance(0.1, 1 << 20)
        monkeypatch.undo()
        looked = next(ticks)
        assert 8 <= looked <= 12


@pytest.mark.usefixtures("tiny_dispatches")
def test_an_interruption_waits_for_a_dispatch_and_not_for_a_frame(context: Context) -> None:
    with rendering(everything(), context, width=64, height=64) as renderer:
        interruption, seen = Interruption(), []

        def interrupt(renderer: Renderer) -> None:
            seen.append(renderer.work)
            if len(seen) == 70:
                interruption.signal = 2

        render_to_limit(renderer, Limits(100), interruption, interrupt)
        assert len(seen) == 70
        assert renderer.samples == 1, "64 dispatches made the first sample"


@pytest.mark.usefixtures("tiny_dispatches")
def test_a_deadline_that_has_passed_still_gives_each_pixel_a_sample(context: Context) -> None:
    with rendering(everything(), context, width=40, height=40) as renderer:
        render_to_limit(renderer, Limits(100, deadline=0.0), Interruption())
        assert renderer.samples == 1


def test_step_drops_what_has_begun(context: Context, tiny_dispatches: None) -> None:
    with rendering(everything(), context, width=40, height=40) as renderer:
        renderer.advance(0.0, 9)
        renderer.step(2)
        assert renderer.work == 2
        with pytest.raises(UsageError):
            renderer.step(0)
        assert same(renderer.image(), rendered(everything(), context, 2, width=40, height=40))
