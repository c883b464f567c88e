"""Rough glass: against float64, quadratures, and itself."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import CallGlsl
from tests.shaders.test_dielectric import fresnel64
from tests.shaders.test_material import ggx_d64, ggx_lambda
from tests.shaders.test_sampling import GRIDS
from tests.support.builders import glass, scene_of, sphere
from tests.support.chi_square import assert_density
from tests.support.numerics import Array, float32, lattice, wo_at

GLASSES = [(0.3, 1.5), (0.5, 1.33), (0.8, 1.5), (1.0, 2.4), (0.6, 0.7)]  # roughness, ior
COSINES = (0.95, 0.6, 0.15)
WIDE = [(0.5, 1.5), *GLASSES[1:]]  # lobes that a quadrature resolves
CASES = [(*one, outside, cosine) for one in WIDE for outside in (1, 0) for cosine in COSINES]
SETUP = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    Vertex vertex = vertex_of(up, wo, material_at(0), outside == 1);"""


def rough(roughness: float, ior: float, **more: Any) -> dict[str, Any]:
    """A scene of one ball of rough glass, as an input of call_glsl."""
    ball = sphere([0, 0, -3], 1, "glass")
    return {"scene": scene_of([ball], {"glass": glass(ior, roughness=roughness, **more)})}


