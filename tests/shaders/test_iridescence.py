"""Thin films on facets: against Airy's sum over all wavelengths, float64, and themselves."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.packing.material_details import pack_facets
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.scene.materials.thin_film import MOST_EDGE, ThinFilm, reflectance_bound
from glrt.settings import Settings
from tests.conftest import CallGlsl
from tests.shaders.test_material import ggx_d64, ggx_lambda
from tests.shaders.test_principled import SAMPLE, SETUP, Look, eval64, upper
from tests.support.builders import scene_of, sphere
from tests.support.chi_square import assert_density
from tests.support.numerics import Array, float32, lattice, wo_at

FILM = {"iridescence": 1.0, "iridescence_ior": 1.4, "iridescence_thickness": 350.0}
METAL, PLASTIC = Look(metallic=1.0, roughness=0.5), Look(roughness=0.5)


def given(look: Look, **film: Any) -> dict[str, Any]:
    """A scene of one ball of a material under a film, as an input of call_glsl."""
    own = {**look.given["scene"].materials["p"].model_dump(exclude_defaults=True), **FILM, **film}
    material = {"type": "principled", **own, "color": list(look.color)}
    return {"scene": scene_of([sphere([0, 0, -3], 1, "p")], {"p": material})}


# Gaussians of CIE X, Y and Z by wave number, in 1/m: (weight, centre, half of the variance) as
# KHR_materials_iridescence and the authors' code print them. A transform has a factor for each.
GAUSSIANS: list[list[tuple[float, float, float]]] = [
    [(5.4856e-13, 1.6810e6, 4.3278e9), (9.7470e-14, 2.2399e6, 4.5282e9)],
    [(4.4201e-13, 1.7953e6, 9.3046e9)],
    [(5.2481e-13, 2.2084e6, 6.6121e9)],
]
SRGB = np.linalg.inv(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)
SPREAD = np.linspace(-7, 7, 2801)  # standard deviations


def airy(outer: float, inner: float, denser: bool, path: float) -> tuple[Array, float]:
    """The reflectance of a film by Airy's sum of all reflections, (3,), and the error of two.

    The sum is averaged over the wave numbers that the eye sees, without Fourier transforms. Only
    its part that depends on the wave number is: the rest is white. `denser`: what is below the
    film is denser than the film. `path`: in metres.
    """
    r12, r23 = -math.sqrt(outer), (-1 if denser else 1) * math.sqrt(inner)
    even = outer + (1 - outer) ** 2 * inner / (1 - outer * inner)
    weights = np.exp(-(SPREAD**2) / 2) / np.exp(-(SPREAD**2) / 2).sum()
    xyz = np.zeros(3)
    for channel, parts in enumerate(GAUSSIANS):
        for weight, centre, half in parts:
            turn = np.exp(2j * math.pi * path * (centre + math.sqrt(2 * half) * SPREAD))
            square = np.abs((r12 + r23 * turn) / (1 + r12 * r23 * turn)) ** 2
            height = weight * math.sqrt(2 * math.pi * half) / 1.0685e-7
            xyz[channel] += height * float(weights @ (square - even))
    r = math.sqrt(outer * inner)
    rest = 2 * (1 - outer) * r**3 / (1 - r) * 1.3
    return np.asarray(even + SRGB @ xyz).clip(0, 1), rest


def schlick(f0: float, cosine: float) -> float:
    return f0 + (1 - f0) * (1 - cosine) ** 5


def expected_film(f0: float, ior: float, nanometres: float, cosine: float) -> tuple[Array, float]:
    inside = math.sqrt(1 - (1 - cosine**2) / ior**2)
    root = math.sqrt(f0)
    below = (1 + root) / (1 - root)
    outer = schlick(((ior - 1) / (ior + 1)) ** 2, cosine)
    inner = schlick(((below - ior) / (below + ior)) ** 2, inside)
    return airy(outer, inner, below > ior, 2e-9 * ior * nanometres * inside)


def films(count: int) -> tuple[Array, Array, Array, Array]:
    """Reflectances head-on, indices, thicknesses in nanometres, and cosines."""
    random = np.random.default_rng(3)
    return (
        random.choice([0.02, 0.04, 0.08], count),
        random.uniform(1.05, 1.9, count),
        random.uniform(30, 900, count),
        random.uniform(0.05, 1, count),
    )


def test_the_reflectance_of_a_film_is_airys_sum_over_the_wavelengths(call_glsl: CallGlsl) -> None:
    """Up to the fourth reflection inside the film, which glrt leaves out: 3e-4 at most here."""
    f0, ior, nanometres, cosine = films(300)
    found = call_glsl(
        "film_reflectance(ThinFilm(1.0, ior, thickness, 1.0), vec3(f0), cosine)",
        "vec3",
        f0=f0,
        ior=ior,
        thickness=nanometres / 1000,
        cosine=cosine,
        **given(METAL),
    )
    rests = []
    for k, sample in enumerate(zip(f0, ior, nanometres, cosine, strict=True)):
        exact, rest = expected_film(*map(float, sample))
        rests.append(rest)
        assert_allclose(found[k], exact, rtol=0, atol=2e-4 + rest, err_msg=str(sample))
        host = ThinFilm(ior[k], nanometres[k]).reflectance((f0[k],) * 3, cosine[k : k + 1])
        assert_allclose(found[k], host[0], rtol=0, atol=2e-5)
    assert np.median(rests) < 2e-4
    assert found.min() < 0.02
    assert np.ptp(found, axis=1).max() > 0.1


def test_a_film_of_no_thickness_is_not_there() -> None:
    assert [ThinFilm(1.8, x).presence for x in (0.0, 0.015, 0.03, 400.0)] == [0, 0.5, 1, 1]
    bare, none = (
        pack_facets(SceneFacts(each["scene"]))["Gloss"][0]
        for each in (PLASTIC.given, given(PLASTIC, iridescence_thickness=0.0))
    )
    for name in set(bare.dtype.names) - {"glass"}:
        assert_allclose(none[name], bare[name], rtol=1e-6)


@pytest.mark.parametrize("seed", range(40))
def test_the_bound_of_a_film_lies_above_its_reflectance_and_near(seed: int) -> None:
    random = np.random.default_rng(seed)
    film = ThinFilm(random.uniform(1.1, 2.5), random.uniform(0, 1000))
    f0 = float(random.uniform(0.02, 0.1))
    a, b = reflectance_bound(film, (f0, 0.5 * f0, f0))
    cosine = random.uniform(0.001, 1, 5000)
    weight = (1 - cosine) ** 5
    most = film.reflectance((f0, 0.5 * f0, f0), cosine).max(axis=1)
    above = a * (1 - weight) + b * weight - most
    assert 1 <= b <= MOST_EDGE
    assert above.min() > -1e-4
    assert above @ cosine / cosine.sum() < 0.1  # of even light


@pytest.mark.parametrize(
    ("look", "film"),
    [
        (METAL, {}),
        (METAL, {"iridescence": 0.5, "iridescence_ior": 2.0}),
        (METAL, {"iridescence_thickness": 0.0}),
        (PLASTIC._replace(color=(0.0, 0.0, 0.0)), {}),
        (PLASTIC._replace(color=(0.0, 0.0, 0.0), specular=0.5), {"iridescence": 0.7}),
    ],
)
def test_a_film_changes_the_reflectance_of_facets(
    call_glsl: CallGlsl, look: Look, film: dict[str, Any]
) -> None:
    """Metal and black plastic, which have nothing below their facets."""
    wo, wi = upper(20_000, 1), upper(20_000, 2)
    scene = given(look, **film)
    found = call_glsl("eval_material(vertex, wi)", "vec3", setup=SETUP, wo=wo, wi=wi, **scene)
    o, i = float32(wo), float32(wi)
    h = (o + i) / np.linalg.norm(o + i, axis=1, keepdims=True)
    along = np.sum(o * h, axis=1)
    alpha = np.array(look.roughness**2)
    facets = ggx_d64(alpha, h) / (1 + ggx_lambda(alpha, o) + ggx_lambda(alpha, i)) / (4 * o[:, 2])
    f0 = look.color if look.metallic else (0.04,) * 3
    scale = 1.0 if look.metallic else look.specular
    share, ior, thickness = ({**FILM, **film}[key] for key in FILM)
    wavy = ThinFilm(ior, thickness).reflectance(f0, along)
    plain = np.array(f0) + (1 - np.array(f0)) * ((1 - along) ** 5)[:, None]
    share *= thickness > 0
    more = share * scale * (wavy - plain) * facets[:, None]
    assert_allclose(found, eval64(look, o, i) + more, rtol=2e-3, atol=5e-6)
    assert thickness == 0 or np.abs(more).max() > 0.01


WHITE: list[tuple[Look, dict[str, Any], float]] = [
    (METAL._replace(color=(1.0, 1.0, 1.0)), {}, 0.985),
    (PLASTIC._replace(color=(1.0, 1.0, 1.0)), {}, 0.92),
    (PLASTIC._replace(color=(1.0, 1.0, 1.0), roughness=0.1), {"iridescence_ior": 2.0}, 0.7),
    (PLASTIC._replace(color=(1.0, 1.0, 1.0), roughness=0.9), {"iridescence_ior": 1.1}, 0.9),
    (PLASTIC._replace(color=(1.0, 1.0, 1.0), metallic=0.5), {"iridescence_thickness": 900}, 0.9),
    (PLASTIC._replace(color=(1.0, 1.0, 1.0), roughness=0.0), {"iridescence_ior": 1.8}, 0.85),
]


@pytest.mark.parametrize(("look", "film", "least"), WHITE, ids=str)
def test_no_channel_of_a_white_surface_gains_light_by_its_film(
    call_glsl: CallGlsl, look: Look, film: dict[str, Any], least: float
) -> None:
    """The furnace: the mean weight of samples.

    The base gets what is left in the channel that the film reflects most, so others lose light.
    """
    u = lattice()
    scene = given(look, **film)
    for cosine in (1.0, 0.7, 0.3, 0.1, 0.02):
        wo = np.repeat(wo_at(cosine), len(u), axis=0)
        weight = call_glsl("next.weight", "vec3", u=u, wo=wo, setup=SAMPLE, **scene)
        albedo = weight.astype(np.float64).mean(axis=0)
        assert albedo.max() < 1 + 2e-3
        assert albedo.min() > least


@pytest.mark.parametrize("cosine", [1.0, 0.6, 0.2])
def test_a_mirror_under_a_film_has_the_reflectance_of_the_film(
    call_glsl: CallGlsl, cosine: float
) -> None:
    look = METAL._replace(roughness=0.0)
    u = lattice()
    wo = np.repeat(wo_at(cosine), len(u), axis=0)
    found = call_glsl("next.weight", "vec3", u=u, wo=wo, setup=SAMPLE, **given(look))
    wavy = ThinFilm(1.4, 350.0).reflectance(look.color, np.array([cosine]))
    assert_allclose(found, np.broadcast_to(wavy, found.shape), atol=2e-5)


@pytest.mark.slow
@pytest.mark.parametrize("look", [METAL, PLASTIC, PLASTIC._replace(clearcoat=1.0)])
def test_light_goes_both_ways_through_a_film(call_glsl: CallGlsl, look: Look) -> None:
    """f(wo, wi) cos wi cos wo is alike when both change places."""
    wo, wi = upper(20_000, 3), upper(20_000, 4)
    setup = SETUP + "Vertex back = vertex_of(up, wi, material_at(0), true);"
    ways = [
        call_glsl(value, "vec3", setup=setup, wo=wo, wi=wi, **given(look))
        for value in ("eval_material(vertex, wi) * wo.z", "eval_material(back, wo) * wi.z")
    ]
    assert_allclose(ways[0], ways[1], rtol=2e-3, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("look", [METAL, PLASTIC])
@pytest.mark.parametrize("cosine", [0.95, 0.6, 0.15])
def test_samples_of_a_film_follow_their_density(
    call_glsl: CallGlsl, look: Look, cosine: float
) -> None:
    """Chi-square over the hemisphere, and the weights of samples."""
    assert_density(call_glsl, SETUP, given(look), cosine, (8, 16), 96, 0.0)
    u = lattice()
    wo = np.repeat(wo_at(cosine), len(u), axis=0)
    setup = SAMPLE + "vec3 wi = next.direction;"
    weight, value = (
        call_glsl(each, "vec3", setup=setup, wo=wo, u=u, **given(look)).astype(np.float64)
        for each in ("next.weight * next.pdf", "eval_material(vertex, wi)")
    )
    there = weight.any(axis=1)
    assert_allclose(weight[there], value[there], rtol=4e-3, atol=1e-6)


def test_surfaces_without_a_film_get_the_kernel_and_the_tables_that_they_had() -> None:
    plain, bare = PLASTIC.given["scene"], given(PLASTIC, iridescence=0.0)["scene"]
    assert not prepare(bare, Settings()).needs.has_iridescence
    assert prepare(given(PLASTIC)["scene"], Settings()).needs.has_iridescence
    for name, rows in pack_facets(SceneFacts(plain)).items():
        assert rows.tobytes() == pack_facets(SceneFacts(bare))[name].tobytes()


def test_a_film_on_brushed_facets_leaves_what_its_bound_does_not_take() -> None:
    """The light that reaches the base, by the tables of all directions."""
    even, brushed = (
        pack_facets(SceneFacts(given(PLASTIC, **more)["scene"]))["Gloss"]["even_base"][0]
        for more in ({}, {"anisotropy": 0.05})
    )
    assert brushed == pytest.approx(even, rel=2e-3)
    assert even > 1.05


@pytest.mark.parametrize(
    ("film", "said"),
    [
        ({"transmission": 0.5}, "iridescence of glass is not known"),
        ({"iridescence": 1.5}, "iridescence"),
        ({"iridescence_ior": 0.9}, "iridescence_ior"),
        ({"iridescence_thickness": -1.0}, "iridescence_thickness"),
    ],
)
def test_films_that_cannot_be_are_refused(film: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        given(PLASTIC, **film)
