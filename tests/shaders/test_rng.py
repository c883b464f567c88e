"""Random numbers: the same in numpy and in the shader, uniform, and independent.

Every statistical test has fixed seeds, so its verdict never changes; tests/support/alarms.py says
by which chance good numbers would fail it.
"""

from typing import Any

import numpy as np
import pytest

from tests.conftest import CallGlsl
from tests.support.alarms import SIGMAS, assert_fits, assert_near, book
from tests.wgsl.seeds import pcg, seed_texture

Array = np.ndarray[Any, Any]

GOLDEN = 0x9E3779B9  # steps from one dimension to the next
SIZE, FRAMES, BLOCK = 128, 256, 8


def drawn(seeds: Array, count: int) -> Array:
    """The first `count` numbers of each seed, as integers below 2^24, (n, count)."""
    steps = np.arange(1, count + 1, dtype=np.uint64) * GOLDEN
    return pcg(seeds.reshape(-1, 1) ^ steps.astype(np.uint32)) >> np.uint32(8)


def sums_over_frames(
    call_glsl: CallGlsl, first_sample: int, seed: int, seeding: str = "pixel_seed", skipped: int = 0
) -> Array:
    """Each pixel's sum of one number of each frame less 1/2, scaled to variance 1."""
    wrong = f"""
        uint index_plus_frame(ivec2 pixel, int frame, uint seed) {{
            return pcg_hash(uint(pixel.y * {SIZE} + pixel.x) + uint(frame) + seed);
        }}"""
    setup = f"""
        float sum = 0.0;
        for (int k = 0; k < {FRAMES}; ++k) {{
            Sampler rng = make_sampler({seeding}(ivec2(i % {SIZE}, i / {SIZE}), first + k, seed));
            for (int skip = 0; skip < skipped; ++skip) next_1d(rng);
            sum += next_1d(rng) - 0.5;
        }}"""
    sums = call_glsl(
        "sum + 0.0 * float(pixel)",
        setup=setup,
        functions=wrong,
        pixel=np.arange(SIZE * SIZE),
        first=np.array([first_sample], np.uint32).view(np.int32),
        seed=np.array([seed], np.uint32),
        skipped=np.array([skipped]),
    )
    scores: Array = sums.astype(np.float64).reshape(SIZE, SIZE) / np.sqrt(FRAMES / 12)
    return scores


def correlation(a: Array, b: Array) -> float:
    return float(np.corrcoef(a.ravel(), b.ravel())[0, 1])


def departures(z: Array) -> dict[str, float]:
    """Figures beyond the bounds, of a picture of scores that should be independent and normal."""
    side = SIZE // BLOCK
    blocks = z.reshape(side, BLOCK, side, BLOCK).sum(axis=(1, 3)) / BLOCK
    figures = {  # its value less the value wanted, and its standard deviation
        "mean": (z.mean(), 1 / SIZE),
        "std of pixels": (z.std() - 1, 1 / np.sqrt(2 * z.size)),
        "std of blocks": (blocks.std() - 1, 1 / np.sqrt(2 * blocks.size)),
        "right neighbour": (correlation(z[:, 1:], z[:, :-1]), 1 / SIZE),
        "lower neighbour": (correlation(z[1:], z[:-1]), 1 / SIZE),
        "diagonal neighbour": (correlation(z[1:, 1:], z[:-1, :-1]), 1 / SIZE),
    }
    book(len(figures))
    return {name: value for name, (value, sd) in figures.items() if abs(value) > SIGMAS * sd}


# --- bits ----------------------------------------------------------------------------------


def test_the_hash_of_the_shader_is_the_hash_of_numpy(call_glsl: CallGlsl) -> None:
    edges = [0, 1, 2**24, 2**31 - 1, 2**31, 2**32 - 1]
    many = np.random.default_rng(1).integers(0, 2**32, 100_000, np.uint32)
    xs = np.concatenate([np.array(edges, np.uint32), many])
    assert np.array_equal(call_glsl("pcg_hash(x)", "uint", x=xs), pcg(xs))
    assert pcg(0)[0] == 129708002  # in whole numbers of any size, modulo 2^32


@pytest.mark.parametrize(
    ("sample", "seed"), [(0, 0), (1, 0), (1000, 7), (2**20, 2**31), (2**31 - 1, 2**32 - 1)]
)
def test_numbers_from_stored_seeds_equal_those_from_the_place_of_a_pixel_to_the_last_bit(
    call_glsl: CallGlsl, sample: int, seed: int
) -> None:
    width, height, count = 37, 23, 16
    setup = f"""
        ivec2 pixel = ivec2(i % {width}, i / {width});
        Sampler placed = make_sampler(pixel_seed(pixel, sample_index, seed));
        Sampler from_texture = make_sampler(stored);
        uint digest = 0u;
        int equal = 0;
        for (int k = 0; k < {count}; ++k) {{
            float x = next_1d(placed);
            digest = pcg_hash(digest) + uint(x * 16777216.0);
            if (floatBitsToUint(next_1d(from_texture)) == floatBitsToUint(x)) ++equal;
        }}"""
    stored = seed_texture(width, height, sample, seed).ravel()
    equal, digest = call_glsl(
        "uvec2(equal, digest)",
        "uvec2",
        setup=setup,
        stored=stored,
        sample_index=np.array([sample]),
        seed=np.array([seed], np.uint32),
    ).T
    assert np.all(equal == count)
    expected = np.zeros(len(stored), np.uint32)
    for number in drawn(stored, count).T:
        expected = pcg(expected) + number
    assert np.array_equal(digest, expected)


