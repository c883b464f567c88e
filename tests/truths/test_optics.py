"""Mirrors, glass and lenses against closed forms, ray by ray or over whole pixels."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from tests.support.alarms import ALPHA, book
from tests.support.builders import glass, lamp, plane, quad, scene_of, sphere
from tests.support.renders import Estimate, assert_mean, rendered, rendering, whole
from tests.support.z_scores import z_test

Floats = NDArray[np.float64]

LAMP = {"lamp": lamp(2.0)}
SKY = {"bottom": [1.0, 0.9, 0.2], "top": [0.3, 0.7, 1.4]}
FLAT, STEEP = (np.array(SKY["bottom"]) + SKY["top"]) / 2, (np.array(SKY["top"]) - SKY["bottom"]) / 2


def test_mirror_ball_shows_the_sky_where_each_pixel_reflects(context: Context) -> None:
    """The truth is each pixel's mean and variance over 8 x 8 rays in float64."""
    size, sub, samples, color = 32, 8, 64, np.array([0.9, 0.8, 0.5])
    steel = {"type": "metal", "color": list(color), "roughness": 0}
    scene = scene_of(
        [sphere([0.2, -0.1, -3], 1, "steel")], {"steel": steel}, {"fov": 50}, background=SKY
    )
    sight = directions(size * sub, 50)
    inside, normal = ball_normals(sight, np.array([0.2, -0.1, -3.0]))
    mirrored = sight - 2 * np.sum(sight * normal, axis=-1, keepdims=True) * normal
    colors = color * (FLAT + STEEP * mirrored[..., 1:2])
    pixels = colors.reshape(size, sub, size, sub, 3).swapaxes(1, 2).reshape(size, size, -1, 3)
    whole_pixels = inside.reshape(size, sub, size, sub).all(axis=(1, 3))
    image = rendered(scene, context, samples, width=size, height=size)
    stderr = pixels.std(axis=2)[whole_pixels] / math.sqrt(samples)
    truth = pixels.mean(axis=2)[whole_pixels]
    book()
    verdict = z_test(image.radiance[whole_pixels], stderr, truth, ALPHA, floor=1e-5)
    assert verdict, verdict
    assert whole_pixels.sum() > 400
    assert np.median(stderr) < 2e-3


def directions(size: int, fov: float) -> Floats:
    """Unit directions through the centres of size x size pixels, looking along -z; (H, W, 3)."""
    steps = (2 * (np.arange(size) + 0.5) / size - 1) * math.tan(math.radians(fov) / 2)
    x, y = np.meshgrid(steps, -steps)
    rays = np.stack([x, y, -np.ones_like(x)], axis=-1)
    unit: Floats = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    return unit


def ball_normals(sight: Floats, center: Floats) -> tuple[NDArray[np.bool_], Floats]:
    """Where rays from the origin meet the unit ball, and its normals there."""
    along = sight @ center
    inside = 1 - center @ center + along**2
    distance = along - np.sqrt(np.maximum(inside, 0))
    return inside > 0, distance[..., None] * sight - center


@pytest.mark.parametrize("bounces", [1, 2, 3, 5, 60])
@pytest.mark.parametrize("impact", [0.2, 0.6, 0.9, 0.99])
def test_glass_ball_bends_the_sky(context: Context, impact: float, bounces: int) -> None:
    """Along d, passing the centre at `impact` towards e: A p + B y.(X e + Z d)."""
    d, e = np.array([0.0, -0.6, -0.8]), np.array([0.0, 0.8, -0.6])
    position = impact * e - 4 * d
    eye = {"position": list(position), "look_at": list(position + d), "fov": 0.01}
    ball = sphere([0, 0, 0], 1, "glass")
    scene = scene_of([ball], {"glass": glass(1.5)}, eye, background=SKY)
    image = rendered(scene, context, 512, width=32, height=32, bounces=bounces, roulette=False)
    share, x, z = glass_ball(impact, 1.5, bounces + 1)
    truth = FLAT * share + STEEP * (x * e[1] + z * d[1])
    assert_mean(whole(image), truth, within=0.02 if bounces > 1 else 0.1, floor=1e-6)


def glass_ball(impact: float, ior: float, segments: int) -> tuple[float, float, float]:
    """Share of the light that leaves within so many segments, and its direction in (e, d)."""
    outer, inner = math.asin(impact), math.asin(impact / ior)
    rs = math.sin(outer - inner) / math.sin(outer + inner)
    rp = math.tan(outer - inner) / math.tan(outer + inner)
    f = (rs**2 + rp**2) / 2
    x, z = f * math.sin(math.pi - 2 * outer), f * math.cos(math.pi - 2 * outer)
    share = f
    for j in range(segments - 2):
        turn = 2 * (outer - inner) + j * (math.pi - 2 * inner)
        weight = (1 - f) ** 2 * f**j
        x, z, share = x - weight * math.sin(turn), z + weight * math.cos(turn), share + weight
    return share, x, z