BOTH_WAYS = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    float side = wo.z > 0.0 ? 1.0 : -1.0;
    Vertex there = vertex_of(up, side * wo, material_at(0), wo.z > 0.0);
    float back = wi.z > 0.0 ? 1.0 : -1.0;
    Vertex again = vertex_of(up, back * wi, material_at(0), wi.z > 0.0);
    float a = eval_material(there, side * wi).x * there.wo.z;
    float b = eval_material(again, back * wo).x * again.wo.z;"""  # f cos wi cos wo, exchanged in b


def assert_weights(call_glsl: CallGlsl, outside: Array, **scene: Any) -> None:
    """The weight of a sample is its value over its density; `outside`: 1 or 0 for each of some."""
    wo = np.abs(directions(50_000, 6))
    u = np.random.default_rng(5).uniform(size=(len(wo), 3))
    setup = SETUP + "Scattering next = sample_rough_dielectric(vertex, u.x, u.yz);"
    setup += "vec3 wi = next.direction;"
    found = call_glsl(
        "vec4(next.weight.x * next.scale, next.pdf, pdf_material(vertex, wi), "
        "eval_material(vertex, wi).x)",
        "vec4", setup=setup, wo=wo, u=u, outside=outside, **scene,
    ).astype(np.float64)  # fmt: skip
    weight, pdf, again, value = found[found[:, 1] > 0].T
    assert len(weight) > 30_000
    near = np.isclose(pdf, again, rtol=2e-2)
    assert near.mean() > 0.999  # the rest: normals that rounding of wi moves
    assert_allclose(weight[near] * again[near], value[near], rtol=2e-2)


def directions(count: int, seed: int) -> Array:
    """Evenly over the sphere, (count, 3), none that grazes."""
    random = np.random.default_rng(seed)
    z = random.uniform(0.02, 1, count) * random.choice([-1, 1], count)
    phi = random.uniform(0, 2 * np.pi, count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


@pytest.mark.parametrize(("roughness", "ior"), GLASSES)
@pytest.mark.parametrize("outside", [1, 0])
def test_facets_scatter_as_the_textbook_says(
    call_glsl: CallGlsl, roughness: float, ior: float, outside: int
) -> None:
    """Walter et al. 2007, equations 20 and 21, with correlated shadowing, in float64."""
    wo, wi = directions(20_000, 1), directions(20_000, 2)
    wo[:, 2] = np.abs(wo[:, 2])
    setup = SETUP + "Lobe lobe = facet_lobe(vertex, glass_half(vertex, wi), wi);"
    given = {"setup": setup, "outside": np.array([outside]), **rough(roughness, ior)}
    found = call_glsl("lobe.value * glass_scale(vertex, wi)", wo=wo, wi=wi, **given)
    o, i = float32(wo), float32(wi)
    n_o, n_i = (1, ior) if outside else (ior, 1)
    reflects = i[:, 2] > 0
    h = np.where(reflects[:, None], o + i, n_o * o + n_i * i)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    h *= np.sign(h[:, 2:])
    cos_o, cos_i = np.sum(o * h, axis=1), np.sum(i * h, axis=1)
    faces = (cos_o > 0) & ((cos_i > 0) == reflects)
    share = fresnel64(np.maximum(cos_o, 1e-9), n_o / n_i)
    alpha = np.array(roughness**2)
    masked = ggx_d64(alpha, h) / (1 + ggx_lambda(alpha, o) + ggx_lambda(alpha, i))
    mirrored = share * masked / (4 * o[:, 2])
    bent = (1 - share) * masked * n_o**2 * cos_o * -cos_i / o[:, 2]
    bent /= (n_o * cos_o + n_i * cos_i) ** 2
    exact = np.where(faces, np.where(reflects, mirrored, bent), 0)
    assert np.count_nonzero(faces & ~reflects) > 1000
    sure = np.abs(cos_o * cos_i) > 1e-4
    assert_allclose(found[sure], exact[sure], rtol=2e-3, atol=3e-6)


@pytest.mark.parametrize(("roughness", "ior"), GLASSES)
def test_light_goes_both_ways_except_for_eta_squared(
    call_glsl: CallGlsl, roughness: float, ior: float
) -> None:
    """f(wo, wi) cos wi cos wo: alike when both change places, over n^2 of the side of wi."""
    wo, wi = directions(20_000, 3), directions(20_000, 4)
    a, b = call_glsl("vec2(a, b)", "vec2", setup=BOTH_WAYS, wo=wo, wi=wi, **rough(roughness, ior)).T
    n2 = [np.where(w[:, 2] > 0, 1.0, ior**2) for w in (wo, wi)]
    assert np.count_nonzero(a) > 15_000
    assert_allclose(a / n2[0], b / n2[1], rtol=2e-3, atol=1e-7)


@pytest.mark.parametrize(("roughness", "ior"), GLASSES)
@pytest.mark.parametrize("outside", [1, 0])
def test_no_light_is_lost_or_gained(
    call_glsl: CallGlsl, roughness: float, ior: float, outside: int
) -> None:
    """The furnace: the mean weight of samples is 1 to a percent, at every angle."""
    u = lattice()
    setup = SETUP + "Scattering next = sample_rough_dielectric(vertex, u.x, u.yz);"
    given = {"setup": setup, "outside": np.array([outside]), **rough(roughness, ior)}
    for cosine in (1.0, 0.8, 0.5, 0.3, 0.1, 0.02):
        wo = np.repeat(wo_at(cosine), len(u), axis=0)
        weight = call_glsl("next.weight.x", u=u, wo=wo, **given)
        assert weight.astype(np.float64).mean() == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize(("roughness", "ior"), GLASSES)
def test_the_weight_of_a_sample_is_its_value_over_its_density(
    call_glsl: CallGlsl, roughness: float, ior: float
) -> None:
    outside = np.random.default_rng(7).integers(0, 2, 50_000)
    assert_weights(call_glsl, outside, **rough(roughness, ior))


@pytest.mark.parametrize("grid", GRIDS, ids=str)
@pytest.mark.parametrize(("roughness", "ior", "outside", "cosine"), CASES)
def test_samples_follow_their_density(
    call_glsl: CallGlsl,
    roughness: float,
    ior: float,
    outside: int,
    cosine: float,
    grid: tuple[int, int],
) -> None:
    """Chi-square over the whole sphere, and how many samples are absorbed."""
    given = {"outside": np.array([outside]), **rough(roughness, ior)}
    fine = 128 if grid[1] > 1 else 256
    assert_density(call_glsl, SETUP, given, cosine, grid, fine, -1.0)