def test_every_frame_and_every_seed_refreshes_every_pixel() -> None:
    first = seed_texture(64, 64, 0, 0)
    assert len(np.unique(first)) == first.size
    for sample, seed in ((1, 0), (0, 1), (1, 1)):
        assert not np.any(seed_texture(64, 64, sample, seed) == first)


def test_two_numbers_are_drawn_one_after_the_other(call_glsl: CallGlsl) -> None:
    seeds = np.arange(100, dtype=np.uint32)
    pairs = call_glsl("next_2d(rng)", "vec2", setup="Sampler rng = make_sampler(s);", s=seeds)
    assert np.array_equal(pairs * 2**24, drawn(seeds, 2))


def test_a_unit_float_lies_in_the_unit_interval_and_is_never_one(call_glsl: CallGlsl) -> None:
    xs = np.array([0, 255, 256, 2**31, 2**32 - 256, 2**32 - 1], np.uint32)
    expected = [0, 0, 2**-24, 0.5, 1 - 2**-24, 1 - 2**-24]
    assert call_glsl("unit_float(x)", x=xs).tolist() == expected
    assert np.float32(2**32 - 1) * np.float32(2**-32) == 1.0  # the form that it must not have


# --- statistics ----------------------------------------------------------------------------


def test_numbers_have_the_moments_of_uniform_ones(call_glsl: CallGlsl) -> None:
    count = 2**19
    setup = "Sampler rng = make_sampler(pixel_seed(ivec2(x % 1024, x / 1024), 3, 5u));"
    xy = call_glsl("next_2d(rng)", "vec2", setup=setup, x=np.arange(count)).astype(np.float64)
    x, y = (xy - 0.5).T
    for z in (x, y):
        assert_near(z.mean(), 0, np.sqrt(1 / 12 / count))
        assert_near((z**2).mean(), 1 / 12, np.sqrt(1 / 180 / count))
        assert_near((z**3).mean(), 0, np.sqrt(1 / 448 / count))
    assert_near((x * y).mean(), 0, 1 / 12 / np.sqrt(count))


def test_a_hundred_million_numbers_have_the_mean_of_uniform_ones(call_glsl: CallGlsl) -> None:
    """2^27 of them, known to 1e-5 of their range; summed as whole numbers of 16 bits."""
    lanes, rounds = 2**16, 2**11
    setup = f"""
        uint sum = 0u;
        Sampler rng = make_sampler(pixel_seed(ivec2(x % 256, x / 256), 0, 9u));
        for (int k = 0; k < {rounds}; ++k) sum += uint(next_independent(rng) * 65536.0);"""
    sums = call_glsl("sum", "uint", setup=setup, x=np.arange(lanes)).astype(np.float64)
    mean = sums.sum() / (lanes * rounds) / 65536
    assert_near(mean, 0.5 * (1 - 2.0**-16), np.sqrt(1 / 12 / (lanes * rounds)))
    assert_near(sums.var() / 65536**2, rounds / 12, rounds / 12 * np.sqrt(2 / lanes))


def test_consecutive_numbers_of_a_pixel_are_not_correlated() -> None:
    numbers = drawn(seed_texture(256, 128, 0, 0), 24) / 2**24
    for lag in range(1, 9):
        earlier, later = numbers[:, :-lag], numbers[:, lag:]
        assert_near(correlation(earlier, later), 0, 1 / np.sqrt(earlier.size))


@pytest.mark.parametrize("dimensions", [(0, 1), (1, 2), (2, 3), (0, 7), (7, 8)])
def test_pairs_of_numbers_fill_the_square_evenly(dimensions: tuple[int, int]) -> None:
    numbers = drawn(seed_texture(512, 256, 0, 0), max(dimensions) + 1)
    cells = numbers[:, dimensions] >> np.uint32(20)  # 16 x 16 cells
    counts = np.bincount(16 * cells[:, 0] + cells[:, 1], minlength=256)
    assert_fits(counts, np.full(256, len(numbers) / 256))


@pytest.mark.parametrize(
    ("first_sample", "seed", "skipped"),
    [
        (0, 0, 0),
        (0, 1, 1),
        (0, 0, 7),
        (2**20 - FRAMES, 0, 0),
        (2**24 - 2, 2**24 - 1, 0),
        (2**31 - 2, 2**31 - 1, 0),
        (2**32 - 2, 2**32 - 1, 2),
    ],
)
def test_pixels_and_their_neighbours_are_independent_over_many_frames(
    call_glsl: CallGlsl, first_sample: int, seed: int, skipped: int
) -> None:
    z = sums_over_frames(call_glsl, first_sample, seed, skipped=skipped)
    assert departures(z) == {}


def test_a_seed_of_index_plus_frame_is_caught(call_glsl: CallGlsl) -> None:
    z = sums_over_frames(call_glsl, 0, 0, seeding="index_plus_frame")
    found = departures(z)
    assert found["std of blocks"] > 1
    assert found["right neighbour"] > 0.9


def test_pictures_of_two_seeds_are_independent(call_glsl: CallGlsl) -> None:
    pictures = [sums_over_frames(call_glsl, 0, seed) for seed in (0, 1, 2**32 - 1)]
    for a, b in ((0, 1), (0, 2), (1, 2)):
        assert_near(correlation(pictures[a], pictures[b]), 0, 1 / SIZE)
