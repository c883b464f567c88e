"""Pictures known in closed form beyond rooms and single lamps: shade, polygons, glass, edges.

Each docstring derives its figure; docs/explanation/correctness.md lists them all.
"""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, glass, lamp, plane, quad, scene_of, sphere
from tests.support.renders import METHODS, Estimate, assert_agree, assert_mean, rendered, whole
from tests.truths.test_direct_light import sphere_form_factor

Floats = NDArray[np.float64]

FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
BLACK = {"type": "lambertian", "color": [0.0, 0.0, 0.0]}
MATERIALS = {"floor": MATTE, "black": BLACK, "lamp": lamp(2.0), "glass": glass(1.5)}
ASIDE = {"position": [-2, 1, 0], "look_at": [0, 0, 0], "fov": 0.01}  # all pixels see one point
SAMPLERS = ("independent", "sobol")
TURN = np.linalg.qr([[0.3, -0.7, 0.5], [0.8, 0.2, -0.4], [-0.1, 0.6, 0.9]])[0]


# --- shade ---------------------------------------------------------------------------------


@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize(("s2", "cosine"), [(0.25, 1.0), (0.25, 0.1), (0.25, -0.3), (0.81, 0.5)])
def test_black_ball_over_a_floor_takes_its_share_of_the_sky(
    context: Context, s2: float, cosine: float, sampler: str
) -> None:
    """A white sky brings a; the ball hides its form factor F of it: a (1 - F)."""
    place = [math.sqrt(1 - cosine**2), cosine, 0]
    scene = scene_of(
        [FLOOR, sphere(place, math.sqrt(s2), "black")],
        MATERIALS,
        ASIDE,
        background={"color": [1, 1, 1]},
    )
    image = rendered(scene, context, 1024, bounces=1, width=32, height=32, sampler=sampler)
    assert_mean(whole(image), 0.5 * (1 - sphere_form_factor(s2, cosine)), within=0.006)


@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("method", METHODS)
def test_ball_before_a_lamp_takes_its_share_of_the_light(
    context: Context, method: str, sampler: str
) -> None:
    """On the normal a ball's form factor is (r/d)^2, so a ring of the lamp is left: s2 - t2."""
    lamp_ball, shade = sphere([0, 2, 0], 1.0, "lamp"), sphere([0, 0.5, 0], 0.15, "black")
    scene = scene_of([FLOOR, lamp_ball, shade], MATERIALS, {**ASIDE, "position": [-2, 0.2, 0]})
    samples = 1024 if method == "naive" else 256
    settings = {"method": method, "sampler": sampler, "width": 32, "height": 32}
    image = rendered(scene, context, samples, bounces=1, **settings)
    assert_mean(whole(image), 1 / 4 - 0.09, within=0.02)


# --- polygons ------------------------------------------------------------------------------


def polygon_form_factor(corners: Floats) -> float:
    """The form factor of a polygon seen from the origin, whose normal is +y (Lambert 1760).

    Each edge brings its angle times the cosine between the normal of its triangle with the origin
    and the receiver's; the part below the horizon is cut off first.
    """
    above = clipped(corners)
    if len(above) < 3:
        return 0.0
    unit = above / np.linalg.norm(above, axis=1, keepdims=True)
    after = np.roll(unit, -1, axis=0)
    across = np.cross(unit, after)
    sine = np.linalg.norm(across, axis=1)
    angle = np.arctan2(sine, (unit * after).sum(axis=1))
    edges = np.divide(across[:, 1], sine, out=np.zeros_like(sine), where=sine > 0)
    return float(abs((angle * edges).sum()) / (2 * math.pi))


def clipped(corners: Floats) -> Floats:
    """The part of a polygon with y >= 0 (Sutherland and Hodgman)."""
    kept = []
    for here, after in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if here[1] >= 0:
            kept.append(here)
        if here[1] * after[1] < 0:
            kept.append(here + (after - here) * here[1] / (here[1] - after[1]))
    return np.array(kept).reshape(-1, 3)


def test_polygons_have_the_form_factor_of_the_literature() -> None:
    """A rectangle 1.3 x 0.7 over its corner has 0.125443; a wall loses what is below."""
    panel = np.array([[0, 1, 0], [1.3, 1, 0], [1.3, 1, 0.7], [0, 1, 0.7]])
    assert polygon_form_factor(panel) == pytest.approx(0.125443, abs=1e-6)
    wall = np.array([[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]])
    upper = np.array([[1, 0, -1], [1, 1, -1], [1, 1, 1], [1, 0, 1]])
    assert polygon_form_factor(wall) == pytest.approx(polygon_form_factor(upper), abs=1e-12)


