"""Glass: Fresnel's equations, Snell's law, and the share of each."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from tests.conftest import CallGlsl
from tests.support.numerics import BELOW_ONE, ULP, Array, directions, float32, wo_at

IORS = (0.5, 0.667, 1 + 1e-6, 1.33, 1.5, 2.4, 4.0)
GLASS = "Material(vec3(1.0), DIELECTRIC, vec3(0.0), 0.0, 1.5, 0, 0, -1, 0.0, 0.0, 1.0, 1.0)"


def fresnel64(cos_i: Array, eta: Array | float) -> Array:
    """Fresnel's equations as in any textbook, float64."""
    sin2_t = np.asarray(eta, np.float64) ** 2 * (1 - cos_i**2)
    cos_t = np.sqrt(np.maximum(1 - sin2_t, 0))
    rs = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    rp = (eta * cos_t - cos_i) / (eta * cos_t + cos_i)
    reflectance: Array = np.where(sin2_t >= 1, 1.0, (rs**2 + rp**2) / 2)
    return reflectance


# --- Fresnel (G21) -------------------------------------------------------------------------


@pytest.mark.parametrize("ior", IORS)
def test_reflectance_at_normal_incidence_and_at_brewsters_angle(
    call_glsl: CallGlsl, context: Context, ior: float
) -> None:
    brewster = 1 / np.sqrt(1 + ior * ior)  # its cosine
    polarised = ((ior * ior - 1) / (ior * ior + 1)) ** 2
    at = call_glsl("fresnel(c, eta)", c=np.array([1.0, brewster, 0.0]), eta=np.array([1 / ior]))
    assert at[0] == pytest.approx(((ior - 1) / (ior + 1)) ** 2, rel=1e-5, abs=1e-13)
    assert at[1] == pytest.approx(polarised / 2, rel=1e-5, abs=1e-13)
    off = 0 if context.is_software else ULP  # of a quotient of equal numbers
    assert abs(at[2] - 1) <= off


def test_reflectance_has_the_published_values(call_glsl: CallGlsl) -> None:
    ior = np.array([1.5, 1.33, 2.4, 1.5, 1.5])
    degrees = np.array([0, 0, 0, 56.3099, 45])
    found = call_glsl("fresnel(c, 1.0 / ior)", c=np.cos(np.radians(degrees)), ior=ior)
    assert found == pytest.approx([0.04, 0.020059, 0.169550, 0.073964, 0.050240], abs=1e-6)


def test_beyond_the_critical_angle_everything_is_reflected(call_glsl: CallGlsl) -> None:
    critical = np.sqrt(1 - 1 / 1.5**2)  # cosine of 41.8103 degrees
    cosines = critical + np.array([-0.7, -0.1, -1e-3, -1e-6, 1e-6, 1e-3, 0.1])
    found = call_glsl("fresnel(c, 1.5)", c=cosines)
    assert np.all(found[:4] == 1)
    assert np.all(found[4:] < 1)


def test_at_the_critical_angle_reflectance_falls_without_a_gap(call_glsl: CallGlsl) -> None:
    critical = np.float32(np.sqrt(1 - 1 / 1.5**2))
    steps = critical + np.arange(-2000, 2000) * np.float32(2.0**-24)
    found = call_glsl("fresnel(c, 1.5)", c=steps)
    assert np.all(np.isfinite(found))
    assert np.all(np.diff(found) <= 0)
    assert found[0] == 1
    assert found[-1] < 0.95


def test_without_an_interface_nothing_is_reflected(call_glsl: CallGlsl, context: Context) -> None:
    cosines = np.concatenate([np.linspace(1e-4, 1, 10_000), 10.0 ** -np.arange(1, 15)])
    found = call_glsl("fresnel(c, eta)", c=cosines, eta=np.array([1.0]))
    assert found.max() <= (0 if context.is_software else 1e-13)  # GPUs may round the root


@pytest.mark.parametrize("ior", IORS)
@pytest.mark.parametrize("from_inside", [False, True])
def test_reflectance_equals_fresnels_equations(
    call_glsl: CallGlsl, ior: float, from_inside: bool
) -> None:
    cosines = np.concatenate([np.linspace(1e-3, 1, 20_000), 10.0 ** -np.linspace(1, 6, 100)])
    eta = ior if from_inside else 1 / ior
    found = call_glsl("fresnel(c, eta)", c=cosines, eta=np.array([eta]))
    c, eta = float32(cosines), float(np.float32(eta))
    near = [fresnel64(c * (1 + shift), eta) for shift in (-2 * ULP, 0, 2 * ULP)]
    assert np.all(found >= np.min(near, axis=0) - 2e-6)
    assert np.all(found <= np.max(near, axis=0) + 2e-6)


@pytest.mark.parametrize("ior", [1.33, 1.5, 2.4])
def test_reflectance_is_the_same_from_either_side(call_glsl: CallGlsl, ior: float) -> None:
    cos_i = np.linspace(0.01, 1, 1000)
    cos_t = np.sqrt(1 - (1 - cos_i**2) / ior**2)
    outside = call_glsl("fresnel(c, 1.0 / ior)", c=cos_i, ior=np.array([ior]))
    inside = call_glsl("fresnel(c, ior)", c=cos_t, ior=np.array([ior]))
    well_posed = cos_i > 0.1  # beyond, a rounded cos_t is another angle
    assert np.abs(outside - inside)[well_posed].max() < 1e-5
    assert np.abs(outside - inside).max() < 1e-3


