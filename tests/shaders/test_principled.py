"""Principled surfaces: against float64, quadratures, and themselves."""

from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.scene.materials.gloss import facet_shares
from tests.conftest import CallGlsl
from tests.shaders.test_material import ggx_d64, ggx_lambda
from tests.support.builders import scene_of, sphere
from tests.support.chi_square import assert_density
from tests.support.numerics import Array, float32, lattice, wo_at

SETUP = """
    mat3 up = frame_around(vec3(0.0, 0.0, 1.0));
    Vertex vertex = vertex_of(up, wo, material_at(0), true);"""
SAMPLE = SETUP + "Scattering next = sample_principled(vertex, u.x, u.yz);"


class Look(NamedTuple):
    """A principled material."""

    metallic: float = 0.0
    roughness: float = 0.4
    clearcoat: float = 0.0
    clearcoat_roughness: float = 0.1
    ior: float = 1.5
    specular: float = 1.0
    color: tuple[float, float, float] = (0.9, 0.5, 0.1)

    @property
    def given(self) -> dict[str, Any]:
        """A scene of one ball of it, as an input of call_glsl."""
        material = {"type": "principled", **self._asdict(), "color": list(self.color)}
        return {"scene": scene_of([sphere([0, 0, -3], 1, "p")], {"p": material})}


PLASTIC, IRON = Look(roughness=0.5), Look(metallic=1.0, roughness=0.6)
PAINT = Look(metallic=0.6, roughness=0.5, clearcoat=1.0, clearcoat_roughness=0.4)
DULL = Look(roughness=1.0, clearcoat=0.5, clearcoat_roughness=0.7)
DIM = Look(metallic=0.3, roughness=0.8, ior=2.4, specular=0.3)
LOOKS = {"plastic": PLASTIC, "iron": IRON, "paint": PAINT, "dull": DULL, "dim": DIM}
SMOOTH = {
    "a smooth coat": PAINT._replace(clearcoat_roughness=0.0),
    "smooth facets": PLASTIC._replace(roughness=0.0),
    "a mirror": IRON._replace(roughness=0.0),
    "both smooth": Look(metallic=0.5, roughness=0.0, clearcoat=1.0, clearcoat_roughness=0.0),
    "narrow": PLASTIC._replace(roughness=1e-3),
}
WHITE = {name: look._replace(color=(1.0, 1.0, 1.0)) for name, look in {**LOOKS, **SMOOTH}.items()}
named = pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS)


