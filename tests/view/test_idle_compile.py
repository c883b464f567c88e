"""A kernel compiled ahead by another process: what it finds out, and how it ends."""

import json
import os
import time
from typing import Any

import pytest

from glrt.core.errors import ContextError
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from glrt.view.state import idle_compile as rehearsal_module
from glrt.view.state.idle_compile import TrialCompile, part_of, rehearse
from tests.support.mixed_scene import everything


def resting(context: Context, settings: dict[str, Any]) -> Renderer:
    scene = everything()
    return Renderer(scene, settings_for(scene.render, **settings), context, layering="groups")


def wait_for(rehearsal: TrialCompile) -> None:
    """A machine that has more to do takes its time."""
    deadline = time.monotonic() + 250
    while not rehearsal.is_over and time.monotonic() < deadline:
        time.sleep(0.02)


@pytest.mark.slow
def test_a_rehearsal_finds_out_on_the_same_driver(context: Context) -> None:
    renderer = resting(context, {"width": 100, "height": 64})
    rehearsal = TrialCompile(renderer)
    wait_for(rehearsal)
    finding = rehearsal.finding()
    renderer.release()
    assert finding
    assert finding.is_same or not context.is_software
    assert finding.seconds > 0


def test_a_rehearsal_that_is_ended_leaves_no_process(context: Context) -> None:
    renderer = resting(context, {"width": 16, "height": 16})
    rehearsal = TrialCompile(renderer)
    number = rehearsal._process.pid
    rehearsal.end()
    renderer.release()
    with pytest.raises(ProcessLookupError):
        os.kill(number, 0)


@pytest.mark.slow
def test_a_rehearsal_that_fails_finds_nothing(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rehearsal_module, "part_of", lambda _: "groups\n{}\n")
    renderer = resting(context, {"width": 16, "height": 16})
    rehearsal = TrialCompile(renderer)
    wait_for(rehearsal)
    assert rehearsal.finding() is None
    renderer.release()


def test_other_bits_are_noticed_and_another_driver(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    renderer = resting(context, {"width": 40, "height": 32})
    part = part_of(renderer)
    renderer.release()
    assert rehearse(part).is_same or not context.is_software
    monkeypatch.setattr(Renderer, "bake", lambda renderer: renderer.update(seed=1))
    assert not rehearse(part).is_same
    name = context.renderer
    assert name in part
    with pytest.raises(ContextError, match="no route leads to a rival"):
        rehearse(part.replace(json.dumps(name), '"a rival"'))


@pytest.mark.parametrize(
    ("side", "small"), [(1, 1), (16, 16), (20, 20), (31, 24), (512, 32), (640, 24), (24, 24)]
)
def test_a_small_picture_is_compiled_for_as_the_large_one(side: int, small: int) -> None:
    assert rehearsal_module._small(side) == small
    assert (side & (side - 1) == 0) == (small & (small - 1) == 0)
