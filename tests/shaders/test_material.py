"""Matte surfaces, mirrors and rough metal: against closed forms, float64, and themselves.

Quadratures and grids stand in for random numbers; test_sampling.py draws.
"""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import CallGlsl
from tests.support.numerics import (
    BELOW_ONE,
    ULP,
    Array,
    corners,
    directions,
    float32,
    length,
    unit_square,
    wo_at,
)

ALPHAS = (0.09, 0.25, 0.64, 1.0)
COSINES = (1.0, 0.7, 0.2)  # of wo
LOBES = [(alpha, cosine) for alpha in ALPHAS for cosine in COSINES]
METAL = "Material(vec3(1.0), METAL, vec3(0.0), alpha, 1.0, 0, 0, -1, 0.0, 0.0, 1.0, 1.0)"
UP = "frame_around(vec3(0.0, 0.0, 1.0))"


# --- matte ---------------------------------------------------------------------------------


@pytest.mark.slow
def test_matte_light_is_spread_by_the_cosine_and_weighs_its_colour(call_glsl: CallGlsl) -> None:
    n = directions(2000)
    u = np.random.default_rng(2).uniform(size=(len(n), 2))
    setup = """
        Material matte =
            Material(vec3(0.1, 0.5, 0.9), MATTE, vec3(0.0), 0.0, 1.0, 0, 0, -1, 0.0, 0.0, 1.0, 1.0);
        Vertex vertex = vertex_of(frame_around(n), vec3(0.0, 0.0, 1.0), matte, true);
        Scattering next = sample_matte(vertex, u);
        vec3 wi = to_local(vertex.frame, next.direction);"""
    wi = call_glsl("wi", "vec3", setup=setup, n=n, u=u)
    assert_allclose(wi[:, 2], np.sqrt(1 - u[:, 0]), atol=1e-6)
    pdf = call_glsl("vec2(next.pdf, pdf_material(vertex, wi))", "vec2", setup=setup, n=n, u=u)
    assert_allclose(pdf, np.repeat(wi[:, 2:] / np.pi, 2, axis=1), rtol=1e-3, atol=1e-7)
    ratio = call_glsl("eval_material(vertex, wi) / next.pdf", "vec3", setup=setup, n=n, u=u)
    weight = call_glsl("next.weight", "vec3", setup=setup, n=n, u=u)
    assert_allclose(ratio, weight, rtol=1e-3)
    assert np.all(weight == np.array([0.1, 0.5, 0.9], np.float32))


# --- metal ---------------------------------------------------------------------------------


def test_a_mirror_reflects_at_the_angle_of_incidence(call_glsl: CallGlsl) -> None:
    wo = directions(2000)
    wo[:, 2] = np.abs(wo[:, 2])
    wo = wo[wo[:, 2] > 0]
    setup = """
        Material mirror =
            Material(vec3(0.25), METAL, vec3(0.0), 0.0, 1.0, 0, 0, -1, 0.0, 0.0, 1.0, 1.0);
        Scattering next = sample_metal(vertex_of(frame_around(n), wo, mirror, true), vec2(0.3));
        vec3 wi = to_local(frame_around(n), next.direction);"""
    n = np.resize(directions(100), (len(wo), 3))
    wi = call_glsl("wi", "vec3", setup=setup, wo=wo, n=n)
    assert np.abs(wi - wo * [-1, -1, 1]).max() < 1e-6
    figures = call_glsl("vec2(next.pdf, next.weight.x)", "vec2", setup=setup, wo=wo, n=n)
    assert np.all(figures == [0, 0.25])


def test_only_mirrors_and_glass_are_deltas(call_glsl: CallGlsl) -> None:
    kind, alpha = np.array([0, 1, 1, 2]), np.array([0.0, 0.0, 0.1, 0.0])
    material = "Material(vec3(1.0), kind, vec3(0.0), alpha, 1.0, 0, 0, -1, 0.0, 0.0, 1.0, 1.0)"
    found = call_glsl(f"is_delta({material})", "bool", kind=kind, alpha=alpha)
    assert found.tolist() == [False, True, False, True]


def ggx_lambda(alpha: Array | float, w: Array) -> Array:
    """Smith's auxiliary function, float64."""
    tan2 = (w[..., 0] ** 2 + w[..., 1] ** 2) / w[..., 2] ** 2
    masking: Array = (np.sqrt(1 + np.asarray(alpha) ** 2 * tan2) - 1) / 2
    return masking


