"""One surface point under a lamp or a sky whose light on it is known in closed form.

The field of view is a hundredth of a degree: all pixels see the same point.
"""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.support.renders import METHODS, assert_mean, rendered, whole

Floats = NDArray[np.float64]

FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
MATERIALS = {"floor": MATTE, "lamp": lamp(2.0)}  # albedo 0.5 under radiance 2: L is the form factor
ASIDE = {"position": [-2, 1, 0], "look_at": [0, 0, 0], "fov": 0.01}
SKY = {"bottom": [1.0, 0.9, 0.2], "top": [0.3, 0.7, 1.4]}
FLAT, STEEP = (np.array(SKY["bottom"]) + SKY["top"]) / 2, (np.array(SKY["top"]) - SKY["bottom"]) / 2


def sphere_form_factor(s2: float, cosine: float) -> float:
    """A ball's form factor: s2 = (radius / distance)^2, its centre `cosine` above the horizon."""
    if cosine * cosine > s2:
        return s2 * max(cosine, 0)
    x, sine = math.sqrt(1 / s2 - 1), math.sqrt(1 - cosine * cosine)
    y = max(-1, min(1, -x * cosine / sine))
    q = sine * math.sqrt(1 - y * y)
    return ((cosine * math.acos(y) - x * q) * s2 + math.atan2(q, x)) / math.pi


def rectangle_form_factor(a: float, b: float) -> float:
    """A rectangle a x b, parallel to the surface, one corner at height 1 above the point."""
    p, q = math.hypot(1, a), math.hypot(1, b)
    return (a / p * math.atan(b / p) + b / q * math.atan(a / q)) / (2 * math.pi)


def under_ball(radius: float, distance: float, cosine: float) -> Scene:
    sine = math.sqrt(1 - cosine * cosine)
    ball = sphere([distance * sine, distance * cosine, 0], radius, "lamp")
    return scene_of([FLOOR, ball], MATERIALS, ASIDE)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("s2", "cosine", "truth"),
    [
        (0.25, 1.0, 0.25),
        (0.25, 0.5, 0.125),
        (0.25, 0.1, 0.042713),
        (0.25, 0.0, 0.028834),
        (0.25, -0.05, 0.022929),
        (0.25, -0.3, 0.003715),
        (0.64, -0.7, 0.002261),
    ],
)
def test_ball_lights_a_floor_down_to_its_horizon(
    context: Context, s2: float, cosine: float, truth: float, method: str
) -> None:
    assert sphere_form_factor(s2, cosine) == pytest.approx(truth, abs=1e-6)
    scene = under_ball(math.sqrt(s2), 1.0, cosine)
    samples, size = 256 if method != "naive" else 1024, 64 if truth < 0.01 else 20
    image = rendered(scene, context, samples, method=method, bounces=1, width=size, height=size)
    assert_mean(whole(image), sphere_form_factor(s2, cosine), within=0.06)


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_ball_below_the_horizon_lights_nothing(context: Context, method: str) -> None:
    image = rendered(under_ball(0.5, 1.0, -0.51), context, 16, method=method)
    assert (image.radiance == 0).all()


@pytest.mark.parametrize("method", ["nee", "mis"])
@pytest.mark.parametrize("distance", [1.125, 2.0, 4.0, 16.0, 100.0, 1e3, 1e4, 1e5, 1e6])
def test_light_of_a_ball_falls_with_the_square_of_its_distance(
    context: Context, distance: float, method: str
) -> None:
    """Light sampling hits the cone evenly: far away, hardly anything is left to chance."""
    truth = 1 / distance**2
    image = rendered(under_ball(1.0, distance, 1.0), context, 256, method=method, bounces=1)
    assert_mean(whole(image), truth, within=0.01, floor=2e-6 * truth)
    if distance >= 1e3:
        assert np.allclose(whole(image).mean, truth, rtol=1e-5)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("faces_down", [False, True])
def test_rectangle_lights_the_point_below_its_corner(
    context: Context, faces_down: bool, method: str
) -> None:
    edges = [[1.3, 0, 0], [0, 0, 0.7]]
    panel = quad([0, 1, 0], edges[faces_down], edges[not faces_down], "lamp")
    scene = scene_of([FLOOR, panel], MATERIALS, {**ASIDE, "position": [-2, 1, -1]})
    samples = 1024 if method == "naive" else 256
    image = rendered(scene, context, samples, method=method, bounces=1)
    assert rectangle_form_factor(1.3, 0.7) == pytest.approx(0.125443, abs=1e-6)
    assert_mean(whole(image), rectangle_form_factor(1.3, 0.7), within=0.03)


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_rectangle_lights_the_point_below_its_inside(context: Context, method: str) -> None:
    """Four corners add up; the panel's height scales out."""
    left, right, near, far, height = 0.4, 0.9, 0.3, 1.1, 2.0
    corner = [-left * height, height, -near * height]
    edges = [(left + right) * height, 0, 0], [0, 0, (near + far) * height]
    scene = scene_of([FLOOR, quad(corner, *edges, "lamp")], MATERIALS, ASIDE)
    image = rendered(scene, context, 512, method=method, bounces=1)
    truth = sum(rectangle_form_factor(a, b) for a in (left, right) for b in (near, far))
    assert_mean(whole(image), truth, within=0.01)


