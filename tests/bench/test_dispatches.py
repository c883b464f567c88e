"""The longest dispatch: each one is timed, and nothing but that."""

import time

import pytest

from bench import dispatches
from bench.dispatches import longest, main
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.rendering.tracer import Tracer


def test_the_longest_dispatch_is_reported(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    pauses = iter([0.01, 0.05, 0.02])

    def work_on(tracer: Tracer, *_: object) -> None:
        time.sleep(next(pauses))
        tracer.film.samples += 1

    monkeypatch.setattr(Tracer, "work_on", work_on)
    renderer = Renderer(load("sky"), context=context, width=16, height=16)
    told = longest(lambda: renderer.render(3))
    assert Tracer.work_on is work_on
    renderer.release()
    assert 0.05 <= told < 10
    assert next(pauses, None) is None


def test_the_table_has_a_row_a_scene(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dispatches, "SIZE", (16, 16))
    monkeypatch.setattr(dispatches, "SAMPLES", 2)
    monkeypatch.setattr(dispatches, "crowd", lambda _: load("sky"))
    assert main([]) == 0
    table = capsys.readouterr().out.splitlines()[2:]
    assert [line.count("|") for line in table] == [4] * 6
    assert all(line.endswith(" s |") for line in table[2:])