PANELS = {
    "above": ([0.3, 0.9, -0.4], [0.8, 0.3, 0.1], [-0.2, 0.4, 0.9]),
    "standing half below the horizon": ([0.9, -0.6, -0.5], [0.1, 1.2, 0], [0, 0.2, 1.1]),
    "all but below": ([0.6, -0.9, -0.4], [0.1, 1.0, 0.1], [0.2, 0.0, 0.9]),
    "thin": ([-0.5, 0.7, 0.2], [1.0, 0.1, 0], [0.0, 0.003, 0.01]),
}


@pytest.mark.parametrize("method", ["nee", "mis"])
@pytest.mark.parametrize("panel", PANELS)
def test_tilted_panel_lights_a_floor_down_to_its_horizon(
    context: Context, panel: str, method: str
) -> None:
    """Albedo 1/2 under radiance 2: the point shines with the form factor of Lambert's formula."""
    corner, u, v = (np.array(edge, float) for edge in PANELS[panel])
    truth = polygon_form_factor(np.array([corner, corner + u, corner + u + v, corner + v]))
    scene = scene_of([FLOOR, quad(corner, u, v, "lamp")], MATERIALS, ASIDE)
    image = rendered(scene, context, 512, method=method, bounces=1, width=32, height=32)
    assert_mean(whole(image), truth, within=0.04)


@pytest.mark.parametrize("method", ["nee", "mis"])
@pytest.mark.parametrize("distance", [1.0, 1e3, 1e6])
def test_light_of_a_small_panel_falls_with_the_square_of_its_distance(
    context: Context, distance: float, method: str
) -> None:
    """A square of side s at the height d: F -> s^2 / (pi d^2), within (s/d)^2 of it."""
    side = 2.0**-10
    panel = quad([-side / 2, distance, -side / 2], [side, 0, 0], [0, 0, side], "lamp")
    scene = scene_of([FLOOR, panel], MATERIALS, ASIDE)
    image = rendered(scene, context, 64, method=method, bounces=1)
    assert np.allclose(whole(image).mean, side**2 / (math.pi * distance**2), rtol=1e-5)


# --- glass ---------------------------------------------------------------------------------


@pytest.mark.parametrize("ior", [1.5, 0.7])
@pytest.mark.parametrize("cosine", [0.9, 0.6, 0.2])
def test_glass_slab_shows_both_skies(context: Context, cosine: float, ior: float) -> None:
    """Light leaves a slab as it came: R of the sky above, 1 - R of the sky below.

    R = 2F / (1 + F) sums the reflections between its faces. For n = 0.7 and cosines below 0.71 the
    slab reflects everything (sin > n).
    """
    slab = [plane([0, 0, 0], [0, 1, 0], "glass"), plane([0, -1, 0], [0, -1, 0], "glass")]
    sine = math.sqrt(1 - cosine**2)
    eye = {"position": [-2 * sine, 2 * cosine, 0], "look_at": [0, 0, 0], "fov": 0.01}
    sky = {"bottom": [1.0, 0.9, 0.2], "top": [0.3, 0.7, 1.4]}
    scene = scene_of(slab, {"glass": glass(ior)}, eye, background=sky)
    image = rendered(scene, context, 512, width=32, height=32, bounces=60, roulette=False)
    f = fresnel(cosine, ior)
    share = 2 * f / (1 + f)
    bottom, top = np.array(sky["bottom"]), np.array(sky["top"])
    up, down = (0.5 * (bottom + top + y * (top - bottom)) for y in (cosine, -cosine))
    assert_mean(whole(image), share * up + (1 - share) * down, within=0.02, floor=1e-5)


def fresnel(cosine: float, ior: float) -> float:
    """Unpolarised light, by the angles: 1/2 (sin^2(i-t)/sin^2(i+t) + tan^2(i-t)/tan^2(i+t))."""
    outer = math.acos(cosine)
    if math.sin(outer) >= ior:
        return 1.0
    inner = math.asin(math.sin(outer) / ior)
    less, more = outer - inner, outer + inner
    rs, rp = math.sin(less) / math.sin(more), math.tan(less) / math.tan(more)
    return 0.5 * (rs**2 + rp**2)


