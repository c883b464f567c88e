"""Estimated errors over true ones: a small run of one ordinary scene, and the row of a table."""

import numpy as np
import pytest

from bench.error_ratios import ORDINARY, Ratios, ratios_of, row, scenes
from bench.fooling_scenes import KINDS
from glrt.gpu.context import Context
from glrt.image.sources import load


def test_a_row_has_the_mean_and_quantiles_of_both_estimates() -> None:
    found = Ratios(0.25, np.full(9, 0.1), np.linspace(0.8, 1.2, 9))
    assert (
        row("some", found) == "| some | 0.250 | 0.10 (0.10, 0.10, 0.10) | 1.01 (0.84, 1.00, 1.16) |"
    )


def test_scenes_are_ordinary_ones_and_as_many_of_each_kind() -> None:
    names = [name for name, _, _ in scenes(2)]
    assert names[: len(ORDINARY)] == list(ORDINARY)
    assert len(names) == len(set(names)) == len(ORDINARY) + 2 + 2 * len(KINDS)


def test_an_ordinary_scene_is_estimated_right(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Render 16 x 12 pixels with four seeds; the mean is known to some percent."""
    monkeypatch.setattr("bench.error_ratios.SIZE", {"width": 16, "height": 12})
    monkeypatch.setattr("bench.error_ratios.HALF", 1024)
    found = ratios_of(load("sky"), "mis", context, 64, 4, "sobol")
    assert found.estimated.mean() == pytest.approx(1, abs=0.25)
    assert found.estimated == pytest.approx(found.by_own, rel=0.05)
