"""Points of a sampler: their error by dimensions of the integrand, and by numbers of samples."""

import numpy as np

from glrt.lab.sweep import Lab, Sweep
from glrt.rendering.shader_functions import World
from glrt.samplers import DIVISIONS

SAMPLES = DIVISIONS["sobol64"].points
SMOOTH = 4  # numbers of an integrand that points of any sampler integrate well
SUM = """
    float sum = 0.0;
    for (int k = 0; k < samples; ++k) {
        Sampler rng = sampler_at(ivec2(x % 64, x / 64), k, 7u);
        float product = 1.0;
        for (int number = 0; number < numbers; number += 2) {
            vec2 u = drawn(rng) + 0.5;
            product *= number + 1 < numbers ? u.x * u.y : u.x;
        }
        sum += product;
    }"""
SHUFFLED = "vec2 drawn(inout Sampler rng) { return next_2d(rng); }"
IN_ORDER = """
vec2 drawn(inout Sampler rng) {
    rng.dimension += STEP;
    return next_of_net(rng, 0u, (rng.dimension & 1u) == 0u);
}"""

BY_ROWS = """
vec2 drawn(inout Sampler rng) {
    bool is_first = rng.dimension == 0u;
    float x = next_independent(rng);
    vec2 u = vec2(x, next_independent(rng));
    vec2 cell = vec2(float(rng.point % 32u), float(rng.point / 32u));
    return is_first ? (cell + u) / 32.0 : u;
}"""


def dimensions(lab: Lab) -> Sweep:
    """Error of means of 64 samples of the product of u + 1/2 over some numbers u, whose mean is 1.

    Errors are relative to those of independent samples, sqrt(((13 / 12)^n - 1) / 64) for n numbers.
    """
    x = [1, 2, 4, 8, 16, 32]
    ways = {
        "glrt: blocks of 64, a shuffle every four dimensions": ("sobol64", SHUFFLED),
        "blocks of 64, the same order in all dimensions": ("sobol64", IN_ORDER),
        "glrt: blocks of 16": ("sobol", SHUFFLED),
        "independent samples": ("independent", SHUFFLED),
    }
    errors = {
        name: [_error(lab, sampler, SAMPLES, count, draw) for count in x]
        for name, (sampler, draw) in ways.items()
    }
    first, *others = errors.items()
    return Sweep(
        parameter="numbers that the integrand multiplies",
        measure="RMS error of 64 samples,\nof that of independent ones",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most 1.1 times the error of independent samples",
        bound=[1.1] * len(x),
    )


def lengths(lab: Lab) -> Sweep:
    """Error of means of any number of samples, of the product of u + 1/2 over four numbers u.

    The numbers are powers of two and lie between them, so that blocks end early. Errors are
    relative to those of independent samples.
    """
    x = [8, 16, 24, 64, 96, 256, 384, 1024, 1536]
    ways = {
        "glrt: blocks of 1024": ("sobol1024", SHUFFLED),
        "a grid of 32 x 32 cells, row by row": ("sobol1024", BY_ROWS),
        "glrt: blocks of 256": ("sobol256", SHUFFLED),
        "glrt: blocks of 64": ("sobol64", SHUFFLED),
        "glrt: blocks of 16": ("sobol", SHUFFLED),
        "independent samples": ("independent", SHUFFLED),
    }
    errors = {
        name: [_error(lab, sampler, count, SMOOTH, draw) for count in x]
        for name, (sampler, draw) in ways.items()
    }
    first, *others = errors.items()
    return Sweep(
        parameter="samples per pixel",
        measure="RMS error,\nof that of independent samples",
        x=x,
        chosen=first,
        others=dict(others),
        promise="at most the error of independent samples, wherever a block ends",
        bound=[1.0] * len(x),
    )


def _error(lab: Lab, sampler: str, samples: int, numbers: int, draw: str = SHUFFLED) -> float:
    """RMS error of means of samples, over that of independent ones."""
    rows = np.arange(lab.count(1 << 13, 1 << 12))
    sums = lab.path(
        "sum",
        {"x": rows, "numbers": [numbers], "samples": [samples]},
        World(constants={"BLOCK": DIVISIONS[sampler].points}),
        setup=SUM,
        functions=draw,
    )
    means = sums.astype(np.float64) / samples
    expected = np.sqrt(((13 / 12) ** numbers - 1) / samples)
    return float(np.sqrt(np.mean((means - 1) ** 2)) / expected)
