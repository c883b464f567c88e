"""The experiment behind docs/results/compare.md, and a part of it on real renders.

Seeds are fixed; every statistical test fails by chance once in 10,000 seeds at most.
"""

import math

import numpy as np
import pytest

from bench import false_alarms
from bench.false_alarms import Pool, compared, gather, main, wilson
from glrt.gpu.context import Context
from glrt.lab.noisy_scenes import CASES, OTHERS
from tests.support.noisy_images import alarms_allowed


def test_pictures_of_a_pool_are_those_of_all_its_samples() -> None:
    samples = np.random.default_rng(1).exponential(size=(6, 4, 2, 2, 3)).astype(np.float32)
    pool = Pool(samples.mean(axis=1), samples.var(axis=1), samples=4)
    picture = pool.picture(1, 12)
    rest = samples[3:].reshape(12, 2, 2, 3).astype(float)
    assert pool.pictures(12) == 2
    assert np.allclose(picture.radiance, rest.mean(axis=0), rtol=1e-5)
    assert np.allclose(picture.stderr, rest.std(axis=0, ddof=1) / math.sqrt(12), rtol=1e-5)


def test_renders_of_a_pool_are_independent(context: Context) -> None:
    pool = gather(context, CASES["diffuse"], 4, 2, seed=5)
    assert pool.means.shape == (2, 48, 48, 3)
    assert not np.array_equal(pool.means[0], pool.means[1])


def test_interval_of_a_share_is_wilsons() -> None:
    assert wilson(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)
    assert wilson(5, 10) == pytest.approx((0.2366, 0.7634), abs=1e-4)


def test_a_table_has_a_row_for_each_scene_and_mix(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each has two pairs, 16 x 16 pixels, and references of 256 samples instead of 4,096."""
    monkeypatch.setattr(false_alarms, "SIZE", 16)
    monkeypatch.setattr(false_alarms, "LARGE", 256)
    assert main(["sobol", "--pairs", "2"]) == 0
    printed = capsys.readouterr().out
    assert "processors" in printed
    assert printed.count("| diffuse | ") == printed.count("| caustic | ") == 6
    assert printed.count(" of 2 |") == 12
    assert printed.count("| 64 / 256 | ") == 2


@pytest.mark.slow
@pytest.mark.parametrize("samples", [(64, 64), (16, 256)], ids=str)
@pytest.mark.parametrize("name", CASES)
def test_equal_renders_are_rarely_called_different(
    name: str, samples: tuple[int, int], context: Context
) -> None:
    """120 pairs; the run of `python -m bench.false_alarms` has 1,000."""
    images, references = (
        gather(context, CASES[name], min(n, 64), 120 * max(n // 64, 1), seed)
        for seed, n in zip((0, 1 << 20), samples, strict=True)
    )
    found = compared(images, references, samples)
    assert len(found) == 120
    assert sum(not comparison for comparison in found) <= alarms_allowed(120, 0.01)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_two_methods_are_rarely_called_different(name: str, context: Context) -> None:
    images = gather(context, OTHERS[name], 64, 120, 0)
    references = gather(context, CASES[name], 64, 120, 1 << 20)
    found = compared(images, references, (64, 64), alike=None)
    assert sum(not comparison for comparison in found) <= alarms_allowed(120, 0.01)
