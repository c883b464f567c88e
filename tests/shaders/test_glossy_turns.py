"""Particles at glossy surfaces: what they carry on, and how they are weighed against paths."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.glsl import read
from tests.conftest import CallGlsl
from tests.shaders.test_material import ggx_lambda
from tests.support.builders import glass, lamp, quad, scene_of
from tests.support.meshes import icosphere, mesh
from tests.support.numerics import Array, float32
from tests.support.particle_starts import ON, particle_text

KINDS: dict[str, dict[str, Any]] = {
    "metal": {"type": "metal", "color": [0.9, 0.8, 0.5], "roughness": 0.5},
    "polished metal": {"type": "metal", "color": [0.9, 0.8, 0.5], "roughness": 0.1},
    "glass": glass(roughness=0.5),
    "glass of little ior": glass(0.8, roughness=0.7),
    "plastic": {"type": "principled", "color": [0.2, 0.5, 0.8], "roughness": 0.4},
    "coated": {
        "type": "principled",
        "color": [0.6, 0.5, 0.4],
        "metallic": 0.5,
        "roughness": 0.6,
        "clearcoat": 1.0,
        "clearcoat_roughness": 0.3,
    },
}
BRUSHED = "brushed"  # of a kernel of its own, as plastic is, so its cases are slow
KINDS[BRUSHED] = {
    **KINDS["coated"],
    "anisotropy": 0.7,
    "iridescence": 0.9,
    "sheen": [0.5, 0.4, 0.3],
    "diffuse_transmission": 0.4,
}
kinds = pytest.mark.parametrize(
    "kind",
    [pytest.param(k, marks=pytest.mark.slow) if k in (BRUSHED, "plastic") else k for k in KINDS],
)
COUNT = 20_000
SETUP = """
    vec3 facing = vec3(0.0, 0.0, 1.0);
    Normals normals = Normals(facing, bent);
    Vertex vertex = vertex_of(frame_around(facing), wi, material_at(0), outside == 1);
    if (HAS_ANISOTROPY) vertex = vertex_along(vertex, vec3(0.6, 0.8, 0.0), material_at(0).ior);
    Sampler rng = make_sampler(uint(i) * 9781u + 7u);
    Particle particle = start_particle(rng);
    particle.path.ray.direction = -wi;
    particle.kappa = 1.0;
    Scattering next = scatter_particle(vertex, normals, rng);
    turn_particle(particle, vertex, normals, next);
    Vertex met = vertex_from(vertex, normals, next.direction);
    Normals there = normals_towards(normals, next.direction);"""


def scattered(
    call_glsl: CallGlsl, kind: str, returns: str, what: str, tilt: float = 0.0, outside: int = 1
) -> tuple[Array, Array]:
    """An expression of particles that a surface scatters, and where they came from.

    `tilt`: how far the normals for shading are from the true one at most, as a tangent.
    """
    random = np.random.default_rng(5)
    z, phi = random.uniform(0.05, 1, COUNT), random.uniform(0, 2 * np.pi, COUNT)
    r = np.sqrt(1 - z * z)
    wi = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    bent = np.stack([*random.uniform(-tilt, tilt, (2, COUNT)), np.ones(COUNT)], axis=1)
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    thing = mesh(icosphere(1), "it", scale=0.3, smooth=tilt > 0)
    place = scene_of(
        [thing, quad([0, 1, 0], [1, 0, 0], [0, 0, 1], "lamp")],
        {"it": KINDS[kind], "lamp": lamp(2.0)},
    )
    found = call_glsl(
        what,
        returns=returns,
        functions=particle_text() + read("integrators/particles.glsl"),
        scene=place,
        options=ON,
        setup=SETUP,
        wi=wi,
        bent=bent,
        outside=np.array([outside], np.int32),
    )
    return found, float32(wi)


@kinds
@pytest.mark.parametrize("outside", [1, 0])
def test_a_particle_carries_what_the_surface_leaves_of_it(
    call_glsl: CallGlsl, kind: str, outside: int
) -> None:
    """Where surfaces are reciprocal, that is the weight of a path that goes the same way."""
    what = "vec3(length(particle.path.throughput), length(next.weight), next.pdf)"
    found, _ = scattered(call_glsl, kind, "vec3", what, outside=outside)
    goes = found[:, 2] > 0
    assert goes.mean() > 0.5
    assert_allclose(found[goes, 0], found[goes, 1], rtol=4e-3)
    assert not found[~goes, 0].any()


@pytest.mark.slow
@kinds
def test_what_arrives_by_the_true_normal_is_spread_by_the_other(
    call_glsl: CallGlsl, kind: str
) -> None:
    """The throughput is a camera path's, scaled by the flux that the surface gets and sends."""
    what = """vec2(particle.path.throughput.g, eval_material(met, to_local(met.frame, wi)).g
        * abs(next.direction.z / wi.z) / next.pdf)"""
    found, _ = scattered(call_glsl, kind, "vec2", what, tilt=0.6)
    goes = found[:, 0] > 0
    assert goes.mean() > 0.4
    assert_allclose(found[goes, 0], found[goes, 1], rtol=2e-3)


@kinds
@pytest.mark.parametrize("tilt", [0.0, 0.6])
@pytest.mark.parametrize("outside", [1, 0])
def test_paths_and_particles_know_the_same_densities(
    call_glsl: CallGlsl, kind: str, tilt: float, outside: int
) -> None:
    """P0 over PL of a scattering event, from either end; and P1 over P0 where it is the first."""
    what = """vec4(particle.turn * float(particle.path.throughput != vec3(0.0)),
        glossy_turn(met, there, wi, false), particle.kappa, glossy_turn(met, there, wi, true))"""
    found, _ = scattered(call_glsl, kind, "vec4", what, tilt, outside)
    goes = found[:, 0] > 0
    assert goes.mean() > 0.4
    assert_allclose(found[goes, 0], found[goes, 1], rtol=2e-2)
    assert np.median(np.abs(found[goes, 0] / found[goes, 1] - 1)) < 1e-5
    assert_allclose(found[goes, 2] * found[goes, 3], 1, rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["metal", "polished metal"])
def test_metal_turns_by_what_facets_hide(call_glsl: CallGlsl, kind: str) -> None:
    """Visible normals have the density G1 D / (4 cos), so the closed form is G1(wo) / G1(wi)."""
    what = "vec4(particle.turn, next.direction)"
    found, wi = scattered(call_glsl, kind, "vec4", what)
    goes = found[:, 3] > 1e-3
    alpha = np.array(KINDS[kind]["roughness"] ** 2)
    wi, wo = wi[goes], found[goes, 1:].astype(np.float64)
    exact = (1 + ggx_lambda(alpha, wi)) / (1 + ggx_lambda(alpha, wo))
    assert np.ptp(exact) > 1e-2
    assert_allclose(found[goes, 0], exact, rtol=4e-3)


@pytest.mark.slow
def test_brushed_facets_lie_alike_for_paths_from_either_end(call_glsl: CallGlsl) -> None:
    """The value times the cosine of the other direction is the same in both."""
    what = """vec2(eval_material(met, to_local(met.frame, wi)).g * abs(next.direction.z),
        eval_material(vertex, to_local(vertex.frame, next.direction)).g * wi.z)"""
    found, _ = scattered(call_glsl, BRUSHED, "vec2", what)
    goes = found[:, 1] > 1e-3
    assert goes.mean() > 0.5
    assert_allclose(found[goes, 0], found[goes, 1], rtol=4e-3)
