"""The gain of a denoiser: the counts, and the gate in small (slow)."""

from pathlib import Path

import numpy as np
import pytest

from bench import denoised
from bench.denoised import Found, blocks_of, certain, judged, pictures, report
from bench.truth import Truth, truth_of
from glrt.denoise.denoising import Denoised
from glrt.gpu.context import Context
from glrt.image.image import Image

NAN = np.full((8, 8, 3), np.nan, np.float32)


def picture(plain: float, shown: float, told: float) -> Image:
    """A picture of a truth of 1: its plain and shown values, and the reported error."""
    radiance, other = (np.full((8, 8, 3), value, np.float32) for value in (plain, shown))
    return Image(radiance, NAN, 64, denoising=Denoised(other, other, told, told))


def test_errors_are_against_the_truth() -> None:
    truth = Truth(*np.ones((2, 8, 8, 3)))
    images = [picture(1.2, 1.05, 0.04), picture(0.8, 0.95, 0.06)]
    found = judged("a", iter(images), truth)
    scale = np.sqrt(1.01)
    assert found.plain == pytest.approx(0.2 / scale)
    assert found.denoised == pytest.approx(0.05 / scale)
    assert found.gain == pytest.approx(4)
    assert found.estimate == pytest.approx(np.sqrt((0.04**2 + 0.06**2) / 2))
    assert (found.blocks, found.worse) == (1, 0)


def test_noise_of_the_truth_is_no_error() -> None:
    first, second = 1 + 0.1 * np.random.default_rng(0).normal(size=(2, 64, 64, 3))
    truth = Truth(first, second)
    assert abs(truth.relative(np.ones((64, 64, 3), np.float32))) < 1e-3


def test_a_block_is_worse_where_that_is_more_than_chance() -> None:
    rng = np.random.default_rng(1)
    harm = rng.normal(size=(16, 2, 2))
    harm[:, 0, 1] += 3
    assert certain(harm).tolist() == [[False, True], [False, False]]
    squares = np.zeros((70, 64, 3))
    squares[32:64, :32] = 1
    assert blocks_of(squares).tolist() == [[0, 0], [1, 0]]


def test_the_gate_is_counted() -> None:
    good = Found("a", 0.1, 0.03, 0.033, 0.1, 9, 0)
    bad = Found("b", 0.1, 0.05, 0.02, 0.1, 9, 1)
    told = report([good, bad])
    assert "At least 2.5 times less error: 1 of 2 scenes" in told
    assert "within 25 % of the truth: 1 of 2" in told
    assert "worse than plain: 1 of 18, 5.6 %" in told
    assert "| a | 10.00 % | 3.00 % | 3.33 | 1.10 | ± 0.10 | 0 of 9 |" in told


def test_a_small_run_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["sky", "--size", "16", "--seeds", "2", "--truth", "64", "--by", "nlm"]
    assert denoised.main([*words, "--truths", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "| sky |" in told
    assert [file.name for file in tmp_path.iterdir()] == ["sky-16-64-caustics-off.npz"]
    assert denoised.main([*words, "--truths", str(tmp_path)]) == 0
    assert capsys.readouterr().out == told


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cornell", "lamps", "methods/caustic"])
def test_a_denoised_picture_is_better_and_knows_how_good_it_is(context: Context, name: str) -> None:
    """64 x 64 pixels, 16 seeds. Under a caustic the estimate misses light that no sample found."""
    truth = truth_of(name, context, None, size=64, samples=8192)
    found = judged(name, pictures(name, "nlm", 64, 16, context), truth)
    assert found.gain > 1.5
    assert 0.75 < found.estimate / found.denoised < 1.25 or name == "methods/caustic"
    assert found.worse == 0
