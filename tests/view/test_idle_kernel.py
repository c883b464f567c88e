"""While nothing is edited a faster kernel takes over: when, and what ends or forbids it."""

import pytest

from glrt.core.errors import RenderError
from glrt.plan.facts import MOST_BAKED
from glrt.rendering.pipelines import Fast
from glrt.rendering.renderer import Renderer
from glrt.view.state.compile_ahead import CompileAhead
from glrt.view.state.idle_kernel import MOST, PAUSES
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.sessions import Clock, Opening, Stage, frames, rested, walked


def test_nothing_is_compiled_ahead_before_a_pause_nor_after_the_last_sample(
    opened: Opening, clock: Clock
) -> None:
    stage = Stage()
    session = opened(stage, samples=40)
    clock.step /= 4  # a frame reads it often, and the last sample is to come before the pause ends
    for _ in range(4):
        session.edit(seed=session.settings.seed + 1)
        frames(session, 1)
        clock.now += 0.9 * PAUSES["placed"]
    session.edit(seed=0)
    while not session.is_done:
        frames(session, 1)
    clock.now += 2 * PAUSES["placed"]
    frames(session, 3)
    assert not stage.played
    session.edit(samples=100)
    frames(session, 1)
    assert len(stage.played) == 1


def test_an_edit_ends_the_process_and_a_window_that_closes_too(
    opened: Opening, clock: Clock
) -> None:
    stage = Stage()
    stage.is_over = False
    session = opened(stage)
    assert not rested(session, clock)
    session.edit(seed=4)
    frames(session, 1)
    assert [one.is_ended for one in stage.played] == [True]
    assert not rested(session, clock)
    assert [one.is_ended for one in stage.played] == [True, False]
    session.release()
    assert stage.played[1].is_ended


def test_many_shapes_are_not_compiled_ahead(opened: Opening, clock: Clock) -> None:
    stage = Stage()
    balls = [sphere([i, 0, -9], 0.4, "m") for i in range(MOST_BAKED + 1)]
    many = scene_of(balls, {"m": MATTE}, background={"color": [1, 1, 1]})
    session = opened(stage, scene=many)
    assert not rested(session, clock)
    assert not stage.played


def test_a_process_that_failed_is_tried_again_after_the_next_edit(
    opened: Opening, clock: Clock
) -> None:
    stage = Stage(False, True)
    session = opened(stage)
    assert not rested(session, clock)
    assert not rested(session, clock)
    assert len(stage.played) == 1
    session.edit(seed=1)
    assert rested(session, clock)


def test_where_no_process_can_be_started_the_window_goes_on(opened: Opening, clock: Clock) -> None:
    tried: list[Renderer] = []

    def begin(renderer: Renderer, _: Fast) -> CompileAhead:
        tried.append(renderer)
        raise OSError("no more processes")

    session = opened(begin)
    for seed in range(2):
        session.edit(seed=seed)
        assert not rested(session, clock)
    assert len(tried) == 1
    assert (session.samples > 0, session.problem) == (True, "")


def test_a_window_that_stood_still_once_does_not_again(
    opened: Opening, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A window stands still where the driver's cache is not shared after all."""
    session = opened(Stage())
    bake = Renderer.bake

    def slow(renderer: Renderer, tier: Fast) -> bool:
        clock.now += MOST
        return bake(renderer, tier)

    monkeypatch.setattr(Renderer, "bake", slow)
    assert session.renderer
    for scene in (session.scene, walked(session.scene)):
        session.edit(scene)
        assert not rested(session, clock)
        assert session.renderer.running_tier == "placed", "the kernel for which it stood still"


def test_a_kernel_that_is_refused_here_leaves_the_other(
    opened: Opening, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> bool:
        raise RenderError("no")

    session = opened(Stage())
    monkeypatch.setattr(Renderer, "bake", refuse)
    assert not rested(session, clock)
    samples = session.samples
    frames(session, 2)
    assert (session.samples, session.problem) == (samples + 2, "")
