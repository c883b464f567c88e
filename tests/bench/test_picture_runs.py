"""The share of runs that alarm falsely: what is compared, and at which chance."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bench import picture_runs
from bench.picture_runs import ALPHAS, PICTURES, alarms_of, rows_of, scenes_of
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from tests.support.noisy_images import alarms_allowed


def test_a_run_has_fifty_different_scenes() -> None:
    scenes = [*scenes_of()]
    assert len(scenes) == PICTURES
    assert len({scene.model_dump_json() for scene in scenes}) == PICTURES
    assert {"Drawn from seed 0", load("cornell").title} < {scene.title for scene in scenes}


def test_each_run_compares_new_pictures_with_new_references(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = []

    def compared(image: Image, reference: Image, alpha: float) -> Any:
        given.append((image, reference, alpha))
        return SimpleNamespace(verdict="different" if alpha > 0.002 else "same")

    monkeypatch.setattr(picture_runs, "compare", compared)
    found = alarms_of([load("cornell")] * 2, 3, 8, context, samples=2)
    assert found.tolist() == [[[False] * 2] * 3] + [[[True] * 2] * 3] * 2
    assert [alpha for _, _, alpha in given[:3]] == [alpha / 2 for alpha in ALPHAS]
    assert {(a.samples, b.samples) for a, b, _ in given} == {(2, 8)}
    pictures = [it for pair in given[: 3 * len(ALPHAS) : len(ALPHAS)] for it in pair[:2]]
    assert len({picture.radiance.tobytes() for picture in pictures}) == 6


def test_a_run_alarms_once_however_many_of_its_pictures_do() -> None:
    alarms = np.zeros((3, 40, 50), bool)
    alarms[1, 7, :2] = alarms[2, :4, 0] = True
    assert [*rows_of(alarms)] == [
        ["0.1 %", "0 of 40", "0.0 to 8.8 %", "0 of 2000"],
        ["1 %", "1 of 40", "0.4 to 12.9 %", "2 of 2000"],
        ["10 %", "4 of 40", "4.0 to 23.1 %", "4 of 2000"],
    ]


@pytest.mark.slow
def test_runs_of_five_pictures_alarm_as_rarely_as_stated(context: Context) -> None:
    found = alarms_of([*scenes_of(5)], 20, 24, context)
    for alpha, alarms in zip(ALPHAS, found, strict=True):
        assert alarms.any(axis=1).sum() <= alarms_allowed(20, alpha)