def test_glass_ball_turns_rays_as_in_the_literature() -> None:
    expected = {0.2: -0.112897, 0.6: -0.379477, 0.9: -0.569492, 0.99: -0.117247}
    for impact, x in expected.items():
        assert glass_ball(impact, 1.5, 200)[1] == pytest.approx(x, abs=1e-6)


@pytest.mark.parametrize("ior", [1.5, 0.5])
def test_glass_slab_reflects_as_an_incoherent_stack(context: Context, ior: float) -> None:
    """White above, black below, seen from straight above: R = 2F / (1 + F)."""
    slab = [plane([0, 0, 0], [0, 1, 0], "glass"), plane([0, -1, 0], [0, -1, 0], "glass")]
    eye = {"position": [0, 2, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
    sky = {"bottom": [0, 0, 0], "top": [1, 1, 1]}
    scene = scene_of(slab, {"glass": glass(ior)}, eye, background=sky)
    image = rendered(scene, context, 1024, width=32, height=32, bounces=60)
    f = ((ior - 1) / (ior + 1)) ** 2
    assert_mean(whole(image), 2 * f / (1 + f), within=0.02)


def test_glass_below_squeezes_the_light_of_its_depths(context: Context) -> None:
    """Radiance 1 inside glass leaves it as (1 - F) / n^2."""
    eye = {"position": [0, 2, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
    sea = [plane([0, 0, 0], [0, 1, 0], "glass")]
    sky = {"bottom": [1, 1, 1], "top": [0, 0, 0]}
    scene = scene_of(sea, {"glass": glass(1.5)}, eye, background=sky)
    image = rendered(scene, context, 64, bounces=1)
    assert_mean(whole(image), 0.96 / 2.25, within=0.01)


@pytest.mark.parametrize(("width", "height"), [(64, 64), (64, 24), (32, 64)])
def test_lamp_fills_its_solid_angle(context: Context, width: int, height: int) -> None:
    scene = scene_of([sphere([0, 0, -4], 1, "lamp")], LAMP, {"fov": 90})
    image = rendered(scene, context, 256, width=width, height=height)
    radius = math.tan(math.asin(1 / 4))
    truth = 2 * math.pi * radius**2 / 4 * height / width
    assert_mean(whole(image), truth, within=0.02)
    if width == height:
        assert truth == pytest.approx(2 * 0.052360, abs=1e-5)


@pytest.mark.parametrize(("depth", "radius"), [(3.5, 0.042857), (2.0, 0.0), (1.25, 0.06)])
def test_point_out_of_focus_becomes_a_disk(context: Context, depth: float, radius: float) -> None:
    """Radius A |z - f| / z on the plane in focus; its second moment is the half of its square."""
    aperture, focus, size, samples, spot = 0.1, 2.0, 64, 256, 0.01
    scale = 0.08 / (size / 2)  # scene units a pixel, on the plane in focus
    camera = {
        "fov": 2 * math.degrees(math.atan(0.08 / focus)),
        "focus_distance": focus,
        "defocus_angle": 2 * math.degrees(math.atan(aperture / focus)),
    }
    scene = scene_of([sphere([0, 0, -depth], spot, "lamp")], LAMP, camera)
    image = rendered(scene, context, samples, width=size, height=size)
    light = image.radiance[..., 0].astype(np.float64)
    rows, columns = np.mgrid[:size, :size] - (size - 1) / 2
    moment = (light * (rows**2 + columns**2)).sum() / light.sum() * scale**2
    own = spot * focus / depth  # the spot is a disk as well; a pixel is a square
    truth = (radius**2 + own**2) / 2 + scale**2 / 6
    hits = light.sum() * samples / 2
    spread = truth / math.sqrt(3 * hits)  # of the mean of r^2 over a disk: R^2 / sqrt(12 n)
    assert_mean(
        Estimate(np.array([moment]), np.array([spread])), truth, within=0.06, floor=0.003 * truth
    )


def test_aperture_leaves_the_plane_in_focus_sharp(context: Context) -> None:
    panel = quad([-0.5, -0.5, -2], [1, 0, 0], [0, 1, 0], "lamp")
    camera = {"fov": 90, "focus_distance": 2.0}
    settings = {"width": 32, "height": 32}
    with rendering(scene_of([panel], LAMP, camera), context, **settings) as renderer:
        pinhole = renderer.render(16).image().radiance
        wide = scene_of([panel], LAMP, {**camera, "defocus_angle": 40.0})
        renderer.update(wide)
        lens = renderer.render(16).image().radiance
    assert (pinhole == lens).all()
    assert pinhole.min() == 0
    assert pinhole.max() == 2
