"""Facets that are rougher in one direction: against float64, quadratures, and themselves."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.plan.omissions import omissions
from glrt.plan.plan import prepare
from glrt.scene.materials.gloss import TURNS, facet_shares, shares_around
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.shaders.test_principled import at, upper
from tests.support.builders import box, cylinder, disk, plane, quad, scene_of, sphere
from tests.support.chi_square import assert_density
from tests.support.meshes import mesh
from tests.support.numerics import Array, float32, lattice

SETUP = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    float stretch = material_at(0).ior;
    Vertex vertex = vertex_along(vertex_of(up, wo, material_at(0), true), up[0], stretch);"""
SAMPLE = (
    SETUP
    + """
    Sampler rng = make_sampler(uint(i) * 9781u + 7u);
    Scattering next = sample_material(vertex, rng);
    vec3 wi = next.direction;"""
)
BESIDE = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    vec3 beside = vec3(0.8 * wo.x, 0.6 * wo.x, wo.z);
    Vertex vertex = vertex_along(vertex_of(up, beside, material_at(0), true), up[0],
                                 material_at(0).ior);"""
METAL: dict[str, Any] = {"type": "metal", "color": [0.9, 0.5, 0.1], "roughness": 0.4}
PAINT: dict[str, Any] = {"type": "principled", "color": [0.9, 0.5, 0.1], "roughness": 0.5}
COAT = {"clearcoat": 1.0, "clearcoat_roughness": 0.5}
LOOKS: dict[str, dict[str, Any]] = {
    "metal": METAL | {"anisotropy": 0.7},
    "narrow metal": METAL | {"roughness": 0.1, "anisotropy": 0.5},
    "plastic": PAINT | {"anisotropy": 0.8},
    "iron": PAINT | {"anisotropy": 0.5, "metallic": 1.0},
    "paint": PAINT | {"anisotropy": 0.6, "metallic": 0.5, **COAT},
}
named = pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS)


def given(look: dict[str, Any]) -> dict[str, Any]:
    """A scene of one ball of a material, as an input of call_glsl."""
    return {"scene": scene_of([sphere([0, 0, -3], 1, "m")], {"m": look})}


def alphas(look: dict[str, Any]) -> Array:
    """Alpha along x and y by the text of KHR_materials_anisotropy."""
    alpha = look["roughness"] ** 2
    return np.array([alpha + (1 - alpha) * look["anisotropy"] ** 2, alpha])


def facets64(alpha: Array, o: Array, i: Array) -> Array:
    """GGX of two alphas with correlated heights, of white facets, with the cosine: (n,).

    Heitz 2014, equations 85, 86 and 99.
    """
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    slope = (h[:, 0] / alpha[0]) ** 2 + (h[:, 1] / alpha[1]) ** 2 + h[:, 2] ** 2
    distribution = 1 / (math.pi * alpha[0] * alpha[1] * slope**2)

    def masked(w: Array) -> Array:
        of_slope = ((alpha * w[:, :2]) ** 2).sum(axis=1) / w[:, 2] ** 2
        return np.asarray((np.sqrt(1 + of_slope) - 1) / 2)

    return np.asarray(distribution / (1 + masked(o) + masked(i)) / (4 * o[:, 2]))


def schlick(f0: Any, o: Array, i: Array) -> Array:
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    edge = (1 - np.sum(o * h, axis=1, keepdims=True)) ** 5
    return np.asarray(f0 + (1 - f0) * edge)


@pytest.mark.parametrize("name", ["metal", "narrow metal", "iron"])
def test_facets_scatter_as_the_formulas_say(call_glsl: CallGlsl, name: str) -> None:
    """The text subtracts the light that facets of iron lose to each other."""
    look = LOOKS[name]
    wo, wi = upper(20_000, 1), upper(20_000, 2)
    value = """eval_material(vertex, wi) - (material_at(0).kind == METAL ? vec3(0.0) : again * (
        shares_of(vertex, gloss, wi).lost * shares_of(vertex, gloss, wo).lost * gloss.spread))"""
    setup = (
        SETUP
        + """
    Gloss gloss = gloss_at(max(material_at(0).details, 0));
    vec3 again = principled_of(material_at(0)).again * (wi.z / PI);"""
    )
    found = call_glsl(value, "vec3", setup=setup, wo=wo, wi=wi, **given(look))
    o, i = float32(wo), float32(wi)
    color = np.array(look["color"])
    f = color if look["type"] == "metal" else schlick(color, o, i)
    assert_allclose(found, facets64(alphas(look), o, i)[:, None] * f, rtol=2e-3, atol=3e-6)


@pytest.mark.slow
@named
def test_light_goes_both_ways(call_glsl: CallGlsl, look: dict[str, Any]) -> None:
    """f(wo, wi) cos wi cos wo is alike when both change places."""
    wo, wi = upper(20_000, 3), upper(20_000, 4)
    setup = (
        SETUP
        + """
    Vertex back = vertex_along(vertex_of(up, wi, material_at(0), true), up[0], stretch);"""
    )
    ways = [
        call_glsl(value, "vec3", setup=setup, wo=wo, wi=wi, **given(look))
        for value in ("eval_material(vertex, wi) * wo.z", "eval_material(back, wo) * wi.z")
    ]
    assert_allclose(ways[0], ways[1], rtol=2e-3, atol=1e-6)


@pytest.mark.slow
@named
def test_the_weight_of_a_sample_is_its_value_over_its_density(
    call_glsl: CallGlsl, look: dict[str, Any]
) -> None:
    wo = upper(50_000, 6)
    expressions = (
        "vec4(next.weight, next.pdf)",
        "vec4(eval_material(vertex, wi), pdf_material(vertex, wi))",
    )
    sampled, asked = (
        call_glsl(each, "vec4", setup=SAMPLE, wo=wo, **given(look)).astype(np.float64)
        for each in expressions
    )
    there = sampled[:, 3] > 0
    assert there.mean() > 0.5
    assert_allclose(sampled[there, 3], asked[there, 3], rtol=4e-3)
    assert_allclose(sampled[there, :3] * sampled[there, 3:], asked[there, :3], rtol=8e-3, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["metal", "plastic", "paint"])
@pytest.mark.parametrize("cosine", [0.95, 0.6, 0.15])
def test_samples_follow_their_density(call_glsl: CallGlsl, name: str, cosine: float) -> None:
    """Chi-square, seen from between the directions of most and of least roughness."""
    assert_density(call_glsl, BESIDE, given(LOOKS[name]), cosine, (8, 16), 96, 0.0)


WHITE = [
    PAINT | {"color": [1, 1, 1], "anisotropy": 0.8, **more}
    for more in ({}, {"metallic": 1.0}, {"roughness": 0.2, "metallic": 1.0}, {"roughness": 0.9})
]


@pytest.mark.parametrize("look", WHITE, ids=str)
def test_white_surfaces_neither_lose_nor_gain_light(
    call_glsl: CallGlsl, look: dict[str, Any]
) -> None:
    """The furnace: the mean weight of samples, seen from all sides."""
    setup = SETUP + "Scattering next = sample_principled(vertex, u.x, u.yz);"
    u = lattice()
    for cosine in (1.0, 0.7, 0.3, 0.05):
        for angle in (0.0, 0.5, 1.2, math.pi / 2):
            sine = math.sqrt(1 - cosine**2)
            wo = np.array([[sine * math.cos(angle), sine * math.sin(angle), cosine]])
            wo = np.repeat(wo, len(u), axis=0)
            weight = call_glsl("next.weight.x", u=u, wo=wo, setup=setup, **given(look))
            assert weight.astype(np.float64).mean() == pytest.approx(1, abs=0.012)


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.0, 1.4, math.pi / 2])
@pytest.mark.parametrize("cosine", [1.0, 0.5, 0.1])
def test_tables_are_the_integral_of_facets(cosine: float, angle: float) -> None:
    """The integral is by Gauss and Legendre's rule over directions of light, without samples."""
    alpha = np.array([0.6, 0.2])
    nodes, weights = np.polynomial.legendre.leggauss(400)
    z, phi = (nodes + 1) / 2, 2 * np.pi * (np.arange(720) + 0.5) / 720
    r = np.sqrt(1 - z * z)[:, None]
    i = np.stack([r * np.cos(phi), r * np.sin(phi), z[:, None] + 0 * phi], axis=-1).reshape(-1, 3)
    sine = math.sqrt(1 - cosine**2)
    o = np.tile([sine * math.cos(angle), sine * math.sin(angle), cosine], (len(i), 1))
    even = np.repeat(weights / 2, len(phi)) * 2 * np.pi / len(phi)
    value = facets64(alpha, o, i)
    stretch = float(alpha[0] / alpha[1])
    place = TURNS * math.sin(angle) / (math.sin(angle) + math.sqrt(stretch) * math.cos(angle))
    whole = shares_around(float(alpha[1]), stretch)
    edge = schlick(0.0, o, i)[:, 0]
    for name, part in (("head_on", 1 - edge), ("grazing", edge)):
        tables = [at(getattr(it, name), np.array([cosine]))[0] for it in whole]
        found = np.interp(place, np.arange(TURNS + 1), tables)
        assert found == pytest.approx(float((value * part) @ even), abs=3e-3)


