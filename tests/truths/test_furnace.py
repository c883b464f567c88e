"""Rooms and skies in which every path brings the same: what is lost or counted twice shows."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import (
    box_of_quads,
    glass,
    lamp,
    plane,
    room_of_planes,
    scene_of,
    sphere,
)
from tests.support.renders import (
    METHODS,
    Estimate,
    assert_mean,
    rendered,
    rendering,
    whole,
)

Objects = list[dict[str, Any]]

HALF = {"glow": lamp(1.0, 0.5)}  # emits 1 and reflects half
OFF_CENTER = {"position": [0.31, -0.17, 0.23], "look_at": [-0.6, 0.5, -1.0], "fov": 90}
BALL = [sphere([-0.3, 0.2, -0.35], 0.37, "glow")]
BOX = box_of_quads("glow")
ROOMS: dict[str, Objects] = {
    "sphere": [sphere([0, 0, 0], 1, "glow")],
    "planes": room_of_planes("glow"),
}
WHITE_SKY = {"color": [1.0, 1.0, 1.0]}
LENS = {"defocus_angle": 20.0, "focus_distance": 0.7}


def furnace(objects: Objects, camera: dict[str, Any] | None = None) -> Scene:
    """Everything glows; the camera stands off the centre."""
    return scene_of(objects, HALF, {**OFF_CENTER, **(camera or {})})


def under_white_sky(material: dict[str, Any], distance: float = 3.0) -> Scene:
    """A unit ball before a sky of radiance 1."""
    ball = [sphere([0, 0, -distance], 1, "ball")]
    return scene_of(ball, {"ball": material}, {"fov": 50}, background=WHITE_SKY)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("room", ROOMS)
def test_partial_sums_are_exact_at_every_pixel(context: Context, room: str, method: str) -> None:
    with rendering(furnace(ROOMS[room]), context, roulette=False, method=method) as renderer:
        for bounces in range(9):
            renderer.update(bounces=bounces)
            image = renderer.render(5).image()
            assert (image.radiance == 2 - 2.0**-bounces).all(), bounces
            assert (image.stderr == 0).all()


@pytest.mark.parametrize(
    "objects",
    [BOX, BOX + BALL, ROOMS["sphere"] + BALL, ROOMS["planes"] + BALL],
    ids=["box", "box and ball", "sphere and ball", "planes and ball"],
)
def test_scattering_alone_keeps_the_sum_in_any_room(context: Context, objects: Objects) -> None:
    with rendering(furnace(objects), context, roulette=False, method="naive") as renderer:
        for bounces in range(9):
            renderer.update(bounces=bounces)
            assert (renderer.render(5).image().radiance == 2 - 2.0**-bounces).all(), bounces


@pytest.mark.slow_cases("sphere-nee")
@pytest.mark.parametrize("method", ["nee", "mis"])
@pytest.mark.parametrize("room", ROOMS)
def test_sampled_ball_keeps_the_sum_of_its_room(context: Context, room: str, method: str) -> None:
    """Counting the ball twice, or the wall that has no density not at all, is off by > 5 %."""
    scene = furnace(ROOMS[room] + BALL)
    with rendering(scene, context, roulette=False, method=method) as renderer:
        for bounces in (1, 2, 4, 8):
            renderer.update(bounces=bounces)
            mean = whole(renderer.render(256).image())
            assert_mean(mean, 2 - 2.0**-bounces, within=0.01)


@pytest.mark.slow
def test_light_sampling_counts_a_wall_once(context: Context) -> None:
    """The middle of a wall: near its edges light sampling alone has no finite variance."""
    scene = furnace(BOX, {"position": [0.1, 0.2, 0.3], "look_at": [0.1, 0.2, -1], "fov": 20})
    with rendering(scene, context, roulette=False, method="nee") as renderer:
        renderer.update(bounces=0)
        assert (renderer.render(1).image().radiance == 1).all()
        renderer.update(bounces=1)
        assert_mean(whole(renderer.render(512).image()), 1.5, within=0.005)


@pytest.mark.slow
def test_both_weighted_count_a_box_of_lamps_once(context: Context) -> None:
    with rendering(furnace(BOX), context, roulette=False, method="mis") as renderer:
        for bounces in (1, 2, 4, 8):
            renderer.update(bounces=bounces)
            mean = whole(renderer.render(256).image())
            assert_mean(mean, 2 - 2.0**-bounces, within=0.005)


@pytest.mark.parametrize(
    "material",
    [
        {"type": "lambertian", "color": [1, 1, 1]},
        {"type": "metal", "color": [1, 1, 1], "roughness": 0},
    ],
    ids=["matte", "mirror"],
)
def test_white_ball_vanishes_under_a_white_sky(context: Context, material: dict[str, Any]) -> None:
    image = rendered(under_white_sky(material), context, 4, roulette=False, width=64, height=64)
    assert (image.radiance == 1).all()


@pytest.mark.parametrize("roulette", [False, True])
@pytest.mark.parametrize("ior", [0.5, 0.667, 1.0, 1 + 1e-6, 1.5, 4.0])
def test_glass_vanishes_under_a_white_sky(context: Context, ior: float, roulette: bool) -> None:
    """At 100 bounces the light still trapped in the ball is below 1e-6 of all."""
    settings = {"bounces": 100, "roulette": roulette, "width": 64, "height": 64}
    image = rendered(under_white_sky(glass(ior)), context, 4, **settings)
    assert np.abs(image.radiance - 1).max() <= 1e-6


@pytest.mark.parametrize("roughness", [0.05, 0.3, 0.6, 1.0])
def test_rough_metal_reflects_no_more_than_it_receives(context: Context, roughness: float) -> None:
    metal = {"type": "metal", "color": [1, 1, 1], "roughness": roughness}
    settings = {"width": 32, "height": 32, "roulette": False}
    image = rendered(under_white_sky(metal), context, 64, **settings)
    assert (image.radiance <= 1 + 1e-6).all()


@pytest.mark.parametrize("roughness", [5e-324, 1e-12, 9.9e-5])
def test_metal_smoother_than_a_float_can_report_is_a_mirror(
    context: Context, roughness: float
) -> None:
    """Its alpha squared may be 0 in float32: 0 / 0 in the density of GGX."""
    pictures = []
    for value in (0.0, roughness):
        room = scene_of(
            [sphere([0, 0, 0], 1, "metal"), sphere([0, 0.5, 0], 0.25, "lamp")],
            {"metal": {"type": "metal", "color": [1, 1, 0], "roughness": value}, "lamp": lamp()},
            render={"width": 16, "height": 16},
        )
        pictures.append(rendered(room, context, 4).radiance)
    assert (pictures[1] == pictures[0]).all()


@pytest.mark.parametrize("method", METHODS)
def test_the_smoothest_rough_metal_is_as_bright_as_a_mirror(context: Context, method: str) -> None:
    metal = {"type": "metal", "color": [1, 1, 1], "roughness": 1.01e-4}
    settings = {"width": 32, "height": 32, "method": method}
    image = rendered(under_white_sky(metal), context, 16, **settings)
    assert image.radiance == pytest.approx(1.0, rel=1e-5)


def test_glass_holds_back_what_the_bounce_limit_cuts_off(context: Context) -> None:
    """D = bounces + 1 segments leave 1 - (1 - F) F^(D-2), at an impact of 0.6 radii."""
    reflectance = fresnel_at_impact(0.6, 1.5)
    assert reflectance == pytest.approx(0.043895, abs=1e-6)
    ball = [sphere([0, 0, 0], 1, "glass")]
    eye = {"position": [0.6, 0, 4], "look_at": [0.6, 0, 0], "fov": 0.01}
    scene = scene_of(ball, {"glass": glass(1.5)}, eye, background=WHITE_SKY)
    with rendering(scene, context, roulette=False, width=64, height=64) as renderer:
        renderer.update(bounces=0)
        assert (renderer.render(2).image().radiance == 0).all()
        for segments in (2, 3, 4):
            renderer.update(bounces=segments - 1)
            samples = 64
            mean = whole(renderer.render(samples).image()).mean
            truth = 1 - (1 - reflectance) * reflectance ** (segments - 2)
            spread = np.sqrt(truth * (1 - truth) / (64 * 64 * samples))
            assert_mean(Estimate(mean, np.full(3, spread)), truth, within=0.07)


def fresnel_at_impact(impact: float, ior: float) -> float:
    """Reflectance of a ball for a ray that passes its centre at `impact` radii."""
    cos_i, cos_t = np.sqrt(1 - impact**2), np.sqrt(1 - (impact / ior) ** 2)
    rs = (cos_i - ior * cos_t) / (cos_i + ior * cos_t)
    rp = (ior * cos_i - cos_t) / (ior * cos_i + cos_t)
    return float(0.5 * (rs**2 + rp**2))


def test_glass_of_index_one_is_not_there(context: Context) -> None:
    materials = {"glass": glass(1.0), "red": {"type": "light", "emission": [3, 1, 0.5]}}
    lamps = [sphere([0.9, 0.3, -5], 0.6, "red"), sphere([-0.5, -0.2, -2.9], 0.2, "red")]
    sky = {"bottom": [0.1, 0.2, 0.3], "top": [0.9, 0.7, 0.4]}
    balls = [sphere([0, 0, -3], 1, "glass"), sphere([-0.4, -0.2, -3], 0.5, "glass")]
    settings = {"width": 64, "height": 64, "roulette": False, "method": "naive"}
    without = rendered(scene_of(lamps, materials, background=sky), context, 1, **settings)
    there = rendered(scene_of(lamps + balls, materials, background=sky), context, 1, **settings)
    assert len(np.unique(without.radiance[..., 0])) > 100
    assert np.abs(there.radiance - without.radiance).max() <= 1e-6


@pytest.mark.parametrize("roulette", [False, True])
def test_camera_in_glass_sees_the_square_of_the_index(context: Context, roulette: bool) -> None:
    """Half a radius off the centre no ray is caught: 1/2 < 1/1.5."""
    scene = scene_of(
        [sphere([0.3, 0.4, 0], 1, "glass")], {"glass": glass(1.5)}, background=WHITE_SKY
    )
    settings = {"bounces": 100, "roulette": roulette, "width": 64, "height": 64}
    image = rendered(scene, context, 4, **settings)
    assert np.allclose(image.radiance, 2.25, rtol=1e-6, atol=0)


@pytest.mark.slow_cases("naive-independent", "naive-sobol")
@pytest.mark.parametrize("sampler", ["independent", "sobol"])
@pytest.mark.parametrize("method", METHODS)
def test_lamp_in_the_centre_of_a_matte_ball(context: Context, method: str, sampler: str) -> None:
    """Radii 0.7 and 2: after 1, 2, 3 and 6 scatterings, and without end."""
    materials = {
        "wall": {"type": "lambertian", "color": [0.6] * 3},
        "lamp": lamp(3.0, 0.5),
    }
    objects = [sphere([0, 0, 0], 2, "wall"), sphere([0, 0, 0], 0.7, "lamp")]
    eye = {"position": [0.2, 0.1, 1.2], "look_at": [0.5, 1, 3], "fov": 60}
    truths = {1: 0.22050, 2: 0.33659, 3: 0.40582, 6: 0.48464, 60: 0.50487}
    settings = {"method": method, "sampler": sampler, "width": 32, "height": 32}
    with rendering(scene_of(objects, materials, eye), context, **settings) as renderer:
        for bounces, truth in truths.items():
            renderer.update(bounces=bounces)
            image = renderer.render(1024 if method == "naive" else 128).image()
            assert_mean(whole(image), truth, within=0.02, floor=1e-5 * truth)


def test_two_planes_exchange_light_by_the_series_of_their_albedos(context: Context) -> None:
    r1, r2 = np.array([0.9, 0.5, 0.1]), np.array([0.8, 0.7, 0.6])
    materials = {
        "lower": {"type": "light", "emission": [1, 2, 3], "color": list(r1)},
        "upper": {"type": "lambertian", "color": list(r2)},
    }
    objects = [plane([0, -1, 0], [0, 1, 0], "lower"), plane([0, 1, 0], [0, -1, 0], "upper")]
    eye = {"look_at": [1, 0.4, 0], "fov": 100}  # some rays are all but parallel to the planes
    scene = scene_of(objects, materials, eye)
    with rendering(scene, context, roulette=False, width=64, height=64) as renderer:
        for bounces in (0, 1, 2, 3, 5, 200):
            renderer.update(bounces=bounces)
            picture = renderer.render(3).image().radiance
            upper, lower = picture[0, 0], picture[-1, 0]
            emitted = np.array([1, 2, 3])
            assert np.allclose(upper, emitted * r2 * series(r1 * r2, (bounces + 1) // 2), rtol=1e-6)
            assert np.allclose(lower, emitted * series(r1 * r2, bounces // 2 + 1), rtol=1e-6)
            is_upper = (picture == upper).all(axis=2)
            is_lower = (picture == lower).all(axis=2)
            rows_of_the_horizon = ~(is_upper | is_lower).all(axis=1)
            assert rows_of_the_horizon.sum() <= 1


def series(ratio: np.ndarray[Any, Any], terms: int) -> np.ndarray[Any, Any]:
    """1 + q + ... + q^(terms - 1)."""
    total: np.ndarray[Any, Any] = (1 - ratio**terms) / (1 - ratio)
    return total


@pytest.mark.slow_cases("sphere-nee")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("room", ROOMS)
def test_lens_changes_nothing_before_a_constant_wall(
    context: Context, room: str, method: str
) -> None:
    scene = furnace(ROOMS[room], {**LENS, "position": [0.1, 0.05, 0.1]})
    image = rendered(scene, context, 8, bounces=4, roulette=False, method=method)
    assert (image.radiance == 2 - 2.0**-4).all()


@pytest.mark.parametrize("defocus_angle", [0.0, 5.0, 60.0])
def test_lens_darkens_no_sky(context: Context, defocus_angle: float) -> None:
    camera = {"defocus_angle": defocus_angle, "focus_distance": 2.0}
    ball = [sphere([0, 0, -3], 1, "white")]
    white = {"type": "lambertian", "color": [1, 1, 1]}
    scene = scene_of(ball, {"white": white}, camera, background=WHITE_SKY)
    assert (rendered(scene, context, 8, roulette=False).radiance == 1).all()