def ggx_d64(alpha: Array, h: Array) -> Array:
    """Trowbridge and Reitz's distribution by the tangent of its angle, float64."""
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    tan2 = (h[..., 0] ** 2 + h[..., 1] ** 2) / h[..., 2] ** 2
    density: Array = 1 / (np.pi * alpha**2 * h[..., 2] ** 4 * (1 + tan2 / alpha**2) ** 2)
    return density


def test_the_distribution_keeps_its_digits_in_narrow_lobes(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(3)
    alpha = 10.0 ** random.uniform(-4, 0, 20_000)
    tangent = alpha * 10.0 ** random.uniform(-2, 2, len(alpha))
    h = np.stack([tangent * 0.6, tangent * 0.8, np.ones_like(alpha)], axis=-1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    found = call_glsl("ggx_d(alpha, h)", alpha=alpha, h=h)
    assert_allclose(found, ggx_d64(float32(alpha), float32(h)), rtol=2e-6)


def test_shadowing_is_smiths_with_correlated_heights(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(4)
    alpha = 10.0 ** random.uniform(-4, 0, 20_000)
    wo, wi = (np.abs(directions(20_000, seed))[:20_000] + np.float32(1e-4) for seed in (5, 6))
    found = call_glsl("ggx_weight(alpha, wo, wi)", alpha=alpha, wo=wo, wi=wi)
    lo, li = (ggx_lambda(float32(alpha), float32(w)) for w in (wo, wi))
    assert_allclose(found, (1 + lo) / (1 + lo + li), rtol=1e-5)


@pytest.mark.slow
def test_rough_metal_equals_the_textbook_formula_and_is_reciprocal(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(7)
    alpha = random.uniform(0.05, 1, 20_000)
    wo, wi = (directions(20_000, seed)[:20_000] for seed in (8, 9))
    wo[:, 2], wi[:, 2] = np.abs(wo[:, 2]) + 0.01, np.abs(wi[:, 2]) + 0.01
    setup = f"""
        Vertex a = vertex_of({UP}, wo, {METAL}, true);
        Vertex b = vertex_of({UP}, wi, {METAL}, true);"""
    args = {"setup": setup, "alpha": alpha, "wo": wo, "wi": wi}
    there = call_glsl("eval_material(a, wi).x", **args)
    back = call_glsl("eval_material(b, wo).x", **args)
    assert_allclose(there * wo[:, 2], back * wi[:, 2], rtol=1e-5)
    a, o, i = float32(alpha), float32(wo), float32(wi)
    masked = 1 / (1 + ggx_lambda(a, o) + ggx_lambda(a, i))
    exact = ggx_d64(a, o + i) * masked / (4 * o[:, 2])  # D G2 / (4 cos cos) times the cosine
    assert_allclose(there, exact, rtol=2e-5)


def over_the_sphere(call_glsl: CallGlsl, what: str, side: int) -> Array:
    """Integrals of `what` over the directions wi above (side 1) or below: one for each lobe.

    The midpoint rule in height and azimuth; a lane sums one height.
    """
    rows, columns = 1000, 1000
    heights = side * (np.arange(rows) + 0.5) / rows
    alpha, cosine = np.array(LOBES).T
    setup = f"""
        float sum = 0.0;
        float r = sqrt(1.0 - z * z);
        Vertex vertex = vertex_of({UP}, wo, {METAL}, true);
        for (int k = 0; k < {columns}; ++k) {{
            float phi = 2.0 * PI * (float(k) + 0.5) / {columns}.0;
            vec3 wi = vec3(r * cos(phi), r * sin(phi), z);
            vec3 h = normalized(wo + wi);
            if (h.z > 0.0) sum += {what};
        }}"""
    sums = call_glsl(
        "sum",
        setup=setup,
        z=np.tile(heights, len(LOBES)),
        alpha=np.repeat(alpha, rows),
        wo=np.repeat(wo_at(cosine), rows, axis=0),
    )
    integrals: Array = sums.astype(np.float64).reshape(len(LOBES), rows).sum(axis=1)
    return integrals * 2 * np.pi / (rows * columns)


def scattered(call_glsl: CallGlsl, what: str, returns: str, **inputs: Any) -> Array:
    """Something of the Scattering that rough metal samples from `alpha`, `wo` and `u`."""
    setup = f"""
        Vertex vertex = vertex_of({UP}, wo, {METAL}, true);
        Scattering next = sample_metal(vertex, u);
        vec3 wi = next.direction;"""
    return call_glsl(what, returns, setup=setup, **inputs)


def grid_of_lobes(side: int = 256) -> dict[str, Array]:
    """The unit square for each lobe, as inputs of `scattered`."""
    u = unit_square(side)
    alpha, cosine = np.array(LOBES).T
    return {
        "u": np.tile(u, (len(LOBES), 1)),
        "alpha": np.repeat(alpha, len(u)),
        "wo": np.repeat(wo_at(cosine), len(u), axis=0),
    }


def by_lobe(values: Array) -> Array:
    means: Array = values.astype(np.float64).reshape(len(LOBES), -1).mean(axis=1)
    return means


def test_the_density_of_rough_metal_integrates_to_one(call_glsl: CallGlsl) -> None:
    above = over_the_sphere(call_glsl, "pdf_ggx(alpha, wo, h)", 1)
    below = over_the_sphere(call_glsl, "pdf_ggx(alpha, wo, h)", -1)
    assert above + below == pytest.approx(np.ones(len(LOBES)), abs=5e-4)
    assert above.max() < 1 + 1e-4
    for lobe, (alpha, cosine) in enumerate(LOBES):
        if cosine == 1:  # a normal steeper than 45 degrees sends the light below
            assert below[lobe] == pytest.approx(alpha**2 / (1 + alpha**2), abs=1e-5)
    absorbed = by_lobe(
        scattered(call_glsl, "float(next.weight.x == 0.0)", "float", **grid_of_lobes())
    )
    assert absorbed == pytest.approx(below, abs=2e-3)


@pytest.mark.slow
def test_rough_metal_sends_back_no_more_than_it_gets_and_sampling_says_how_much(
    call_glsl: CallGlsl,
) -> None:
    reflected = over_the_sphere(call_glsl, "eval_material(vertex, wi).x", 1)
    weights = by_lobe(scattered(call_glsl, "next.weight.x", "float", **grid_of_lobes()))
    assert weights == pytest.approx(reflected, abs=1e-3)
    assert reflected.max() < 1 + 1e-4
    assert reflected[LOBES.index((1.0, 1.0))] == pytest.approx(1 - np.log(2), abs=1e-5)
    direct = over_the_sphere(call_glsl, "eval_material(vertex, wi).x * wi.x", 1)
    sampled = by_lobe(scattered(call_glsl, "next.weight.x * wi.x", "float", **grid_of_lobes()))
    assert sampled == pytest.approx(direct, abs=1e-3)


def test_the_weight_of_a_sample_is_its_value_over_its_density(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(10)
    count = 50_000
    inputs = {
        "alpha": random.uniform(0.05, 1, count),
        "wo": wo_at(random.uniform(0.02, 1, count)),
        "u": random.uniform(size=(count, 2)),
    }
    weight, pdf, again, value = scattered(
        call_glsl,
        "vec4(next.weight.x, next.pdf, pdf_material(vertex, wi), eval_material(vertex, wi).x)",
        "vec4",
        **inputs,
    ).T
    kept = weight > 0
    assert kept.mean() > 0.7
    assert_allclose(again[kept], pdf[kept], rtol=2e-3)
    assert np.median(np.abs(again[kept] / pdf[kept] - 1)) < 1e-6
    assert_allclose(value[kept] / again[kept], weight[kept], rtol=1e-3)


def test_rough_metal_stays_finite_from_every_angle_and_for_every_number(
    call_glsl: CallGlsl,
) -> None:
    random = np.random.default_rng(11)
    count = 200_000
    u = random.uniform(size=(count, 2)).astype(np.float32)
    u[: count // 2] = np.resize(corners(), (count // 2, 2))
    inputs = {
        "u": np.minimum(u, np.float32(BELOW_ONE)),
        "alpha": 10.0 ** random.uniform(-4, 0, count),
        "wo": wo_at(np.minimum(10.0 ** random.uniform(-8, 0.3, count), 1)),
    }
    weight, pdf, value, wi_z = scattered(
        call_glsl,
        "vec4(next.weight.x, next.pdf, eval_material(vertex, wi).x, wi.z)",
        "vec4",
        **inputs,
    ).T
    kept = weight != 0
    assert np.all(np.isfinite(weight))
    assert np.all((weight >= 0) & (weight <= 1 + 1e-5))
    assert np.all(np.isfinite(pdf[kept]) & (pdf[kept] > 0))
    assert np.all(np.isfinite(value[kept]) & (value[kept] >= 0))
    assert wi_z[kept].min() > 0
    assert np.abs(length(scattered(call_glsl, "wi", "vec3", **inputs))[kept] - 1).max() < 4 * ULP