def test_without_a_stretch_all_tables_are_those_of_even_facets() -> None:
    even = facet_shares(0.16)
    for shares in shares_around(0.16, 1.0):
        assert_allclose(shares.head_on, even.head_on, atol=1.5e-3)
        assert_allclose(shares.grazing, even.grazing, atol=1.5e-3)


def test_alpha_in_one_direction_is_that_of_gltf() -> None:
    metal = Metal(color=(1, 1, 1), roughness=0.5, anisotropy=0.5)
    assert metal.alpha == 0.25
    assert metal.alpha * metal.stretch == pytest.approx(0.25 + 0.75 * 0.25)
    assert Metal(color=(1, 1, 1), roughness=0.0, anisotropy=1.0).alpha == 1e-3
    plain = Principled(roughness=0.0, anisotropy_rotation=30.0)
    assert (plain.facet_alpha, plain.stretch) == (0.0, 1.0)


CHECKER = {"checker": [0.25, 0.75]}


@pytest.mark.parametrize(
    ("look", "said"),
    [
        (PAINT | {"anisotropy": 0.5, "transmission": 0.5}, "anisotropy of glass is not known"),
        (PAINT | {"anisotropy": 0.5, "roughness": CHECKER}, "give a number"),
        (METAL | {"anisotropy": 1.5}, "anisotropy"),
        (METAL | {"anisotropy_rotation": 1e9}, "anisotropy_rotation"),
        ({"type": "lambertian", "color": [1, 1, 1], "anisotropy": 0.5}, "anisotropy"),
    ],
)
def test_anisotropy_that_cannot_be_is_refused(look: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        given(look)


def test_models_before_path_tracing_say_that_highlights_of_metal_are_round() -> None:
    told = "highlights of metal are alike in all directions"
    for look, is_told in ((LOOKS["metal"], True), (METAL, False), (LOOKS["iron"], False)):
        plan = prepare(given(look)["scene"], Settings())
        assert (told in omissions(plan.facts, Settings(method="blinn"))) == is_told
        assert plan.needs.has_anisotropy == ("anisotropy" in look)


TRIANGLE = np.eye(3), np.array([[0, 1, 2]])
UV = np.array([[0, 0], [1, 0], [0, -1]], float)
SHAPES: dict[str, tuple[dict[str, Any], list[float], list[float], list[float]]] = {
    # a shape, a point in front of it, and the directions in which u grows and v falls there
    "plane": (plane([0, 0, 0], [0, 0, 1], "m"), [0.3, 0.2, 5], [1, 0, 0], [0, 1, 0]),
    "quad": (quad([0, 0, 0], [0, 2, 0], [-2, 0, 0], "m"), [-0.5, 0.5, 5], [0, 1, 0], [1, 0, 0]),
    "disk": (disk([0, 0, 0], [0, 0, 1], 1, "m"), [0.3, 0.2, 5], [1, 0, 0], [0, 1, 0]),
    "sphere": (sphere([0, 0, 0], 1, "m"), [0, 0, 5], [-1, 0, 0], [0, 1, 0]),
    "cylinder": (cylinder([0, -1, 0], [0, 1, 0], 1, "m"), [0, 0.5, 5], [1, 0, 0], [0, 1, 0]),
    "lying": (cylinder([-1, 0, 0], [1, 0, 0], 1, "m"), [0.5, 0, 5], [0, -1, 0], [1, 0, 0]),
    "box": (box([-1, -1, -1], [1, 1, 1], "m"), [0.5, 0.2, 5], [1, 0, 0], [0, 1, 0]),
    "side of a box": (
        box([-1, -1, -1], [1, 1, 1], "m", rotate=(0, 90, 0)), [0.5, 0.2, 5], [1, 0, 0], [0, 1, 0],
    ),
    "bare mesh": (mesh(TRIANGLE, "m", smooth=False), [0.3, 0.3, 5], [-1, 0, 1], [-1, 2, -1]),
    "mesh": (mesh(TRIANGLE, "m", smooth=False, uv=UV), [0.3, 0.3, 5], [-1, 1, 0], [-1, -1, 2]),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("turn", [0.0, 30.0, 90.0])
def test_the_direction_follows_texture_coordinates(
    call_glsl: CallGlsl, name: str, turn: float
) -> None:
    """It turns from where u grows towards where v falls."""
    thing, point, along, rising = SHAPES[name]
    scene = scene_of([thing], {"m": LOOKS["metal"] | {"anisotropy_rotation": turn}})
    origin = np.subtract(point, scene.camera.position)[None]
    setup = """
    Ray ray = Ray(origin, vec3(0.0, 0.0, -1.0), NO_SHAPE, false);
    Surface surface = surface_at(ray, find_hit(ray, FAR, NO_SHAPE, false));
    mat3 frame = frame_around(surface.normal);
    Material material = material_at(surface.material);
    Vertex bare = vertex_of(frame, to_local(frame, surface.normal), material, true);
    Vertex vertex = with_grain(bare, ray, surface);"""
    found, normal, stretch = (
        call_glsl(each, returns, setup=setup, origin=origin, scene=scene).astype(np.float64)[0]
        for each, returns in (
            ("vertex.frame[0]", "vec3"),
            ("surface.normal", "vec3"),
            ("vertex.stretch", "float"),
        )
    )
    angle = math.radians(turn)
    x, y = (np.array(each, float) / np.linalg.norm(each) for each in (along, rising))
    expected = math.cos(angle) * x + math.sin(angle) * y
    assert abs(found @ normal) < 1e-5
    assert abs(found @ expected) == pytest.approx(1, abs=1e-4)
    assert stretch == pytest.approx(Metal.model_validate(LOOKS["metal"]).stretch)
