"""Quad lamps sampled by strips: the map, its density and its digits, from near and from afar."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import lamp, plane, quad, scene_of
from tests.support.numerics import Array, dot, float32, unit_square
from tests.support.packed import packed
from tests.support.renders import assert_mean, rendered, whole

NEE = {"QUADS_BY_AREA": False}
LAMPS: dict[str, list[list[float]]] = {  # edges
    "rectangle": [[1.3, 0, 0], [0, 0, 0.7]],
    "tube": [[0, 0, 9.0], [0.01, 0, 0]],
    "rhombus": [[1.0, 0, 0.9], [1.0, 0, -0.9]],
    "slanted": [[0.5, 0, 0.1], [0.9, 0, 1.2]],
}
POINTS: dict[str, list[float]] = {  # from the lamp's corner
    "below": [0.4, -1.0, 0.3],
    "close below": [0.3, -0.001, 0.2],
    "beside": [-2.0, -0.5, 0.1],
    "grazing": [-2.0, -1e-4, -3.0],
    "behind": [0.2, 3.0, 0.6],
    "far": [200.0, -300.0, 500.0],
    "a million away": [2e5, -9e5, 3e5],
    "far along the plane": [3e3, -0.5, 10.0],
}


def lit(name: str) -> Scene:
    edge_u, edge_v = LAMPS[name]
    return scene_of([quad([0, 0, 0], edge_u, edge_v, "lamp")], {"lamp": lamp(2.0)})


def views(place: str, count: int) -> Array:
    return np.tile(np.array(POINTS[place]), (count, 1))


class Seen:
    """A lamp from a point, in float64: what strips.glsl does in float32."""

    def __init__(self, scene: Scene, origin: Array) -> None:
        row = {name: float32(v) for name, v in zip(*self._row(scene), strict=True)}
        self.u, self.v, normal = row["edge_u"], row["edge_v"], row["normal"]
        self.corner = row["corner"] - float32(origin)
        self.length = float(np.linalg.norm(self.v))
        along = self.v / self.length
        across = np.cross(normal, along)
        self.axes = across * np.sign(self.u @ across), along
        self.width, self.shear = self.u @ self.axes[0], self.u @ along
        self.z = float(abs(self.corner @ normal))
        self.normal = normal
        self.x0, self.y0 = (self.corner @ axis for axis in self.axes)

    @staticmethod
    def _row(scene: Scene) -> tuple[Any, Any]:
        row = packed(scene)["Quad"][0]
        return row.dtype.names, [row[name] for name in row.dtype.names]

    @property
    def angle(self) -> float:
        return float(np.arctan((self.x0 + self.width) / self.z) - np.arctan(self.x0 / self.z))

    def sines(self, a: Array) -> tuple[Array, Array, Array]:
        """Distance of the strip, and y / r at its ends."""
        x, y = self.x0 + a * self.width, self.y0 + a * self.shear
        d = np.hypot(x, self.z)
        return d, y / np.hypot(d, y), (y + self.length) / np.hypot(d, y + self.length)

    def shares(self, a: Array, b: Array) -> tuple[Array, Array]:
        """The two numbers from which a sample was made."""
        u = (np.arctan((self.x0 + a * self.width) / self.z) - np.arctan(self.x0 / self.z)) / (
            self.angle
        )
        d, low, high = self.sines(a)
        y = self.y0 + a * self.shear + b * self.length
        return u, (y / np.hypot(d, y) - low) / (high - low)

    def solid_angle(self) -> float:
        """The sum over its two triangles (van Oosterom and Strackee 1983)."""
        corners = [self.corner, self.corner + self.u, self.corner + self.u + self.v]
        corners += [self.corner + self.v]
        return abs(self._triangle(*corners[:3])) + abs(self._triangle(corners[0], *corners[2:]))

    @staticmethod
    def _triangle(a: Array, b: Array, c: Array) -> float:
        x, y, z = (np.linalg.norm(v) for v in (a, b, c))
        below = x * y * z + (a @ b) * z + (b @ c) * x + (c @ a) * y
        return float(2 * np.arctan2(a @ np.cross(b, c), below))


def sampled(call_glsl: CallGlsl, scene: Scene, origin: Array, u: Array) -> tuple[Array, Array]:
    """Shares of the edges, and densities."""
    found = call_glsl(
        "vec3(share, pdf_strips(quad_at(0), view, share.x))",
        "vec3",
        setup="""StripView view = view_strips(quad_at(0), origin);
            vec2 share = sample_strips(quad_at(0), view, u);""",
        scene=scene,
        constants=NEE,
        origin=origin,
        u=u,
    ).astype(np.float64)
    return found[:, :2], found[:, 2]


def test_the_angle_has_its_digits_without_the_built_in(call_glsl: CallGlsl) -> None:
    tangent = np.concatenate([np.linspace(0, 1, 10_001), 10.0 ** -np.arange(1, 30)])
    found = call_glsl("small_angle(t)", t=tangent)
    assert_allclose(found, np.arctan(float32(tangent)), rtol=3e-7)


@pytest.mark.parametrize("place", POINTS)
@pytest.mark.parametrize("name", LAMPS)
def test_samples_are_even_over_strips_and_along_them(
    call_glsl: CallGlsl, name: str, place: str
) -> None:
    """The shares that made a sample are found again, up to the digits of a direction."""
    u = unit_square(64)
    scene = lit(name)
    share, _ = sampled(call_glsl, scene, views(place, len(u)), u)
    assert share.min() >= 0
    assert share.max() <= 1
    seen = Seen(scene, np.array(POINTS[place]))
    x, y = seen.shares(*share.T)
    if 2 * seen.x0 + seen.width > 0:
        x = 1 - x
    rough = 2e-6 + 2e-7 * float(seen.length) / seen.z  # of a place on the lamp
    size = min(seen.angle, float(np.ptp(np.stack(seen.sines(share[:, 0])[1:]), axis=0).max()))
    assert_allclose(x, u[:, 0], atol=rough + 4e-7 / size)
    assert_allclose(y, u[:, 1], atol=rough + 4e-7 / size)


@pytest.mark.parametrize("place", POINTS)
@pytest.mark.parametrize("name", LAMPS)
def test_densities_sum_up_to_the_solid_angle(call_glsl: CallGlsl, name: str, place: str) -> None:
    """The mean of 1 / pdf over samples estimates it."""
    u = unit_square(256)
    u = np.stack([(1 - np.cos(np.pi * u[:, 0])) / 2, u[:, 1]], axis=-1)  # finer at the ends
    weight = np.pi / 2 * np.sqrt(4 * u[:, 0] * (1 - u[:, 0]))
    scene = lit(name)
    _, pdf = sampled(call_glsl, scene, views(place, len(u)), u)
    exact = Seen(scene, np.array(POINTS[place])).solid_angle()
    assert (weight / pdf).mean() == pytest.approx(exact, rel=0.03 if place == "grazing" else 2e-4)


def test_no_sample_weighs_more_than_a_half_space(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(1)
    origin = random.uniform(-2, 2, (50_000, 3)) * [1, 0, 1]
    origin[:, 1] = 10 ** random.uniform(-18, 1, 50_000)
    for name in LAMPS:
        share, pdf = sampled(call_glsl, lit(name), origin, random.uniform(size=(50_000, 2)))
        assert np.isfinite(share).all()
        assert (1 / pdf).max() <= 2 * np.pi * (1 + 1e-6)


@pytest.mark.parametrize("name", LAMPS)
def test_the_density_integrates_to_one_over_all_directions(call_glsl: CallGlsl, name: str) -> None:
    """The density is that of rays that meet the lamp: it weighs light found by scattering."""
    side = 1200
    z, turn = (unit_square(side) * 2 - 1).T
    r, phi = np.sqrt(1 - z * z), np.pi * turn
    direction = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    setup = """Ray ray = Ray(vec3(0.2, -0.1, 0.05), direction, NO_SHAPE, false);
        float distance = quad_distance(ray, quad_at(0));"""
    pdf = call_glsl(
        "distance > 0.0 ? pdf_light(0, ray, distance, total_weight(ray)) : 0.0",
        setup=setup,
        scene=lit(name),
        constants=NEE,
        direction=direction,
    )
    within = 3e-2 if name == "tube" else 3e-3  # it is a hundredth as wide as it is long
    assert pdf.astype(np.float64).mean() * 4 * np.pi == pytest.approx(1, abs=within)


@pytest.mark.parametrize("name", LAMPS)
def test_sampling_and_scattering_know_one_density(call_glsl: CallGlsl, name: str) -> None:
    random = np.random.default_rng(1)
    u, origin = random.uniform(size=(20_000, 2)), random.uniform(-2, 2, (20_000, 3))
    found = call_glsl(
        "vec3(light.pdf, pdf_light(0, light.ray, hit.distance, 1.0), hit.shape)",
        "vec3",
        setup="""Ray from = Ray(origin, vec3(0.0, 1.0, 0.0), NO_SHAPE, false);
            LightSample light = sample_lamp(from, 0, u, 1.0);
            Hit hit = closest_hit(light.ray);""",
        scene=lit(name),
        constants=NEE,
        origin=origin,
        u=u,
    ).astype(np.float64)
    seen = found[:, 2] == 0
    assert seen.mean() > 0.99
    assert_allclose(found[seen, 1], found[seen, 0], rtol=2e-3)
    assert np.median(np.abs(found[seen, 1] / found[seen, 0] - 1)) < 1e-6


@pytest.mark.parametrize("exponent", [-20, 20])
def test_a_lamp_of_another_scale_is_sampled_to_the_same_bits(
    call_glsl: CallGlsl, exponent: int
) -> None:
    u = unit_square(32)
    edge_u, edge_v = np.array(LAMPS["slanted"]) * 2.0**exponent
    large = scene_of([quad([0, 0, 0], edge_u, edge_v, "lamp")], {"lamp": lamp(2.0)})
    for place in ("below", "grazing", "far"):
        origin = float32(views(place, len(u)))
        share, pdf = sampled(call_glsl, lit("slanted"), origin, u)
        scaled = sampled(call_glsl, large, origin * 2.0**exponent, u)
        assert np.array_equal(scaled[0], share)
        assert np.array_equal(scaled[1], pdf)


def test_a_point_in_the_lamps_plane_samples_nothing(call_glsl: CallGlsl) -> None:
    origin = np.array([[-1.0, 0.0, 0.3], [0.3, 0.0, 0.3], [0.3, 1e-30, 0.3]])
    setup = """Ray from = Ray(origin, vec3(0.0, 1.0, 0.0), NO_SHAPE, false);
        LightSample light = sample_lamp(from, 0, vec2(0.5), 1.0);"""
    scene = lit("rectangle")
    args = {"setup": setup, "scene": scene, "constants": NEE, "origin": origin}
    assert call_glsl("light.pdf", **args).tolist() == [0, 0, 0]


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_a_lamp_just_below_its_ceiling_lights_it_up_to_the_rim(
    context: Context, method: str
) -> None:
    """A strip of the ceiling that is as wide as the gap, seen through a long lens.

    At the distance s from the edge of a long lamp, and h above its plane, the form factor is that
    of a half-plane, (1 - s / sqrt(s^2 + h^2)) / 2. Points by area are near enough once in ten
    thousand.
    """
    gap, albedo = 0.001, 0.5
    objects = [
        plane([0, 1, 0], [0, -1, 0], "white"),
        quad([0, 1 - gap, -20], [20, 0, 0], [0, 0, 40], "lamp"),
    ]
    materials = {"white": {"type": "lambertian", "color": [albedo] * 3}, "lamp": lamp(2.0)}
    middle = -0.0015
    eye = {"position": [-1, 0, 0], "look_at": [middle, 1, 0], "fov": 0.02}
    scene = scene_of(objects, materials, eye)
    image = rendered(scene, context, 256 if method == "nee" else 2048, method=method, bounces=1)
    distance = np.hypot(1 + middle, 1)
    reach = distance * np.tan(np.radians(0.01))  # of the view, half, across its axis
    edge = np.linspace(-reach, reach, 10_001) * distance
    s = -(middle + edge)
    factor = (0.5 * (1 - s / np.hypot(s, gap))).mean()
    assert_mean(whole(image), 2 * albedo * factor, within=0.025)


def test_directions_follow_the_edges() -> None:
    """The longer edge is the one along which strips run; the normal is the scene file's."""
    scene = lit("tube")
    row = packed(scene)["Quad"][0]
    assert row["edge_u"].tolist() == pytest.approx([0.01, 0, 0])
    assert row["height"] == 9
    assert row["width"] == pytest.approx(0.01)
    assert row["normal"].tolist() == [0, 1, 0]
    for dual, ends in (("dual_u", (1, 0)), ("dual_v", (0, 1))):
        products = [dot(float32(row[dual]), float32(row[edge])) for edge in ("edge_u", "edge_v")]
        assert_allclose(products, ends, atol=1e-6)