# --- refraction ----------------------------------------------------------------------------


def through_glass(call_glsl: CallGlsl, what: str, returns: str, **inputs: Any) -> Array:
    """A field of the Scattering of `wo` (local) about the world normal `n`."""
    setup = f"""
        Vertex vertex = Vertex(frame_around(n), wo, {GLASS}, true, eta, vec3(0.0), 1.0, vec3(eta));
        Scattering next = sample_dielectric(vertex, u);
        vec3 local = to_local(vertex.frame, next.direction);"""
    return call_glsl(what, returns, setup=setup, **inputs)


@pytest.mark.parametrize("eta", [1 / 1.5, 1.5, 2.4, 1 / 2.4])
def test_refraction_obeys_snell_and_reflection_is_its_mirror_image(
    call_glsl: CallGlsl, eta: float
) -> None:
    n = directions(5000)
    cosines = np.random.default_rng(1).uniform(0.001, 1, len(n))
    wo = wo_at(cosines)
    args = {"n": n, "wo": wo, "eta": np.array([eta])}
    refracts = eta * np.sqrt(1 - cosines**2) < 1 - 1e-6
    t = through_glass(call_glsl, "local", "vec3", u=np.array([BELOW_ONE]), **args)[refracts]
    assert np.abs(t[:, 0] + eta * wo[refracts, 0]).max() < 1e-6  # sin_t = eta sin_i, other side
    assert np.abs(t[:, 1]).max() < 1e-6
    assert t[:, 2].max() < 0
    r = through_glass(call_glsl, "local", "vec3", u=np.array([0.0]), **args)
    mirrored = wo * [-1, -1, 1]
    assert np.abs(r - mirrored)[fresnel64(cosines, eta) > 1e-6].max() < 1e-6


def test_without_an_interface_light_goes_straight_on(call_glsl: CallGlsl, context: Context) -> None:
    n = directions(1000)
    wo = wo_at(np.linspace(0.001, 1, len(n)))
    least = np.array([0.0 if context.is_software else 1e-9])  # with inexact roots some is reflected
    args = {"n": n, "wo": wo, "eta": np.array([1.0]), "u": least}
    assert np.abs(through_glass(call_glsl, "local", "vec3", **args) + wo).max() < 1e-6
    assert np.all(through_glass(call_glsl, "next.crosses", "bool", **args))


def test_a_crossing_ray_is_marked_and_its_radiance_scales_by_eta_squared(
    call_glsl: CallGlsl,
) -> None:
    eta = np.array([1 / 1.5, 1 / 1.5, 1.5, 1.5, 1.5])
    cosine = np.array([0.5, 0.5, 0.9, 0.9, 0.5])
    u = np.array([0.0, BELOW_ONE, 0.0, BELOW_ONE, BELOW_ONE])  # the last: total reflection
    args = {"wo": wo_at(cosine), "eta": eta, "u": u, "n": np.tile([0.0, 0, 1], (5, 1))}
    found = through_glass(
        call_glsl, "vec4(next.scale, next.crosses, next.pdf, next.weight.x)", "vec4", **args
    )
    crosses = np.array([0, 1, 0, 1, 0])
    assert found[:, 0] == pytest.approx(np.where(crosses, eta**2, 1), rel=1e-6)
    assert np.array_equal(found[:, 1], crosses)
    assert np.all(found[:, 2] == 0)
    assert np.all(found[:, 3] == 1)


def test_reflection_is_chosen_with_the_probability_of_its_share(call_glsl: CallGlsl) -> None:
    u = (np.arange(10_000) + 0.5) / 10_000
    for eta, cosine in ((1 / 1.5, 0.1), (1 / 1.5, 0.6), (1.5, 0.78)):
        crosses = through_glass(
            call_glsl,
            "float(next.crosses)",
            "float",
            u=u,
            eta=np.array([eta]),
            wo=np.repeat(wo_at(cosine), len(u), axis=0),
            n=np.tile([0.0, 0.0, 1.0], (len(u), 1)),
        )
        assert 1 - crosses.mean() == pytest.approx(fresnel64(np.array(cosine), eta), abs=2e-4)
        assert np.all(np.diff(crosses) >= 0)  # small numbers reflect


def test_glass_knows_its_inside(call_glsl: CallGlsl) -> None:
    setup = f"""
        Sampler rng = make_sampler(uint(seed));
        Vertex vertex = vertex_of(frame_around(vec3(0.0, 0.0, 1.0)), wo, {GLASS}, outside == 1);
        Scattering next = sample_material(vertex, rng);"""
    count = 400
    wo = np.repeat(wo_at(0.9), count, axis=0)
    for outside, eta in ((1, 1 / 1.5), (0, 1.5)):
        found = call_glsl(
            "vec3(next.crosses, next.direction.x, next.scale)",
            "vec3",
            setup=setup,
            wo=wo,
            seed=np.arange(count),
            outside=np.array([outside]),
        )
        crossed = found[found[:, 0] == 1]
        assert len(crossed) > 300
        assert crossed[:, 1] == pytest.approx(-eta * wo[0, 0], abs=1e-6)
        assert crossed[:, 2] == pytest.approx(eta**2, rel=1e-6)
