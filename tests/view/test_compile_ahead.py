"""A kernel compiled ahead by another process: for which driver, and how the process ends."""

import json
import os
import time
from typing import Any

import pytest

from glrt.core.errors import ContextError
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from glrt.view.state import compile_ahead
from glrt.view.state.compile_ahead import CompileAhead, compile_part, part_of
from tests.support.mixed_scene import everything


def resting(context: Context, settings: dict[str, Any]) -> Renderer:
    scene = everything()
    return Renderer(scene, settings_for(scene.render, **settings), context, layering="groups")


def wait_for(process: CompileAhead) -> None:
    """A machine that has more to do takes its time."""
    deadline = time.monotonic() + 250
    while not process.is_over and time.monotonic() < deadline:
        time.sleep(0.02)


@pytest.mark.slow
@pytest.mark.parametrize("part", [None, "groups baked\n{}\n"], ids=["whole", "broken"])
def test_a_process_succeeds_where_the_driver_takes_the_kernel(
    context: Context, monkeypatch: pytest.MonkeyPatch, part: str | None
) -> None:
    if part:
        monkeypatch.setattr(compile_ahead, "part_of", lambda *_: part)
    renderer = resting(context, {"width": 24, "height": 24})
    process = CompileAhead(renderer, "baked")
    wait_for(process)
    renderer.release()
    assert process.succeeded is (part is None)


def test_a_process_that_is_ended_is_gone(context: Context) -> None:
    renderer = resting(context, {"width": 16, "height": 16})
    process = CompileAhead(renderer, "baked")
    number = process._process.pid
    process.end()
    renderer.release()
    with pytest.raises(ProcessLookupError):
        os.kill(number, 0)


def test_it_compiles_the_baked_kernel_of_the_window(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    renderer = resting(context, {"width": 40, "height": 32})
    part = part_of(renderer, "baked")
    renderer.bake()
    wanted = renderer._tracer.device_scene.faster("baked")
    baked: list[Renderer] = []
    monkeypatch.setattr(Renderer, "bake", lambda renderer, _: baked.append(renderer))
    compile_part(part)
    assert wanted
    other = baked[0]._tracer.device_scene.faster("baked")
    assert other
    assert [one.live.text for one in wanted] == [one.live.text for one in other]
    name = context.renderer
    assert name in part
    with pytest.raises(ContextError, match="no route leads to a rival"):
        compile_part(part.replace(json.dumps(name), '"a rival"'))
    monkeypatch.undo()
    renderer.release()


@pytest.mark.parametrize(
    ("side", "small"), [(1, 1), (16, 16), (20, 20), (31, 24), (512, 32), (640, 24), (24, 24)]
)
def test_a_small_picture_is_compiled_for_as_the_large_one(side: int, small: int) -> None:
    assert compile_ahead._small(side) == small
    assert (side & (side - 1) == 0) == (small & (small - 1) == 0)
