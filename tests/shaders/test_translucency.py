"""A matte base that lets light through: against its parts, closed forms, and itself."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.packing.material_details import pack_facets
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.shaders.test_principled import SAMPLE, SETUP, Look, upper
from tests.support.builders import glass, lamp, plane, quad, scene_of, sphere
from tests.support.chi_square import assert_density
from tests.support.numerics import Array, lattice, wo_at
from tests.support.renders import METHODS, rendered

LEAF = Look(roughness=0.5, metallic=0.25, color=(0.2, 0.6, 0.1))
WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
SHARE, TINT = 0.4, (0.5, 0.75, 0.25)
BELOW = SETUP + "vec3 below = vec3(wi.xy, -wi.z);"


def given(look: Look, share: float = SHARE, tint: Any = TINT, **more: Any) -> dict[str, Any]:
    """A scene of one ball of a material that lets light through, as an input of call_glsl."""
    material = {"type": "principled", **look._asdict(), "color": list(look.color), **more}
    material |= {"diffuse_transmission": share, "diffuse_transmission_color": list(tint)}
    return {"scene": scene_of([sphere([0, 0, -3], 1, "p")], {"p": material})}


def eval_above(call_glsl: CallGlsl, look: Look, wo: Array, wi: Array) -> Array:
    """The values of a material without transmission, (n, 3)."""
    inputs: dict[str, Any] = {"wo": wo, "wi": wi, "setup": SETUP, **look.given}
    return call_glsl("eval_material(vertex, wi)", "vec3", **inputs).astype(np.float64)


@pytest.mark.slow
@pytest.mark.parametrize("look", [LEAF, LEAF._replace(clearcoat=1.0), LEAF._replace(specular=0.0)])
def test_what_crosses_is_the_base_of_another_colour(call_glsl: CallGlsl, look: Look) -> None:
    """Facets, coat and metal are as without; the base of each side is the base by its albedo."""
    wo, wi = upper(20_000, 1), upper(20_000, 2)
    inputs: dict[str, Any] = {"wo": wo, "wi": wi, "setup": BELOW, **given(look)}
    across = call_glsl("eval_material(vertex, below)", "vec3", **inputs)
    above = call_glsl("eval_material(vertex, wi)", "vec3", **inputs)
    one = look._replace(metallic=0.0)
    base = eval_above(call_glsl, one._replace(color=WHITE), wo, wi)
    base = (1 - look.metallic) * (base - eval_above(call_glsl, one._replace(color=BLACK), wo, wi))
    assert_allclose(across, SHARE * np.array(TINT) * base, rtol=3e-3, atol=3e-6)
    whole = eval_above(call_glsl, look, wo, wi)
    assert_allclose(above, whole - SHARE * np.array(look.color) * base, rtol=3e-3, atol=3e-6)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.25, 1.0])
@pytest.mark.parametrize("more", [{}, {"clearcoat": 1.0}, {"sheen": WHITE}], ids=str)
def test_white_paper_keeps_all_light(
    call_glsl: CallGlsl, share: float, more: dict[str, Any]
) -> None:
    """The furnace: the mean weight of samples, of both sides."""
    look, u = Look(color=WHITE, roughness=0.8), lattice()
    for cosine in (1.0, 0.7, 0.3, 0.1):
        wo = np.repeat(wo_at(cosine), len(u), axis=0)
        inputs: dict[str, Any] = {"u": u, "wo": wo, "setup": SAMPLE}
        weight = call_glsl("next.weight.x", **inputs, **given(look, share, WHITE, **more))
        plain = call_glsl("next.weight.x", **inputs, **given(look, 0.0, WHITE, **more))
        assert weight.astype(np.float64).mean() < 1 + 5e-3
        assert weight.mean() == pytest.approx(plain.mean(), abs=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("look", [LEAF, LEAF._replace(clearcoat=0.7)])
def test_light_goes_both_ways_across(call_glsl: CallGlsl, look: Look) -> None:
    """f(wo, wi) cos wi cos wo is alike when both change places; the other way begins below."""
    wo, wi = upper(20_000, 3), upper(20_000, 4)
    mirrored = "mat3 down = mat3(up[0], -up[1], -up[2]); vec3 there = vec3(wi.x, -wi.y, wi.z);"
    back = "Vertex back = vertex_of(down, there, material_at(0), false);"
    setup = BELOW + mirrored + back + "vec3 home = vec3(wo.x, -wo.y, -wo.z);"
    inputs: dict[str, Any] = {"setup": setup, "wo": wo, "wi": wi, **given(look)}
    ways = [
        call_glsl(value, "vec3", **inputs)
        for value in ("eval_material(vertex, below) * wo.z", "eval_material(back, home) * wi.z")
    ]
    assert ways[0].min() > 0
    assert_allclose(ways[0], ways[1], rtol=2e-3, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("cosine", [0.95, 0.4])
def test_samples_of_leaves_follow_their_density(call_glsl: CallGlsl, cosine: float) -> None:
    """Chi-square over the sphere, and the weights of samples."""
    scene = given(LEAF)
    assert_density(call_glsl, SETUP, scene, cosine, (16, 16), 64, -1.0)
    u = lattice()
    wo = np.repeat(wo_at(cosine), len(u), axis=0)
    setup = SAMPLE + "vec3 wi = next.direction;"
    inputs: dict[str, Any] = {"setup": setup, "wo": wo, "u": u, **scene}
    weight, value = (
        call_glsl(each, "vec3", **inputs).astype(np.float64)
        for each in ("next.weight * next.pdf", "eval_material(vertex, wi)")
    )
    there = weight.any(axis=1)
    assert_allclose(weight[there], value[there], rtol=4e-3, atol=1e-6)
    crosses, z = call_glsl("next.crosses ? 1.0 : 0.0", **inputs), call_glsl("wi.z", **inputs)
    assert np.array_equal(crosses[there] == 1, z[there] < 0)
    assert 0 < crosses.mean() < 0.5


def paper(**keys: Any) -> dict[str, Any]:
    """Translucent paper without facets."""
    return {"type": "principled", "specular": 0.0, "color": [0.8] * 3, **keys}


@pytest.mark.slow
@pytest.mark.parametrize("method", ["nee", "mis"])
def test_the_sun_shines_through_paper(context: Context, method: str) -> None:
    """The camera sees the far side: T c E cos / pi, without noise."""
    sheet = paper(diffuse_transmission=0.5, diffuse_transmission_color=[0.5, 0.25, 1.0])
    sun = {"direction": [0.0, 3.0, 4.0], "irradiance": [2.0, 2.0, 2.0], "angle": 0.001}
    camera = {"position": [0, -1, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}
    things = [plane([0, 0, 0], [0, 1, 0], "p")]
    scene = scene_of(things, {"p": sheet}, camera, sun=sun)
    found = rendered(scene, context, 16, method=method, width=8, height=8).radiance
    expected = 0.5 * np.array([0.5, 0.25, 1.0]) * 2.0 * 0.6 / math.pi
    assert_allclose(found, np.broadcast_to(expected, found.shape), rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_white_balloon_vanishes_in_even_light(context: Context, method: str) -> None:
    """It reflects half of all light and lets the rest through: each path brings 1."""
    white = paper(color=[1.0] * 3, diffuse_transmission=0.5)
    scene = scene_of([sphere([0, 0, -3], 1, "p")], {"p": white}, background={"color": [1.0] * 3})
    image = rendered(scene, context, 16, method=method, bounces=64, width=16, height=16)
    assert_allclose(image.radiance, 1.0, rtol=2e-5)


def shade(**more: Any) -> Scene:
    """A lamp in a lampshade of paper, over a floor; the camera is outside."""
    sheet = paper(diffuse_transmission=0.6, diffuse_transmission_color=[0.9, 0.7, 0.4], **more)
    materials = {"m": paper(), "p": sheet, "lamp": lamp(20.0), "glass": glass()}
    things = [
        plane([0, -1, 0], [0, 1, 0], "m"),
        sphere([0, 0.2, 0], 0.15, "lamp"),
        *(quad([x, -0.6, -0.8], [0, 0, 1.6], [0, 1.6, 0], "p") for x in (-0.8, 0.8)),
        *(quad([-0.8, -0.6, z], [1.6, 0, 0], [0, 1.6, 0], "p") for z in (-0.8, 0.8)),
        sphere([1.4, -0.6, 0.6], 0.3, "glass"),
    ]
    camera = {"position": [1.5, 1.2, 3.5], "look_at": [0, -0.2, 0], "fov": 45}
    return scene_of(things, materials, camera)


@pytest.mark.slow
@pytest.mark.parametrize("more", [{}, {"specular": 1.0, "roughness": 0.5}], ids=["paper", "leaf"])
def test_methods_and_particles_agree_on_light_through_a_lampshade(
    context: Context, more: dict[str, Any]
) -> None:
    """Means over 8 x 8 pixels: 4.5 sigma in 64 cells and three pairs alarm once in 750 runs."""
    ways: dict[str, dict[str, Any]] = {
        "naive": {"method": "naive", "samples": 16384},
        "nee": {"method": "nee", "samples": 4096},
        "mis": {"method": "mis", "samples": 4096},
        "particles": {"method": "mis", "samples": 4096, "caustics": "on", "particles": 1.0},
    }
    found = {}
    for seed, (name, way) in enumerate(ways.items()):
        samples = way.pop("samples")
        image = rendered(shade(**more), context, samples, seed=seed, width=32, height=32, **way)
        cells = image.radiance.astype(np.float64).reshape(8, 4, 8, 4, 3).mean(axis=(1, 3, 4))
        spread = np.square(image.stderr.astype(np.float64)).sum(axis=2)
        error = np.sqrt(spread.reshape(8, 4, 8, 4).sum(axis=(1, 3))) / (16 * math.sqrt(3))
        found[name] = cells, error
    for name in ("naive", "nee", "particles"):
        apart = np.abs(found[name][0] - found["mis"][0])
        assert np.all(apart < 4.5 * np.hypot(found[name][1], found["mis"][1]) + 1e-6), name


def test_surfaces_that_let_nothing_through_get_the_kernel_and_the_tables_that_they_had() -> None:
    plain, opaque = LEAF.given["scene"], given(LEAF, 0.0)["scene"]
    assert not prepare(opaque, Settings()).needs.has_translucency
    assert prepare(given(LEAF)["scene"], Settings()).needs.has_translucency
    for name, rows in pack_facets(SceneFacts(plain)).items():
        assert rows.tobytes() == pack_facets(SceneFacts(opaque))[name].tobytes()


def test_paper_is_neither_matte_nor_unlit() -> None:
    thin = {"specular": 0.0, "diffuse_transmission": 0.5}
    assert [Principled.model_validate(it).is_matte for it in ({"specular": 0.0}, thin)] == [
        True,
        False,
    ]
    black = {"color": (0, 0, 0), "specular": 0.0, "emission": (1, 1, 1)}
    unlit = [Principled.model_validate({**black, **it}).is_unlit for it in ({}, thin)]
    assert unlit == [True, False]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"transmission": 0.5}, "diffuse_transmission of glass is not known"),
        ({"diffuse_transmission": 1.5}, "diffuse_transmission"),
        ({"diffuse_transmission_color": [2, 0, 0]}, "diffuse_transmission_color"),
    ],
)
def test_paper_that_cannot_be_is_refused(more: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        scene_of(
            [sphere([0, 0, -3], 1, "p")], {"p": paper(**{"diffuse_transmission": 0.5, **more})}
        )