@pytest.mark.parametrize("normal", [[0, 1, 0], [0.6, 0.8, 0], [0, -0.28, 0.96], [0, -1, 0]])
def test_matte_ball_averages_the_sky_above_its_surface(
    context: Context, normal: list[float]
) -> None:
    """a (A + 2/3 B n.y) under a sky A + B w.y."""
    eye = {"position": [3 * c for c in normal], "look_at": [0, 0, 0], "up": [0, 0.5, 1]}
    ball = sphere([0, 0, 0], 1, "floor")
    scene = scene_of([ball], MATERIALS, {**eye, "fov": 0.01}, background=SKY)
    image = rendered(scene, context, 1024, bounces=1)
    assert_mean(whole(image), 0.5 * (FLAT + 2 / 3 * STEEP * normal[1]), within=0.005)


def test_matte_floor_averages_the_sky(context: Context) -> None:
    scene = scene_of([FLOOR], MATERIALS, ASIDE, background=SKY)
    image = rendered(scene, context, 512, bounces=1)
    assert_mean(whole(image), 0.5 * (FLAT + 2 / 3 * STEEP), within=0.005)


@pytest.mark.parametrize("cosine", [0.2, 0.5, 1.0])
@pytest.mark.parametrize("roughness", [0.3, 0.6, 1.0])
def test_rough_metal_reflects_its_directional_albedo(
    context: Context, roughness: float, cosine: float
) -> None:
    metal = {"type": "metal", "color": [1, 0.5, 0.25], "roughness": roughness}
    sine = math.sqrt(1 - cosine**2)
    eye = {"position": [2 * sine, 2 * cosine, 0], "look_at": [0, 0, 0], "up": [0, 0, 1]}
    white = {"color": [1, 1, 1]}
    scene = scene_of([FLOOR], {"floor": metal}, {**eye, "fov": 0.01}, background=white)
    image = rendered(scene, context, 512, width=32, height=32, bounces=1)
    truth = ggx_albedo(roughness**2, cosine) * np.array([1, 0.5, 0.25])
    assert_mean(whole(image), truth, within=0.01, floor=1e-4 * truth[2])


def ggx_albedo(alpha: float, cosine: float, steps: int = 500) -> float:
    """Share of light that one bounce reflects: D G2 / (4 cos) over the hemisphere, by midpoints."""
    theta = (np.arange(steps) + 0.5)[:, None] * math.pi / (2 * steps)
    phi = (np.arange(2 * steps) + 0.5) * math.pi / steps
    z, s, so = np.cos(theta), np.sin(theta), math.sqrt(1 - cosine**2)
    h = np.stack(np.broadcast_arrays(s * np.cos(phi) + so, s * np.sin(phi), z + cosine), axis=-1)
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    slope = (h[..., 0] ** 2 + h[..., 1] ** 2) / alpha**2 + h[..., 2] ** 2
    shadow = 1 + smith_lambda(alpha, z) + smith_lambda(alpha, np.array(cosine))
    density = 1 / (math.pi * (alpha * slope) ** 2) / shadow / (4 * cosine)
    return float((density * s).mean() * math.pi**2)


def smith_lambda(alpha: float, cosine: Floats) -> Floats:
    value: Floats = (np.sqrt(1 + alpha**2 * (1 / cosine**2 - 1)) - 1) / 2
    return value


# Columns: where x, y and z go. No row or column is a multiple of an axis.
TURN = np.linalg.qr([[0.3, -0.7, 0.5], [0.8, 0.2, -0.4], [-0.1, 0.6, 0.9]])[0]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", ["plane", "quad"])
@pytest.mark.parametrize("seen_from", ["above", "below"])
def test_tilted_floor_neither_shadows_nor_hits_itself(
    context: Context, seen_from: str, shape: str, method: str
) -> None:
    """Away from the axes rounding puts a point off its surface, on either side of it."""
    side = 1 if seen_from == "above" else -1

    def turned(*vector: float) -> list[float]:
        return [float(c) for c in TURN @ np.array(vector)]

    floor = plane([0, 0, 0], turned(0, 1, 0), "floor")
    if shape == "quad":
        floor = quad(turned(-4, 0, -5), turned(9, 0, 0), turned(1, 0, 9), "floor")
    ball = sphere(turned(0.6, side * 0.8, 0), 0.5, "lamp")
    eye = {"position": turned(-2, side, -1), "look_at": [0, 0, 0], "fov": 0.5}
    scene = scene_of([floor, ball], MATERIALS, eye)
    image = rendered(scene, context, 512, method=method, bounces=1, width=32, height=32)
    assert_mean(whole(image), sphere_form_factor(0.25, 0.8), within=0.02)
