"""Whether pictures with particles agree with those without, and know their error."""

import numpy as np
import pytest

from bench.particle_checks import Mean, main, rms_apart
from tests.support.alarms import assert_near

BLOCKS = (64, 64, 3)


def of(value: float, stderr: float, seed: int) -> Mean:
    """Blocks with normal noise about a value."""
    noise = np.random.default_rng(seed).normal(value, stderr, BLOCKS)
    return Mean(noise, np.full(BLOCKS, stderr))


def test_noise_alone_makes_an_rms_of_one() -> None:
    expected = (2 * np.prod(BLOCKS)) ** -0.5
    assert_near(rms_apart(of(1.0, 0.3, 1), of(1.0, 0.4, 2)), 1.0, float(expected))


def test_light_that_is_lost_makes_it_more() -> None:
    assert rms_apart(of(1.0, 0.3, 1), of(1.5, 0.4, 2)) == pytest.approx(2**0.5, rel=0.05)


def test_blocks_without_noise_must_agree() -> None:
    with pytest.raises(AssertionError, match="without noise"):
        rms_apart(Mean(np.ones(BLOCKS), np.zeros(BLOCKS)), of(1.1, 0.0, 1))


@pytest.mark.slow
def test_figures_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    few = ["--size", "16", "--samples", "32", "--renders", "1", "--repeats", "2"]
    assert main(["--scenes", "cornell", "--calibrated", "cornell", *few]) == 0
    printed = capsys.readouterr().out
    assert "| cornell | straight | 4 |" in printed
    assert "| cornell | through balls |" in printed.partition("true error over")[2]
