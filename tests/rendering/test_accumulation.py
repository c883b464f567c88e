"""A pixel keeps mean and variance of its finite samples, without losing their digits."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from tests.conftest import CallGlsl
from tests.shaders.test_rng import drawn
from tests.support.numerics import Array
from tests.wgsl.seeds import pcg

NAN, INFINITY = 0x7FC00000, 0x7F800000  # bits of floats
SAMPLES = 4096

# Adds `count` samples; the one numbered `bad` gets the bits `poison` into one of its channels.
GATHER = """
    Pixel pixel = empty_pixel();
    Sampler rng = make_sampler(seed);
    int index = 0;
    for (int k = 0; k < count; ++k) {
        float u = next_independent(rng);
        vec3 x = vec3(u, 1000.0 + u, u < 0.01 ? 10000.0 : 0.0);
        if (k == bad) x[k % 3] = uintBitsToFloat(poison);
        if (k == bad && skip == 1) continue;
        add_sample(pixel, x, index);
        ++index;
    }"""


def gathered(call_glsl: CallGlsl, seeds: Array, count: int = SAMPLES, **more: Any) -> list[Array]:
    """Mean, variance and dropped samples of each lane."""
    constants = more.pop("constants", {})
    given = {"count": count, "bad": -1, "skip": 0, **more}
    args: dict[str, Any] = {name: np.array([value]) for name, value in given.items()}
    args |= {"poison": np.array([more.get("poison", 0)], np.uint32), "seed": seeds}
    figures = (
        ("pixel.mean", "vec3"),
        ("pixel.variance", "vec3"),
        ("float(index) - pixel.count", "float"),
    )
    return [
        call_glsl(what, returns, setup=GATHER, constants=constants, **args)
        for what, returns in figures
    ]


def samples_of(seeds: Array, count: int) -> Array:
    """The same samples in numpy, (n, count, 3) float64."""
    u = (drawn(seeds, count) / np.float32(2**24)).astype(np.float32)
    spikes = np.where(u < np.float32(0.01), 10000.0, 0.0)
    return np.stack([u, np.float32(1000) + u, spikes], axis=-1).astype(np.float64)


SEEDS = pcg(np.arange(64))


# --- running mean and variance -------------------------------------------------------------


def test_the_running_mean_keeps_its_digits_over_many_samples(call_glsl: CallGlsl) -> None:
    mean, _, dropped = gathered(call_glsl, SEEDS)
    assert_allclose(mean, samples_of(SEEDS, SAMPLES).mean(axis=1), rtol=2e-5)  # PT1
    assert np.all(dropped == 0)


def test_the_running_variance_is_that_of_float64(call_glsl: CallGlsl) -> None:
    _, variance, _ = gathered(call_glsl, SEEDS)
    exact = samples_of(SEEDS, SAMPLES).var(axis=1)
    assert_allclose(variance[:, [0, 2]], exact[:, [0, 2]], rtol=1e-4)
    assert_allclose(variance[:, 1], exact[:, 1], rtol=2e-2)  # of 1000 + u, rounded to 6e-5


def test_equal_samples_have_their_value_as_mean_and_no_variance(call_glsl: CallGlsl) -> None:
    values = np.array([0.1, 1 / 3, 1.0, 12345.678, 1e-30, 1e30])
    setup = """Pixel pixel = empty_pixel();
        for (int k = 0; k < 5000; ++k) add_sample(pixel, vec3(x), k);"""
    found = call_glsl("vec2(pixel.mean.x, pixel.variance.x)", "vec2", setup=setup, x=values)
    assert np.array_equal(found[:, 0], values.astype(np.float32))
    assert np.all(found[:, 1] == 0)


def test_the_first_sample_is_taken_as_it_is(call_glsl: CallGlsl, context: Context) -> None:
    setup = "Pixel pixel = empty_pixel(); add_sample(pixel, x, 0);"
    least = 1e-38 if context.is_software else 2e-38  # GPUs take subnormal numbers for 0
    first = np.array([[0.1, 2.0, 3e38], [least, 0.0, 1 / 3]])
    found = call_glsl("pixel.mean", "vec3", setup=setup, x=first)
    assert np.array_equal(found, first.astype(np.float32))
    assert np.all(call_glsl("pixel.variance", "vec3", setup=setup, x=first) == 0)


@pytest.mark.parametrize("count", [15, 16, 40, 4096])
def test_the_variance_is_that_of_whole_blocks(call_glsl: CallGlsl, count: int) -> None:
    """A block that has begun counts in the mean alone."""
    blocks = {"BLOCK": 16}
    mean, variance, _ = gathered(call_glsl, SEEDS, count, constants=blocks)
    samples = samples_of(SEEDS, count)
    assert_allclose(mean, samples.mean(axis=1), rtol=2e-5)
    whole = samples[:, : count // 16 * 16].reshape(len(SEEDS), -1, 16, 3).mean(axis=2)
    exact = whole.var(axis=1) if whole.size else np.zeros((len(SEEDS), 3))
    assert_allclose(variance[:, [0, 2]], exact[:, [0, 2]], rtol=1e-4, atol=1e-9)


@pytest.mark.parametrize("bad", [0, 15, 16, 20])
def test_a_dropped_sample_leaves_its_block_to_the_others(call_glsl: CallGlsl, bad: int) -> None:
    more = {"poison": NAN, "constants": {"BLOCK": 16}}
    mean, variance, dropped = gathered(call_glsl, SEEDS, 64, bad=bad, **more)
    samples = samples_of(SEEDS, 64)
    samples[:, bad] = np.nan
    assert np.all(dropped == 1)
    assert_allclose(mean, np.nanmean(samples, axis=1), rtol=1e-5)
    exact = np.nanmean(samples.reshape(len(SEEDS), 4, 16, 3), axis=2).var(axis=1)
    assert_allclose(variance[:, 0], exact[:, 0], rtol=0.1)  # its block weighs as much as others


# --- a million samples ---------------------------------------------------------------------

STEPS, LANES, PART = 2**20, 16, 2**15  # a driver's loops may end after 65,535 rounds
ADDED = f"""
    Pixel pixel = empty_pixel();
    pixel.mean = mean;
    pixel.variance = variance;
    pixel.count = float(first);
    pixel.observations = float(first);
    for (int k = 0; k < {PART}; ++k) {{
        float u = unit_float(pcg_hash(seed ^ uint(first + k)));
        vec3 x = vec3(u, u < 0.0625 ? 64.0 : 0.5, u < 0.875 ? 1.0 : 0.25);
        add_sample(pixel, even == 1 ? vec3(0.1) : x, first + k);
    }}"""


def after_a_million(call_glsl: CallGlsl, even: bool) -> tuple[Array, Array]:
    """Mean and variance of the film after 2^20 samples, (LANES, 3) each."""
    mean, variance = np.zeros((2, LANES, 3), np.float32)
    given = {"seed": pcg(np.arange(LANES)), "even": np.array([int(even)]), "setup": ADDED}
    for first in range(0, STEPS, PART):
        args = {**given, "first": np.array([first]), "mean": mean, "variance": variance}
        parts = [call_glsl(f"pixel.{name}", "vec3", **args) for name in ("mean", "variance")]
        mean, variance = parts
    return mean, variance


@pytest.mark.slow
def test_film_keeps_its_digits_over_a_million_samples(call_glsl: CallGlsl) -> None:
    """2^20 samples, the most that may be asked for: even ones, spikes, and an edge of two values.
    Steps rounded to nearest would be off by ten times the noise at the edge (2.4e-3).
    """
    mean, variance = after_a_million(call_glsl, even=False)
    bits = pcg(pcg(np.arange(LANES))[:, None] ^ np.arange(STEPS, dtype=np.uint32))
    u = (bits >> np.uint32(8)) / np.float32(2**24)
    spikes, edge = np.where(u < 0.0625, 64.0, 0.5), np.where(u < 0.875, 1.0, 0.25)
    for channel, x in enumerate((u, spikes, edge)):
        assert_allclose(mean[:, channel], x.mean(axis=1, dtype=float), rtol=1e-4)
        assert_allclose(variance[:, channel], x.var(axis=1, dtype=float), rtol=1e-2)
    noise = edge.std() / math.sqrt(STEPS)
    assert np.abs(mean[:, 2] - edge.mean(axis=1)).max() < 0.15 * noise


def test_equal_samples_leave_the_film_as_it_is_over_a_million_of_them(call_glsl: CallGlsl) -> None:
    mean, variance = after_a_million(call_glsl, even=True)
    assert np.all(mean == np.float32(0.1))
    assert np.all(variance == 0)


# --- samples that are not finite -----------------------------------------------------------


@pytest.mark.parametrize("bad", [0, 1, 50, 199])
@pytest.mark.parametrize("poison", [NAN, INFINITY, INFINITY | 1 << 31, 0xFFFFFFFF, 0x7F800001])
def test_a_sample_that_is_not_finite_is_dropped_and_counted(
    call_glsl: CallGlsl, bad: int, poison: int
) -> None:
    mean, variance, dropped = gathered(call_glsl, SEEDS, 200, bad=bad, poison=poison)
    clean = gathered(call_glsl, SEEDS, 200, bad=bad, poison=poison, skip=1)
    assert np.all(dropped == 1)
    assert np.array_equal(mean, clean[0])  # PT6: as if it had never been drawn
    assert np.array_equal(variance, clean[1])
    others = np.delete(samples_of(SEEDS, 200), bad, axis=1)
    assert_allclose(mean, others.mean(axis=1), rtol=1e-5)


def test_a_pixel_without_a_finite_sample_is_black_and_says_so(call_glsl: CallGlsl) -> None:
    setup = """Pixel pixel = empty_pixel();
        for (int k = 0; k < 10; ++k) add_sample(pixel, vec3(uintBitsToFloat(bits)), k);"""
    bits = np.array([NAN, INFINITY], np.uint32)
    found = call_glsl("vec4(pixel.mean, pixel.count)", "vec4", setup=setup, bits=bits)
    assert found.tolist() == [[0, 0, 0, 0]] * 2


def test_large_and_small_numbers_are_finite(call_glsl: CallGlsl) -> None:
    bits = np.array([0, 1 << 31, 1, 0x00800000, 0x7F7FFFFF, 0xFF7FFFFF], np.uint32)
    assert call_glsl("is_finite(vec3(uintBitsToFloat(b)))", "bool", b=bits).all()
    for channel in range(3):
        setup = f"vec3 x = vec3(1.0); x[{channel}] = uintBitsToFloat(b);"
        bad = np.array([NAN, INFINITY], np.uint32)
        assert not call_glsl("is_finite(x)", "bool", setup=setup, b=bad).any()
