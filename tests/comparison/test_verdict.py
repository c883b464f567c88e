"""`compare` distinguishes noise from a difference, above all where noise is rare and large.

Seeds are fixed; every statistical test fails by chance once in 10,000 seeds at most.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import glrt
from bench.false_alarms import without_errors
from glrt.comparison.regions import blocks
from glrt.comparison.verdict import _same_method, compare
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from tests.support.alarms import ALPHA, book
from tests.support.images import recipe
from tests.support.noisy_images import KINDS, MIXES, alarms_allowed, flat, noisy, red
from tests.support.renders import rendered


def own_errors_alarm(image: Image, reference: Image) -> bool:
    """The plain test of blocks by the errors that the pictures claim."""
    difference = blocks(image.radiance.astype(float) - reference.radiance)
    variance = blocks(np.square(image.stderr, dtype=float) + np.square(reference.stderr))
    z = difference / np.sqrt(np.maximum(variance, 1e-30))
    return bool((np.abs(z) > 4.3).any())


# --- False alarms --------------------------------------------------------------------------


@pytest.mark.parametrize("samples", MIXES, ids=str)
@pytest.mark.parametrize("kind", KINDS)
def test_equal_pictures_are_rarely_called_different(kind: str, samples: tuple[int, int]) -> None:
    pairs, alpha = 100, 0.05
    found = [
        compare(noisy(kind, samples[0], i), noisy(kind, samples[1], 1000 + i), alpha, alike=True)
        for i in range(pairs)
    ]
    assert sum(not comparison for comparison in found) <= alarms_allowed(pairs, alpha)


def test_errors_that_pictures_claim_would_alarm_on_most_pairs() -> None:
    for kind in ("caustic", "small lamp"):
        pairs = [(noisy(kind, 64, i), noisy(kind, 4096, 1000 + i)) for i in range(20)]
        assert sum(own_errors_alarm(*pair) for pair in pairs) >= 15, kind


@pytest.mark.parametrize("kind", ["smooth", "small lamp", "lamp"])
@pytest.mark.parametrize("worse", [0, 1])
def test_methods_of_other_noise_are_rarely_called_different(kind: str, worse: int) -> None:
    """One picture is smooth, the other of `kind`, of the same mean."""
    factor = (KINDS[kind].base + KINDS[kind].share * KINDS[kind].hit) / KINDS["smooth"].base
    found = 0
    for i in range(60):
        pair = [noisy("smooth", 64, 1000 + i, 64, factor), noisy(kind, 64, i, 64)]
        found += not compare(pair[worse], pair[1 - worse], 0.05)
    assert found <= alarms_allowed(60, 0.05)


@pytest.mark.parametrize("samples", MIXES, ids=str)
@pytest.mark.parametrize("kind", KINDS)
def test_pictures_without_errors_are_rarely_called_different(
    kind: str, samples: tuple[int, int]
) -> None:
    found = 0
    for i in range(40):
        image = without_errors(noisy(kind, samples[0], i))
        reference = noisy(kind, samples[1], 1000 + i)
        found += not compare(image, reference, 0.05)
        found += not compare(reference, image, 0.05)
    assert found <= alarms_allowed(80, 0.05)


# --- What is found -------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["smooth", "caustic"])
def test_one_percent_is_found_where_hits_are_rare(kind: str) -> None:
    """A test of the means alone would need thousands of samples under the caustic."""
    image, reference = noisy(kind, 256, 1, factor=1.01), noisy(kind, 256, 2)
    comparison = compare(image, reference, alike=True)
    assert comparison.verdict == "different"
    assert any("quiet" in reason for reason in comparison.reasons)
    assert all(factor.low < 0.01 < factor.high for factor in comparison.factors)


def test_what_would_have_shown_is_found_nineteen_times_in_twenty() -> None:
    pair = red(noisy("smooth", 64, 1)), red(noisy("smooth", 64, 2))
    shown = compare(*pair, alike=True).sensitivity.light
    found = 0
    for i in range(1000, 1100):
        image = red(noisy("smooth", 64, i, factor=1 + shown))
        found += not compare(image, red(noisy("smooth", 64, 9 * i)), alike=True)
    assert 86 <= found <= 100


def test_samples_that_it_asks_for_are_enough() -> None:
    undecided = compare(noisy("smooth", 16, 1), noisy("smooth", 16, 2), bias=2e-3, alike=True)
    assert undecided.verdict == "undecided"
    assert undecided
    needs = undecided.needs
    assert needs is not None
    enough = compare(noisy("smooth", needs, 3), noisy("smooth", needs, 4), bias=2e-3, alike=True)
    assert enough.verdict == "same"
    assert f"needs {needs} samples" in str(undecided)


def test_a_wrong_pixel_in_the_remainder_of_a_side_is_found_and_located() -> None:
    image, reference = noisy("smooth", 256, 3, size=77), noisy("smooth", 256, 4, size=77)
    assert compare(image, reference, alike=True)
    image.radiance[76, 70, 1] *= 3
    comparison = compare(image, reference, alike=True)
    assert comparison.reasons == ("1 of 81 blocks differ",)
    assert tuple(comparison.worst) == ("green", 64, 64, 13, 13)
    assert str(comparison.pixel) == "green at x 70, y 76"


def test_small_differences_everywhere_show_in_the_scatter() -> None:
    """No block and no mean is far off, but many are a little off, up and down alike."""
    image, reference = noisy("smooth", 64, 1, size=160), noisy("smooth", 64, 2, size=160)
    checker = np.kron(np.indices((20, 20)).sum(axis=0) % 2 * 2 - 1, np.ones((8, 8)))[..., None]
    changed = image.radiance * (1 + 0.01 * checker).astype(np.float32)
    comparison = compare(replace(image, radiance=changed), reference, alike=True)
    assert any("scatter" in reason for reason in comparison.reasons)


def test_errors_a_little_too_small_do_not_count_as_scatter() -> None:
    image, reference = (
        replace(i, stderr=i.stderr * np.float32(0.93))
        for i in (noisy("smooth", 64, 1, 320), noisy("smooth", 64, 2, 320))
    )
    comparison = compare(image, reference, alike=True)
    assert comparison.spread == pytest.approx(1 / 0.93, rel=0.03)
    assert comparison


def test_a_mean_that_differs_shows_between_methods_too() -> None:
    comparison = compare(noisy("smooth", 256, 1, factor=1.01), noisy("smooth", 256, 2))
    assert not comparison.factors
    assert comparison.reasons[0].startswith("the means differ")


def test_renders_of_fewer_bounces_differ_and_other_seeds_do_not(context: Context) -> None:
    settings: dict[str, Any] = {"width": 32, "height": 32}
    reference = rendered(load("cornell"), context, 64, **settings)
    other = rendered(load("cornell"), context, 64, seed=1, **settings)
    short = rendered(load("cornell"), context, 64, seed=1, bounces=3, **settings)
    assert glrt.compare(other, reference, ALPHA)
    assert glrt.compare(short, reference).verdict == "different"
    naive = rendered(load("cornell"), context, 64, seed=1, method="naive", **settings)
    assert glrt.compare(naive, reference, ALPHA)
    book(2)


# --- Pixels without noise, and broken ones ---------------------------------------------------


def test_pixels_without_noise_may_differ_by_rounding_alone() -> None:
    reference = flat(0.7, 0.0, 16)
    assert compare(flat(0.7 * (1 + 5e-6), 0.0, 16), reference).verdict == "same"
    reference.radiance[3, 5, 2] *= np.float32(1 + 3e-5)
    comparison = compare(flat(0.7, 0.0, 16), reference)
    assert comparison.verdict == "different"
    assert comparison.reasons == (
        "pixels without noise differ: 1 pixels, the first blue at x 5, y 3",
    )


def test_two_samples_that_agree_are_no_proof_that_there_is_no_noise() -> None:
    """Both samples of a pixel on an edge may fall on one side of it."""
    for samples, verdict in ((2, "same"), (64, "different")):
        reference = flat(0.7, 0.0, samples)
        reference.radiance[3, 5] = 0.1
        assert compare(flat(0.7, 0.0, samples), reference, alike=True).verdict == verdict


def test_two_blocks_of_samples_are_no_proof_either() -> None:
    """Their samples belong together: 64 of them are four observations."""
    for samples, verdict in ((64, "same"), (1024, "different")):
        even = recipe(sampler="sobol")
        image = replace(flat(0.7, 0.0, samples), recipe=even)
        reference = replace(flat(0.7, 0.0, samples), recipe=even)
        reference.radiance[3, 5] = 0.1
        assert compare(image, reference).verdict == verdict


@pytest.mark.parametrize("field", ["radiance", "stderr"])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("broken", [0, 1])
def test_a_broken_pixel_makes_them_different_and_is_named(
    field: str, value: float, broken: int
) -> None:
    image, reference = noisy("smooth", 64, 1), noisy("smooth", 64, 2)
    getattr((image, reference)[broken], field)[7, 9, 0] = value
    if field == "stderr" and math.isnan(value):  # an error that is unknown, not broken
        assert compare(image, reference, alike=True)
        return
    comparison = compare(image, reference, alike=True)
    assert comparison.verdict == "different"
    assert comparison.reasons == ("NaN or infinite: 1 pixels, the first red at x 9, y 7",)
    assert np.isfinite(comparison.block_scores).all()


def test_pictures_of_nothing_are_equal() -> None:
    comparison = compare(flat(0, 0, 64), flat(0, 0, 64))
    assert (comparison.reasons, comparison.verdict, comparison.needs) == ((), "undecided", None)


# --- Symmetry and scale --------------------------------------------------------------------


@pytest.mark.parametrize("alike", [True, False])
def test_scores_change_sign_when_pictures_change_places(alike: bool) -> None:
    a, b = noisy("caustic", 16, 1), noisy("caustic", 256, 2)
    scores = compare(a, b, alike=alike).block_scores
    assert np.allclose(compare(b, a, alike=alike).block_scores, -scores, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("power", [-100, 90])
def test_scores_do_not_depend_on_the_scale(power: int) -> None:
    scale = np.float32(2.0**power)
    a, b = noisy("caustic", 16, 1), noisy("caustic", 256, 2)
    c, d = (replace(i, radiance=i.radiance * scale, stderr=i.stderr * scale) for i in (a, b))
    for alike in (True, False):
        one, other = compare(a, b, alike=alike), compare(c, d, alike=alike)
        assert np.allclose(one.block_scores, other.block_scores, rtol=1e-6)
        assert one.sensitivity.light == pytest.approx(other.sensitivity.light, rel=1e-6)


# --- What can be compared --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("image", "reference", "words"),
    [
        (flat(1, 0.1, 4, 16), flat(1, 0.1, 4, 8), ["size", "16 x 16", "8 x 8"]),
        (flat(1, 0.1, 0), flat(1, 0.1, 4), ["the image", "samples"]),
        (flat(1, 0.1, 4), flat(1, 0.1, 0), ["the reference", "samples"]),
        (flat(1, np.nan, 1), flat(1, np.nan, 1), ["standard errors"]),
        (flat(1, 0.1, 4, 0), flat(1, 0.1, 4, 0), ["no pixels"]),
    ],
)
def test_what_cannot_be_compared_is_refused(
    image: Image, reference: Image, words: list[str]
) -> None:
    with pytest.raises(UsageError) as error:
        compare(image, reference)
    assert all(word in str(error.value) for word in words)


def test_recipes_report_whether_the_noise_is_of_one_method() -> None:
    image, other = noisy("smooth", 64, 1), noisy("smooth", 64, 2)
    mis, naive = recipe(method="mis"), recipe(method="naive")
    assert not compare(image, other).alike
    assert compare(replace(image, recipe=mis), replace(other, recipe=mis)).alike
    assert not compare(replace(image, recipe=mis), replace(other, recipe=naive)).alike
    unknown = without_errors(replace(image, recipe=mis))
    assert not compare(unknown, replace(other, recipe=mis)).alike


@pytest.mark.parametrize("samples", [(64, 256), (256, 64), (64, 64)], ids=str)
def test_unknown_errors_cost_no_more_than_half_of_the_sharpness(samples: tuple[int, int]) -> None:
    image, reference = noisy("smooth", samples[0], 1), noisy("smooth", samples[1], 2)
    known = compare(image, reference, alike=False).differences
    for pair in ((without_errors(image), reference), (image, without_errors(reference))):
        unknown = compare(*pair).differences
        for a, b in zip(known, unknown, strict=True):
            assert 0.9 < (b.high - b.low) / (a.high - a.low) < 2


@pytest.mark.parametrize(
    "change",
    [{"method": "nee"}, {"roulette": False}, {"sampler": "independent"}, {"caustics": "on"}],
    ids=str,
)
def test_pictures_of_other_noise_are_not_taken_as_alike(change: dict[str, Any]) -> None:
    """Otherwise the standard errors of one would be compared with the spread of the other."""
    plain = replace(noisy("smooth", 64, 1), recipe=recipe())
    other = replace(noisy("smooth", 64, 2), recipe=recipe(**change))
    assert _same_method(plain, plain)
    assert not _same_method(plain, other)


@pytest.mark.parametrize("change", [{"particles": 1.0}, {"aimed": 0.9}, {"linked": 0.5}], ids=str)
def test_settings_of_particles_make_other_noise_if_there_are_any(change: dict[str, Any]) -> None:
    for caustics in ("off", "on"):
        recipes = recipe(caustics=caustics), recipe(caustics=caustics, **change)
        pair = (replace(noisy("smooth", 64, 1), recipe=one) for one in recipes)
        assert _same_method(*pair) == (caustics == "off")
