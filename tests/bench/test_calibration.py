"""The ratio of the true error to the claimed one, where both are known."""

from typing import Any, cast

import numpy as np
import pytest

from bench.calibration import Ratio, error_ratio, main, table
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from tests.support.alarms import assert_near


class Noise:
    """A stand-in for a renderer: pictures of normal noise that claim a share of it."""

    def __init__(self, claimed: float) -> None:
        self.claimed = claimed
        self.random = np.random.default_rng(0)

    def update(self, **changes: Any) -> None:
        self.random = np.random.default_rng(changes["seed"])

    def render(self, samples: int) -> "Noise":
        self.stderr = samples**-0.5
        return self

    def image(self) -> Image:
        shape = (32, 32, 3)
        radiance = self.random.normal(1, self.stderr, shape).astype(np.float32)
        return Image(radiance, np.full(shape, self.claimed * self.stderr, np.float32), 4)


@pytest.mark.parametrize("claimed", [1.0, 0.5])
def test_a_picture_that_claims_half_its_error_has_a_ratio_of_two(claimed: float) -> None:
    ratio = error_ratio(cast(Renderer, Noise(claimed)), samples=4, renders=64)
    expected = (2 * 63 * 16 * 3) ** -0.5 / claimed
    assert_near(ratio.value, 1 / claimed, expected)
    assert ratio.stderr == pytest.approx(expected, rel=0.5)


def test_figures_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--scenes", "sky", "--samples", "32", "48", "--size", "16", "--renders", "4"]) == 0
    printed = capsys.readouterr().out
    assert "processors" in printed
    assert "| scene | 32 samples | 48 samples |" in printed
    lines = list(table({"sky": [Ratio(1.016, 0.014)]}, [32]))
    assert lines[2] == "| sky | 1.02 +- 0.01 |"


def test_a_picture_without_its_error_is_reported_in_one_paragraph(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["--scenes", "sky", "--samples", "16", "--size", "16"]) == 2
    assert "from 32 on" in capsys.readouterr().err