def upper(count: int, seed: int) -> Array:
    """Directions, (count, 3), none that grazes."""
    random = np.random.default_rng(seed)
    z, phi = random.uniform(0.02, 1, count), random.uniform(0, 2 * np.pi, count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


def at(table: Array, cosine: Array) -> Array:
    """A table of the root of the cosine."""
    return np.interp(np.sqrt(cosine), np.linspace(0, 1, len(table)), table)


def eval64(look: Look, o: Array, i: Array) -> Array:
    """The formulas of docs/explanation/principled.md, with the cosine."""
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    edge = (1 - np.sum(o * h, axis=1)) ** 5

    def facets(roughness: float, f0: Array, f90: float) -> Array:
        alpha = np.array(roughness**2)
        masked = ggx_d64(alpha, h) / (1 + ggx_lambda(alpha, o) + ggx_lambda(alpha, i))
        found: Array = (masked / (4 * o[:, 2]))[:, None] * (f0 + (f90 - f0) * edge[:, None])
        return found

    head_on = ((look.ior - 1) / (look.ior + 1)) ** 2 * look.specular
    color = np.array(look.color)
    f0 = (1 - look.metallic) * head_on + look.metallic * color
    f90 = (1 - look.metallic) * look.specular + look.metallic
    shares = facet_shares(look.roughness**2)
    kept = shares.kept

    def again(f0: Any, f90: float) -> Any:
        mean = f0 + (f90 - f0) / 21
        return mean**2 * kept / (1 - mean * (1 - kept))

    def left(head: Any, grazing: Any) -> Any:
        more = again(head_on, look.specular) * (1 - head - grazing)
        return 1 - head_on * head - look.specular * grazing - more

    value = facets(look.roughness, f0, f90)
    heads, edges = ([at(t, w[:, 2]) for w in (o, i)] for t in (shares.head_on, shares.grazing))
    lost = (1 - heads[0] - edges[0]) * (1 - heads[1] - edges[1])
    even = i[:, 2:] / np.pi
    if kept < 1:
        both = (1 - look.metallic) * again(head_on, look.specular), look.metallic * again(color, 1)
        value = value + lost[:, None] / (1 - kept) * (both[0] + both[1]) * even
    base = left(heads[0], edges[0]) * left(heads[1], edges[1])
    base = base / left(shares.mean_head_on, shares.mean_grazing)
    value = value + (1 - look.metallic) * color * base[:, None] * even
    if not look.clearcoat:
        return np.asarray(value)
    coat = facet_shares(look.clearcoat_roughness**2)
    below = [1 - look.clearcoat * (0.04 * at(coat.head_on, w[:, 2]) + at(coat.grazing, w[:, 2]))
             for w in (o, i)]  # fmt: skip
    value = value * np.minimum(*below)[:, None]
    return np.asarray(
        value + look.clearcoat * facets(look.clearcoat_roughness, np.full(3, 0.04), 1.0)
    )


@named
def test_it_scatters_as_the_formulas_say(call_glsl: CallGlsl, look: Look) -> None:
    wo, wi = upper(20_000, 1), upper(20_000, 2)
    found = call_glsl("eval_material(vertex, wi)", "vec3", setup=SETUP, wo=wo, wi=wi, **look.given)
    assert_allclose(found, eval64(look, float32(wo), float32(wi)), rtol=2e-3, atol=3e-6)


@named
def test_light_goes_both_ways(call_glsl: CallGlsl, look: Look) -> None:
    """f(wo, wi) cos wi cos wo is alike when both change places."""
    wo, wi = upper(20_000, 3), upper(20_000, 4)
    setup = SETUP + "Vertex back = vertex_of(up, wi, material_at(0), true);"
    ways = [
        call_glsl(value, "vec3", setup=setup, wo=wo, wi=wi, **look.given)
        for value in ("eval_material(vertex, wi) * wo.z", "eval_material(back, wo) * wi.z")
    ]
    assert_allclose(ways[0], ways[1], rtol=2e-3, atol=1e-7)


@pytest.mark.parametrize("look", WHITE.values(), ids=WHITE)
def test_white_surfaces_lose_little_and_gain_nothing(call_glsl: CallGlsl, look: Look) -> None:
    """The furnace: the mean weight of samples. A coat costs up to 8 %: its form is symmetric."""
    u = lattice()
    for cosine in (1.0, 0.8, 0.5, 0.3, 0.1, 0.02):
        wo = np.repeat(wo_at(cosine), len(u), axis=0)
        weight = call_glsl("next.weight.x", u=u, wo=wo, setup=SAMPLE, **look.given)
        albedo = weight.astype(np.float64).mean()
        assert albedo < 1 + 2e-3
        assert albedo > (0.92 if look.clearcoat else 0.985)


@pytest.mark.parametrize("cosine", [1.0, 0.6, 0.2])
@pytest.mark.parametrize("coat", [0.0, 0.7])
def test_smooth_facets_over_matte_are_a_closed_form(
    call_glsl: CallGlsl, coat: float, cosine: float
) -> None:
    """A sample that meets a delta has density 0, and together they have Schlick's reflectances."""
    look = Look(roughness=0.0, clearcoat=coat, clearcoat_roughness=0.0, color=(0.0, 0.0, 0.0))
    u = lattice()
    wo = np.repeat(wo_at(cosine), len(u), axis=0)
    found = call_glsl("vec4(next.direction, next.weight.x)", "vec4", u=u, wo=wo, setup=SAMPLE,
                      **look.given).astype(np.float64)  # fmt: skip
    assert not call_glsl("next.pdf", u=u, wo=wo, setup=SAMPLE, **look.given).any()
    is_met = found[:, 3] > 0
    assert_allclose(found[is_met, :3], wo[is_met] * [-1, -1, 1], atol=1e-6)
    share = 0.04 + 0.96 * (1 - cosine) ** 5
    above = coat * share
    assert found[:, 3].mean() == pytest.approx(above + (1 - above) * share, rel=2e-3)


@pytest.mark.parametrize("look", [*LOOKS.values(), SMOOTH["a smooth coat"]])
def test_the_weight_of_a_sample_is_its_value_over_its_density(
    call_glsl: CallGlsl, look: Look
) -> None:
    random = np.random.default_rng(5)
    wo = upper(50_000, 6)
    u = random.uniform(size=(len(wo), 3))
    setup = SAMPLE + "vec3 wi = next.direction;"
    expressions = (
        "vec4(next.weight, next.pdf)",
        "vec4(eval_material(vertex, wi), pdf_material(vertex, wi))",
    )
    sampled, asked = (
        call_glsl(each, "vec4", setup=setup, wo=wo, u=u, **look.given).astype(np.float64)
        for each in expressions
    )
    there = sampled[:, 3] > 0
    assert there.mean() > 0.5
    assert_allclose(sampled[there, 3], asked[there, 3], rtol=2e-3)
    assert_allclose(sampled[there, :3] * sampled[there, 3:], asked[there, :3], rtol=4e-3, atol=1e-7)


@named
@pytest.mark.parametrize("cosine", [0.95, 0.6, 0.15])
def test_samples_follow_their_density(call_glsl: CallGlsl, look: Look, cosine: float) -> None:
    """Chi-square over the hemisphere, and how many samples are absorbed."""
    assert_density(call_glsl, SETUP, look.given, cosine, (8, 16), 96, 0.0)


@pytest.mark.parametrize("alpha", [0.1, 0.25, 1.0])
@pytest.mark.parametrize("cosine", [1.0, 0.5, 0.1])
def test_tables_are_the_integral_of_facets(alpha: float, cosine: float) -> None:
    """The integral is by Gauss and Legendre's rule over directions of light, without samples."""
    nodes, weights = np.polynomial.legendre.leggauss(600)
    z, phi = (nodes + 1) / 2, 2 * np.pi * (np.arange(720) + 0.5) / 720
    r = np.sqrt(1 - z * z)[:, None]
    parts = r * np.cos(phi), r * np.sin(phi), z[:, None] + 0 * phi
    i = np.stack(parts, axis=-1).reshape(-1, 3)
    o = np.repeat(wo_at(cosine).astype(np.float64), len(i), axis=0)
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    edge = (1 - np.sum(o * h, axis=1)) ** 5
    rough = np.array(alpha)
    value = ggx_d64(rough, h) / (1 + ggx_lambda(rough, o) + ggx_lambda(rough, i)) / (4 * cosine)
    even = np.repeat(weights / 2, len(phi)) * 2 * np.pi / len(phi)
    shares = facet_shares(alpha)
    for table, part in ((shares.head_on, 1 - edge), (shares.grazing, edge)):
        found = at(table, np.array([cosine]))[0]
        assert found == pytest.approx(float((value * part) @ even), abs=1e-3)


@pytest.mark.slow
def test_the_share_of_the_base_is_what_color_adds(call_glsl: CallGlsl) -> None:
    """The facets of a dielectric do not depend on the colour: black leaves them alone."""
    wo, wi = upper(200, 1), upper(200, 2)
    for look in (PLASTIC, DULL):
        black = look._replace(color=(0.0, 0.0, 0.0))
        whole, facets = (
            call_glsl(
                "eval_principled(vertex, wi)", "vec3", setup=SETUP, wo=wo, wi=wi, **each.given
            )
            for each in (look, black)
        )
        found = call_glsl("base_share(vertex, wi)", "vec3", setup=SETUP, wo=wo, wi=wi, **look.given)
        assert_allclose(found, (whole - facets) / whole, atol=1e-5)
        assert found.min() < 0.6
        assert found.max() > 0.9
