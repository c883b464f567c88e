"""Reservoirs alone: what they keep, what that stands for, and how they lie in a texture."""

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.conftest import CallGlsl

LANES = 200_000
STREAM = """
Sampler rng = make_sampler(seed);
Stream stream = empty_stream();
for (int i = 0; i < count; i += 1) {
    float x = next_independent(rng);
    float u = next_independent(rng);
    Source source = Source(vec3(0.0), vec3(0.0), vec3(x), i);
    offer(stream, source, luminance(source.light) / float(count), i, u);
}
"""


@pytest.mark.parametrize(
    ("count", "variance"), [(1, 0.0889), (2, 0.0514), (4, 0.0327), (16, 0.0187), (64, 0.0151)]
)
def test_an_integral_keeps_its_mean_however_many_are_offered(
    call_glsl: CallGlsl, count: int, variance: float
) -> None:
    """The integral of x^2 over 0 to 1, with x as the target, is 1 / 3.

    The variance falls from that of even numbers, 4 / 45, to that of numbers with the density 2 x,
    1 / 72.
    """
    seeds = np.arange(LANES, dtype=np.uint32) * 2654435761 + np.uint32(count)
    value = "stream.kept.light.x * stream.kept.light.x * (stream.sum / stream.kept.light.x)"
    found = call_glsl(value, setup=STREAM, seed=seeds.astype(np.uint32), count=np.array([count]))
    assert abs(found.mean(dtype=np.float64) - 1 / 3) < 5.5 * np.sqrt(variance / LANES)
    assert found.var(dtype=np.float64) == pytest.approx(variance, rel=0.03)
    assert found.var(dtype=np.float64) > 1 / 72


@pytest.mark.parametrize("weights", [(1, 2, 3, 4), (4, 3, 2, 1), (0, 5, 0, 1), (0, 0, 0, 7)])
def test_candidates_are_kept_as_often_as_they_weigh(
    call_glsl: CallGlsl, weights: tuple[int, ...]
) -> None:
    """This holds in any order, and a candidate without a weight is never kept."""
    setup = "Sampler rng = make_sampler(seed); Stream stream = empty_stream();"
    weighed = {f"weight{number}": np.array([float(it)]) for number, it in enumerate(weights)}
    for number in range(4):
        setup += f"float u{number} = next_independent(rng);"
        setup += f"offer(stream, no_source(), weight{number}, {number}, u{number});"
    seeds = np.arange(LANES, dtype=np.uint32) + np.uint32(17)
    kept = call_glsl("float(stream.origin)", setup=setup, seed=seeds, **weighed).astype(int)
    counts = np.bincount(kept, minlength=4)
    expected = LANES * np.array(weights) / sum(weights)
    assert (counts[expected == 0] == 0).all()
    some = expected > 0
    chi2 = float(((counts - expected)[some] ** 2 / expected[some]).sum())
    assert chi2 < 40  # 3 degrees of freedom: once in 10^8


def test_what_a_point_brings_falls_with_both_cosines_and_the_squared_distance(
    call_glsl: CallGlsl,
) -> None:
    random = np.random.default_rng(5)
    at, source = random.normal(size=(2, 4000, 3)).astype(np.float32)
    normal, other = random.normal(size=(2, 4000, 3))
    normal, other = (
        np.asarray(n / np.linalg.norm(n, axis=1)[:, None], np.float32) for n in (normal, other)
    )
    call = (
        "geometry_term(Receiver({0} * at, normal, 0, false),"
        " Source({0} * source, other, vec3(1.0), 0))"
    )
    inputs = {"at": at, "source": source, "normal": normal, "other": other}
    found = call_glsl(call.format("1.0"), **inputs)
    away = (source - at).astype(float)
    distance = np.linalg.norm(away, axis=1)
    here, there = ((n * away).sum(axis=1) / distance for n in (normal, -other))
    truth = np.where((here > 0) & (there > 0), here * there / distance**2, 0)
    clear = np.minimum(np.abs(here), np.abs(there)) > 1e-3
    np.testing.assert_allclose(found[clear], truth[clear], rtol=1e-3)
    assert (truth > 0).sum() > 500
    small: NDArray[np.float32] = call_glsl(call.format("0.0078125"), **inputs)
    assert np.array_equal(small, found * np.float32(2.0**14))


def test_a_point_where_it_is_seen_from_brings_nothing(call_glsl: CallGlsl) -> None:
    call = "geometry_term(Receiver(at, vec3(0.0, 1.0, 0.0), 0, false), Source(at, -at, at, 0))"
    assert call_glsl(call, at=np.ones((1, 3), np.float32)).tolist() == [0.0]


def test_numbers_of_shapes_survive_a_texture_of_floats(call_glsl: CallGlsl) -> None:
    numbers = np.array([-1, 0, 1, 65535, 65536, 2**24 + 1, 2**31 - 1], np.int32)
    found = call_glsl("uint(of_halves(halves_of(number)))", returns="uint", number=numbers)
    assert found.astype(np.int64).tolist() == [n % 2**32 for n in numbers.tolist()]


def test_parts_of_reservoirs_lie_apart(call_glsl: CallGlsl) -> None:
    """A block of 3 x 2 texels for each pixel."""
    pixels = np.repeat([[x, y] for x in range(3) for y in range(3)], 6, axis=0).astype(np.int32)
    parts = np.tile(np.arange(6, dtype=np.int32), 9)
    call = "vec2(texel_of_part(ivec2(x, y), part))"
    found = call_glsl(call, returns="vec2", x=pixels[:, 0], y=pixels[:, 1], part=parts)
    assert len({tuple(texel) for texel in found.tolist()}) == 54
    assert (found.min(axis=0) == 0).all()
    assert found.max(axis=0).tolist() == [8.0, 5.0]
