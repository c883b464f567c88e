"""Sheen of cloth: against float64, another quadrature, and itself."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.packing.material_details import pack_facets
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.sheen import LEAST_ALPHA, sheen_albedos, sheen_alpha
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.shaders.test_principled import SAMPLE, SETUP, Look, at, eval64, upper
from tests.support.builders import scene_of, sphere
from tests.support.chi_square import assert_density
from tests.support.numerics import Array, float32, lattice, wo_at

VELVET = Look(roughness=0.6, color=(0.3, 0.1, 0.2))
WHITE = (1.0, 1.0, 1.0)


def given(look: Look, roughness: float = 0.4, color: Any = (0.9, 0.5, 0.6)) -> dict[str, Any]:
    """A scene of one ball of a material with sheen, as an input of call_glsl."""
    material = {"type": "principled", **look._asdict(), "color": list(look.color)}
    material |= {"sheen": list(color), "sheen_roughness": roughness}
    return {"scene": scene_of([sphere([0, 0, -3], 1, "p")], {"p": material})}


def lobe64(alpha: float, o: Array, i: Array) -> Array:
    """The lobe of white sheen times the cosine of light, (n,), as KHR_materials_sheen writes it."""
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    sine = np.sqrt(np.maximum(1 - h[:, 2] ** 2, 0))
    spread = (2 + 1 / alpha) * sine ** (1 / alpha) / (2 * math.pi)
    seen = 1 / (4 * (o[:, 2] + i[:, 2] - o[:, 2] * i[:, 2]))
    return np.asarray(spread * seen * i[:, 2])


@pytest.mark.slow
@pytest.mark.parametrize("roughness", [0.05, 0.2, 0.5, 1.0])
def test_sheen_scatters_as_the_formulas_say(call_glsl: CallGlsl, roughness: float) -> None:
    wo, wi = upper(20_000, 1), upper(20_000, 2)
    scene = given(VELVET, roughness)
    found = call_glsl("eval_material(vertex, wi)", "vec3", setup=SETUP, wo=wo, wi=wi, **scene)
    o, i = float32(wo), float32(wi)
    color = np.array([0.9, 0.5, 0.6])
    whole, held = sheen_albedos(sheen_alpha(roughness))
    most = np.maximum(*(at(whole, w[:, 2]) for w in (o, i))).clip(1)
    left = np.minimum(*(1 - 0.9 * at(held, w[:, 2]) for w in (o, i)))
    sheen = lobe64(max(roughness**2, LEAST_ALPHA), o, i) / most
    expected = eval64(VELVET, o, i) * left[:, None] + color * sheen[:, None]
    assert_allclose(found, expected, rtol=3e-3, atol=3e-6)


@pytest.mark.parametrize("roughness", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("cosine", [0.05, 0.3, 0.8])
def test_albedos_are_the_integral_of_the_lobe(roughness: float, cosine: float) -> None:
    """Another rule: even steps of the angle around and of the cosine, in the middle of each."""
    alpha = sheen_alpha(roughness)
    z, phi = ((np.arange(3000) + 0.5) / 3000), 2 * math.pi * (np.arange(400) + 0.5) / 400
    r = np.sqrt(1 - z * z)[:, None]
    i = np.stack([r * np.cos(phi), r * np.sin(phi), z[:, None] + 0 * phi], axis=-1).reshape(-1, 3)
    o = np.tile([math.sqrt(1 - cosine**2), 0.0, cosine], (len(i), 1))
    values = lobe64(alpha, o, i)
    whole, held = sheen_albedos(alpha)
    exact = values.mean() * 2 * math.pi
    assert at(whole, np.array([cosine]))[0] == pytest.approx(exact, rel=2e-2, abs=2e-3)
    most = np.maximum(at(whole, i[:, 2]), exact).clip(1)
    kept = (values / most).mean() * 2 * math.pi
    assert at(held, np.array([cosine]))[0] == pytest.approx(kept, abs=6e-3)


def test_narrow_sheen_would_reflect_more_than_all_light_and_is_held_back() -> None:
    for roughness, more in ((0.1, 3.9), (0.3, 1.4), (0.5, 0.9)):
        whole, held = sheen_albedos(sheen_alpha(roughness))
        assert whole.max() > more
        assert held.max() <= 1
        assert np.all(held <= whole.clip(None, 1) + 1e-9)
    assert_allclose(held, whole)  # of wide sheen nothing is


@pytest.mark.slow
@pytest.mark.parametrize("roughness", [0.0, 0.2, 0.4, 0.7, 1.0])
@pytest.mark.parametrize("coat", [0.0, 1.0])
def test_white_cloth_gains_no_light(call_glsl: CallGlsl, roughness: float, coat: float) -> None:
    """The furnace: the mean weight of samples."""
    look = Look(color=WHITE, roughness=0.8, clearcoat=coat)
    u = lattice()
    scene = given(look, roughness, WHITE)
    for cosine in (1.0, 0.7, 0.3, 0.1, 0.03):
        wo = np.repeat(wo_at(cosine), len(u), axis=0)
        weight = call_glsl("next.weight.x", u=u, wo=wo, setup=SAMPLE, **scene)
        albedo = weight.astype(np.float64).mean()
        assert albedo < 1 + 5e-3
        assert albedo > (0.7 if roughness >= 0.4 else 0.4)


@pytest.mark.slow
@pytest.mark.parametrize("look", [VELVET, VELVET._replace(clearcoat=1.0, metallic=0.5)])
def test_light_goes_both_ways_through_sheen(call_glsl: CallGlsl, look: Look) -> None:
    """f(wo, wi) cos wi cos wo is alike when both change places."""
    wo, wi = upper(20_000, 3), upper(20_000, 4)
    setup = SETUP + "Vertex back = vertex_of(up, wi, material_at(0), true);"
    ways = [
        call_glsl(value, "vec3", setup=setup, wo=wo, wi=wi, **given(look, 0.2))
        for value in ("eval_material(vertex, wi) * wo.z", "eval_material(back, wo) * wi.z")
    ]
    assert_allclose(ways[0], ways[1], rtol=2e-3, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("cosine", [0.95, 0.6, 0.15])
def test_samples_of_cloth_follow_their_density(call_glsl: CallGlsl, cosine: float) -> None:
    """Chi-square over the hemisphere, and the weights of samples."""
    scene = given(VELVET)
    assert_density(call_glsl, SETUP, scene, cosine, (8, 16), 96, 0.0)
    u = lattice()
    wo = np.repeat(wo_at(cosine), len(u), axis=0)
    setup = SAMPLE + "vec3 wi = next.direction;"
    weight, value = (
        call_glsl(each, "vec3", setup=setup, wo=wo, u=u, **scene).astype(np.float64)
        for each in ("next.weight * next.pdf", "eval_material(vertex, wi)")
    )
    there = weight.any(axis=1)
    assert_allclose(weight[there], value[there], rtol=4e-3, atol=1e-6)


@pytest.mark.slow
def test_the_logarithm_is_the_natural_one(call_glsl: CallGlsl) -> None:
    x = np.geomspace(1e-30, 1e30, 20_001)
    found = call_glsl("ln(x)", x=x, **given(VELVET))
    assert_allclose(found, np.log(float32(x)), rtol=3e-7, atol=2e-7)


@pytest.mark.slow
def test_smooth_facets_get_what_sheen_leaves(call_glsl: CallGlsl) -> None:
    look = Look(roughness=0.0, metallic=1.0, color=WHITE)
    u = lattice()
    wo = np.repeat(wo_at(0.4), len(u), axis=0)
    inputs = {"u": u, "wo": wo, "setup": SAMPLE, **given(look, 0.6, (0.5, 0.5, 0.5))}
    weight, pdf = (call_glsl(each, **inputs) for each in ("next.weight.x", "next.pdf"))
    is_mirror = pdf == 0
    held = at(sheen_albedos(0.36)[1], np.array([0.4]))[0]
    assert (weight * is_mirror).mean() == pytest.approx(1 - 0.5 * held, rel=3e-3)
    assert (weight * ~is_mirror).mean() == pytest.approx(0.5 * held, rel=2e-2)


def test_surfaces_without_sheen_get_the_kernel_and_the_tables_that_they_had() -> None:
    plain, bare = VELVET.given["scene"], given(VELVET, color=(0, 0, 0))["scene"]
    assert not prepare(bare, Settings()).needs.has_sheen
    assert prepare(given(VELVET)["scene"], Settings()).needs.has_sheen
    for name, rows in pack_facets(SceneFacts(plain)).items():
        assert rows.tobytes() == pack_facets(SceneFacts(bare))[name].tobytes()


def test_surfaces_with_sheen_are_neither_matte_nor_unlit() -> None:
    matte = Principled(specular=0.0, sheen=(0.1, 0, 0))
    assert (matte.is_matte, Principled(specular=0.0).is_matte) == (False, True)
    black = {"color": (0, 0, 0), "specular": 0.0, "emission": (1, 1, 1)}
    unlit = [Principled.model_validate({**black, **x}).is_unlit for x in ({}, {"sheen": (1, 0, 0)})]
    assert unlit == [True, False]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"transmission": 0.5}, "sheen of glass is not known"),
        ({"sheen": [2, 0, 0]}, "sheen"),
        ({"sheen_roughness": -0.1}, "sheen_roughness"),
    ],
)
def test_sheen_that_cannot_be_is_refused(more: dict[str, Any], said: str) -> None:
    material = {"type": "principled", "sheen": [0.5, 0.5, 0.5], **more}
    with pytest.raises(SceneError, match=said):
        scene_of([sphere([0, 0, -3], 1, "p")], {"p": material})
