"""Small pictures on a large screen, with which upsampling is compared at equal work."""

import numpy as np
import pytest

from glrt.analysis.chart.rays import Rays
from glrt.analysis.motion.measure import SURFACES, _share_of_pixels, enlargement
from glrt.analysis.motion.playing import Played, enlarged
from glrt.rendering.history.lattice import FACTORS
from glrt.rendering.history.temporal import Way
from glrt.rendering.history.upsample import PAIR
from glrt.settings import Settings, settings_for


def test_an_enlarged_picture_is_linear_between_its_pixels() -> None:
    """A plane stays one, apart from half a pixel at its edges; its own size changes nothing."""
    y, x = np.mgrid[:5, :7].astype(np.float32)
    small = np.stack([2 * x - y, x, y], axis=2)
    large = enlarged(small, (28, 15))
    y, x = (np.mgrid[:15, :28] + 0.5) / np.array([3, 4])[:, None, None] - 0.5
    truth = np.stack([2 * x - y, x, y], axis=2)
    np.testing.assert_allclose(large[2:-2, 2:-2], truth[2:-2, 2:-2], atol=1e-5)
    np.testing.assert_array_equal(large[:2, :2], np.broadcast_to(small[0, 0], (2, 2, 3)))
    noise = np.random.default_rng(1).uniform(size=(4, 6, 3)).astype(np.float32)
    np.testing.assert_array_equal(enlarged(noise, (6, 4)), noise)


@pytest.mark.parametrize("factor", FACTORS)
def test_an_enlargement_takes_the_rays_of_upsampling(factor: int) -> None:
    settings = settings_for(Settings(), width=640, height=480)
    rays = Rays(sample=9.7)
    small = enlargement(Played(settings, Way("upsample", factor=factor)), rays)
    assert small.enlarged == (640, 480)
    assert small.way.mode == "reset"
    spent = rays.sample * _share_of_pixels(small)
    assert spent == pytest.approx(SURFACES + PAIR * rays.sample / factor**2, rel=0.01)
