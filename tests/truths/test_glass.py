"""Glass, as the shader traces it: long paths inside, a ball lens, and the critical angle."""

import math

import numpy as np
import pytest

from tests.conftest import CallGlsl
from tests.support.builders import glass, scene_of, sphere
from tests.support.numerics import BELOW_ONE, ULP, directions, dot, float32, length, wo_at

HALF_ULP = ULP / 2
INSIDE = scene_of([sphere([0, 0, 0], 1, "glass")], {"glass": glass(1.5)})  # the camera as well
REFLECTED = """
    Ray ray = Ray(start, aim, 0, true);
    float drift = 0.0;
    float off = 0.0;
    for (int k = 0; k < 64; ++k) {
        Surface surface = surface_at(ray, closest_hit(ray));
        mat3 around = frame_around(-surface.normal);
        Vertex vertex = vertex_of(around, to_local(around, -ray.direction), material_at(0), false);
        Scattering next = sample_dielectric(vertex, 0.0);
        ray = Ray(surface.position, next.direction, surface.shape, true);
        drift = max(drift, abs(length(ray.direction) - 1.0));
        off = max(off, abs(length(ray.origin) - 1.0));
    }"""


def test_directions_stay_unit_over_many_reflections_in_glass(call_glsl: CallGlsl) -> None:
    """64 internal reflections keep the path's plane, angle and length; without renormalising, |d|
    grows to 1e22 within eight.
    """
    n = 2000
    start = directions(n, 5)[:n]
    cosine = np.random.default_rng(6).uniform(0.05, 0.7, n)  # beyond the critical angle
    tangent = np.cross(start, directions(n, 7)[:n])
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    aim = -cosine[:, None] * start + np.sqrt(1 - cosine**2)[:, None] * tangent
    args = {"start": start, "aim": aim, "scene": INSIDE, "setup": REFLECTED}
    drift, off = call_glsl("vec2(drift, off)", "vec2", **args).T
    assert drift.max() <= 4 * HALF_ULP
    assert off.max() <= 4 * HALF_ULP
    end = float32(call_glsl("ray.direction", "vec3", **args))
    place = float32(call_glsl("ray.origin", "vec3", **args))
    assert np.abs(-dot(end, place) - cosine).max() < 3e-5
    assert np.abs(dot(np.cross(float32(start), float32(aim)), end)).max() < 3e-5


@pytest.mark.parametrize("height", [0.001, 0.1, 0.3, 0.6])
def test_ball_lens_focuses_where_geometry_says(call_glsl: CallGlsl, height: float) -> None:
    """A ray parallel to the axis at the height h leaves a ball of index n across the axis at
    R sin(i) / sin(2 (i - t)) behind its centre; paraxially at n R / (2 (n - 1)) = 1.5.
    """
    setup = """
        Ray ray = Ray(vec3(0.0, height, 3.0), vec3(0.0, 0.0, -1.0), NO_SHAPE, false);
        for (int k = 0; k < 2; ++k) {
            Surface surface = surface_at(ray, closest_hit(ray));
            float side = k == 0 ? 1.0 : -1.0;
            mat3 around = frame_around(side * surface.normal);
            vec3 wo = to_local(around, -ray.direction);
            Vertex vertex = vertex_of(around, wo, material_at(0), k == 0);
            Scattering next = sample_dielectric(vertex, through);
            ray = Ray(surface.position, next.direction, surface.shape, k == 0);
        }
        float crossing = -ray.origin.z + ray.origin.y / ray.direction.y * ray.direction.z;"""
    found = call_glsl(
        "crossing",
        setup=setup,
        scene=INSIDE,
        height=np.array([height]),
        through=np.array([BELOW_ONE]),
    )
    outer = math.asin(height)
    turn = 2 * (outer - math.asin(height / 1.5))
    assert found[0] == pytest.approx(math.sin(outer) / math.sin(turn), rel=1e-4)
    published = {0.001: 1.5, 0.1: 1.49583, 0.3: 1.46198, 0.6: 1.34078}
    assert found[0] == pytest.approx(published[height], abs=2e-4)


@pytest.mark.parametrize(
    ("ior", "outside", "inside"),
    [(1.33, 0.06593, 0.47195), (1.5, 0.09178, 0.59635), (2.4, 0.21018, 0.86288)],
)
def test_glass_reflects_its_hemispherical_share(
    call_glsl: CallGlsl, ior: float, outside: float, inside: float
) -> None:
    """2 int F cos dcos, and 1 - F_in = (1 - F_out) / n^2: what enters from all sides fills 1/n^2
    of the directions inside.
    """
    count = 2**18
    cosine2 = (np.arange(count) + 0.5) / count
    means = [
        call_glsl("fresnel(c, eta)", c=np.sqrt(cosine2), eta=np.array([eta])).mean(dtype=float)
        for eta in (1 / ior, ior)
    ]
    assert means == pytest.approx([outside, inside], abs=2e-5)
    assert 1 - means[1] == pytest.approx((1 - means[0]) / ior**2, abs=2e-5)


@pytest.mark.parametrize("ior", [1 + 1e-6, 1.001, 1.5, 2.4])
def test_rays_at_the_critical_angle_stay_numbers(call_glsl: CallGlsl, ior: float) -> None:
    """Within 1e-6 of it, a million angles: unit directions, and no more than a share of 1."""
    critical = math.sqrt((1 - 1 / ior) * (1 + 1 / ior))
    random = np.random.default_rng(8)
    count = 250_000
    cosine = critical + random.uniform(-1e-6, 1e-6, count)
    given = {"eta": np.array([ior]), "wo": wo_at(np.maximum(cosine, 1e-9))}
    setup = """
        Material glass =
            Material(vec3(1.0), DIELECTRIC, vec3(0.0), 0.0, 1.5, 0, 0, -1, 0.0, 0.0, 1.0, 1.0);
        mat3 frame = frame_around(vec3(0.6, 0.0, 0.8));
        Vertex vertex = Vertex(frame, wo, glass, true, eta, vec3(0.0), 1.0, vec3(eta));
        Scattering next = sample_dielectric(vertex, u);"""
    for u in (0.0, 0.3, 0.9, BELOW_ONE):
        args = {"setup": setup, "u": np.array([u]), **given}
        found = call_glsl("vec4(next.direction, fresnel(wo.z, eta))", "vec4", **args)
        assert np.all(np.isfinite(found))
        assert np.abs(length(found[:, :3]) - 1).max() <= 4 * HALF_ULP
        assert found[:, 3].min() >= 0
        assert found[:, 3].max() <= 1