@pytest.mark.parametrize("roulette", [False, True])
def test_glass_slab_vanishes_under_a_white_sky(context: Context, roulette: bool) -> None:
    """R + T = 1 at every angle, with the floor of the slab 1e-6 below its face as well."""
    for thickness in (1.0, 1e-6):
        faces = [
            plane([0, 0, 0], [0, 1, 0], "glass"),
            plane([0, -thickness, 0], [0, -1, 0], "glass"),
        ]
        eye = {"position": [0, 1, 0], "look_at": [1, 0.7, 0], "fov": 100}
        sky = {"color": [1, 1, 1]}
        scene = scene_of(faces, {"glass": glass(1.5)}, eye, background=sky)
        image = rendered(scene, context, 16, bounces=1000, roulette=roulette)
        assert np.abs(image.radiance - 1).max() <= 1e-6


# --- the picture ---------------------------------------------------------------------------


def test_pixel_shows_how_much_of_it_is_covered(context: Context) -> None:
    """A lamp ends 3.25 pixels from the left of a frame of 5 x 5: columns 1, 1, 1, 1/4, 0."""
    unit = 2 / 5  # of a pixel on the plane in distance 1, at 90 degrees
    edge = -1 + 3.25 * unit
    panel = quad([-9, -9, -1], [9 + edge, 0, 0], [0, 18, 0], "lamp")
    scene = scene_of([panel], MATERIALS, {"fov": 90})
    image = rendered(scene, context, 4096, width=5, height=5)
    assert (image.radiance[:, :3] == 2).all()
    assert (image.radiance[:, 4] == 0).all()
    spread = math.sqrt(0.25 * 0.75 / (5 * 4096)) * 2
    column = image.radiance[:, 3].mean(axis=0)
    assert_mean(Estimate(column, np.full(3, spread)), 0.5, within=0.07)


@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize(("angle", "width"), [(25.0, 64), (40.0, 32)])
def test_lamp_next_to_the_axis_is_seen_as_an_ellipse(
    context: Context, angle: float, width: int, sampler: str
) -> None:
    """The cone of half angle s about an axis tilted by p cuts the plane at distance 1 in an
    ellipse of half axes sin s cos s / (cos^2 p - sin^2 s) and sin s / sqrt(cos^2 p - sin^2 s).
    """
    tilt, sine = math.radians(angle), 0.2
    place = [5 * math.sin(tilt) * 0.6, 5 * math.sin(tilt) * 0.8, -5 * math.cos(tilt)]
    scene = scene_of([sphere(place, 1.0, "lamp")], MATERIALS, {"fov": 120})
    image = rendered(scene, context, 256, width=width, height=64, sampler=sampler)
    rest = math.cos(tilt) ** 2 - sine**2
    ellipse = math.pi * sine * math.sqrt(1 - sine**2) / rest * sine / math.sqrt(rest)
    half = math.tan(math.radians(60))
    assert_mean(whole(image), 2 * ellipse / (4 * half**2 * width / 64), within=0.03)


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_turned_scene_shows_the_same_picture(context: Context, method: str) -> None:
    """Turned with its camera about axes that are no coordinate axes; the sky is even."""
    straight, tilted = (
        rendered(turned(turn), context, 128, seed=seed, method=method, width=32, height=32)
        for seed, turn in enumerate([np.eye(3), TURN])
    )
    assert_agree(straight, tilted, within=0.05)


def turned(turn: Floats) -> Scene:
    """A floor, a glass and a metal ball, and lamps of both kinds under an even sky."""

    def at(*point: float) -> list[float]:
        return [float(c) for c in turn @ np.array(point, float)]

    materials = {
        **MATERIALS,
        "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.6},
    }
    objects = [
        plane(at(0, -1, 0), at(0, 1, 0), "floor"),
        sphere(at(-0.6, -0.4, 0), 0.6, "glass"),
        sphere(at(0.8, -0.5, 0.3), 0.5, "brass"),
        sphere(at(0.2, 0.9, 0.2), 0.3, "lamp"),
        quad(at(-2, 2, -2), at(4, 0, 0), at(0, 0, 2), "lamp"),
    ]
    eye = {"position": at(0.1, 0.2, 3), "look_at": at(0, 0, 0), "up": at(0, 1, 0)}
    sky = {"color": [0.4, 0.5, 0.6]}
    return scene_of(objects, materials, eye, background=sky, render={"bounces": 6})
