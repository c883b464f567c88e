"""Points of a sampler: their error where an integrand joins ever more dimensions."""

import numpy as np

from glrt.lab.sweep import Lab, Sweep
from glrt.rendering.shader_functions import World
from glrt.samplers import DIVISIONS

SAMPLES = DIVISIONS["sobol64"].points
SUM = f"""
    float sum = 0.0;
    for (int k = 0; k < {SAMPLES}; ++k) {{
        Sampler rng = sampler_at(ivec2(x % 64, x / 64), k, 7u);
        float product = 1.0;
        for (int number = 0; number < numbers; number += 2) {{
            vec2 u = drawn(rng) + 0.5;
            product *= number + 1 < numbers ? u.x * u.y : u.x;
        }}
        sum += product;
    }}"""
SHUFFLED = "vec2 drawn(inout Sampler rng) { return next_2d(rng); }"
IN_ORDER = """
vec2 drawn(inout Sampler rng) {
    rng.dimension += STEP;
    return next_of_net(rng, 0u, (rng.dimension & 1u) == 0u);
}"""


def dimensions(lab: Lab) -> Sweep:
    """Error of means of 64 samples of the product of u + 1/2 over some numbers u, whose mean is 1.

    Errors are relative to those of independent samples, sqrt(((13 / 12)^n - 1) / 64) for n numbers.
    """
    x = [1, 2, 4, 8, 16, 32]
    rows = np.arange(lab.count(1 << 13, 1 << 12))
    ways = {
        "glrt: blocks of 64, a shuffle every four dimensions": ("sobol64", SHUFFLED),
        "blocks of 64, the same order in all dimensions": ("sobol64", IN_ORDER),
        "glrt: blocks of 16": ("sobol", SHUFFLED),
        "independent samples": ("independent", SHUFFLED),
    }
    errors: dict[str, list[float]] = {name: [] for name in ways}
    for count in x:
        expected = np.sqrt(((13 / 12) ** count - 1) / SAMPLES)
        for name, (sampler, draw) in ways.items():
            sums = lab.path(
                "sum",
                {"x": rows, "numbers": [count]},
                World(constants={"BLOCK": DIVISIONS[sampler].points}),
                setup=SUM,
                functions=draw,
            )
            means = sums.astype(np.float64) / SAMPLES
            errors[name].append(float(np.sqrt(np.mean((means - 1) ** 2)) / expected))
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
