"""Pixels that met rare light are distinguished from noise, and from what every method sees."""

import numpy as np

from glrt.comparison.noise import FAR, rare_variance
from glrt.comparison.verdict import compare
from tests.support.noisy_images import noisy


def test_a_pixel_far_above_its_place_is_rare_light() -> None:
    variance = np.full((24, 24, 3), 1e-4)
    variance[9, 3] = 1.01 * FAR * 1e-4
    variance[17, 20] = 0.99 * FAR * 1e-4
    rare = rare_variance(variance, np.zeros_like(variance))
    assert np.argwhere(rare[..., 0]).tolist() == [[9, 3]]
    assert np.array_equal(rare[9, 3], variance[9, 3])


def test_what_the_other_picture_has_too_is_not_rare() -> None:
    """The rim of a lamp."""
    variance = np.full((16, 16, 3), 1e-4)
    variance[5, 2:9] = 1.0
    assert not rare_variance(variance, variance / 2).any()
    assert rare_variance(variance, np.full_like(variance, 1e-4)).any()


def test_a_noisy_place_is_not_rare() -> None:
    """The edge between a noisy and a calm place is not rare, though most of a block is calm."""
    variance = np.full((32, 32, 3), 1e-9)
    variance[:, 13:] = 1e-2
    assert not rare_variance(variance, np.zeros_like(variance)).any()


def test_sixteen_observations_of_even_noise_are_not_rare() -> None:
    draw = np.random.default_rng(3)
    variance = draw.chisquare(15, (256, 256, 3)) / 15
    assert not rare_variance(variance, np.zeros_like(variance)).any()


def test_heavy_tails_leave_two_methods_undecided_and_one_method_decided() -> None:
    """The image finds a fifth of its light by rare hits, the reference evenly."""
    image = noisy("caustic", 256, 1, 64)
    reference = noisy("smooth", 256, 2, 64)
    found = compare(image, reference)
    assert found.heavy_tails is not None
    assert found.heavy_tails.picture == "image"
    assert found.heavy_tails.share > 0.9
    turned = compare(reference, image).heavy_tails
    assert turned == found.heavy_tails._replace(picture="reference")
    assert compare(image, noisy("caustic", 256, 2, 64), alike=True).heavy_tails is None
    assert compare(noisy("smooth", 256, 1, 64), reference).heavy_tails is None
