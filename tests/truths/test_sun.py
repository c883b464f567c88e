"""The sun: a disc at infinity, against closed forms."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.omissions import omissions
from glrt.scene.lights.sun import Sun
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Settings
from tests.support.builders import MATTE, glass, lamp, plane, quad, scene_of, sphere
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole

FLOOR = plane([0, 0, 0], [0, 1, 0], "m")
ABOVE = {"position": [0, 1, 1], "look_at": [0, 0, 0], "fov": 10}
IRRADIANCE = np.array([3.0, 2.0, 1.0])
MIRROR = {"type": "metal", "color": [1.0, 1.0, 1.0]}


def sunny(*things: dict[str, Any], camera: Any = ABOVE, **sun: Any) -> Scene:
    """The scene under the sun alone, unless `background` is given."""
    more = {"background": sun.pop("background")} if "background" in sun else {}
    where = {} if "direction" in sun else {"elevation": 90.0}
    table = {**where, "irradiance": IRRADIANCE.tolist(), **sun}
    materials = {"m": MATTE, "mirror": MIRROR, "frost": glass(roughness=0.5), "lamp": lamp(2.0)}
    used = {thing["material"] for thing in things}
    named = {name: table for name, table in materials.items() if name in used}
    return scene_of(list(things), named, camera, sun=table, **more)


@pytest.mark.parametrize("method", ["nee", "mis"])
@pytest.mark.parametrize("elevation", [90.0, 30.0, 2.0])
def test_a_floor_receives_the_irradiance_times_the_sine(
    context: Context, method: str, elevation: float
) -> None:
    """The disc is small, and wholly above the horizon."""
    scene = sunny(FLOOR, elevation=elevation, azimuth=40.0)
    image = rendered(scene, context, 64, method=method, bounces=1)
    truth = IRRADIANCE * np.sin(np.radians(elevation)) * 0.5 / np.pi
    assert_mean(whole(image), truth, within=0.02, floor=1e-5)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("angle", [30.0, 90.0])
def test_a_wide_sun_gives_what_it_says(context: Context, method: str, angle: float) -> None:
    """Irradiance is that of a surface that faces the middle of the disc."""
    scene = sunny(FLOOR, angle=angle)
    image = rendered(scene, context, 1024, method=method, bounces=1)
    assert_mean(whole(image), IRRADIANCE * 0.5 / np.pi, within=0.05, floor=1e-5)


@pytest.mark.parametrize(
    ("where", "towards"),
    [
        ({"elevation": 0.0}, [0, 0, -1]),
        ({"elevation": 0.0, "azimuth": 90.0}, [1, 0, 0]),
        ({"elevation": 90.0, "azimuth": 33.0}, [0, 1, 0]),
        ({"elevation": 30.0, "azimuth": 180.0}, [0, 0.5, 0.75**0.5]),
        ({"direction": [0, -2, 0]}, [0, -1, 0]),
    ],
)
def test_the_sun_stands_where_it_is_said_to(where: dict[str, Any], towards: list[float]) -> None:
    sun = Sun(**where, irradiance=(1, 1, 1))
    assert_allclose(sun.towards, towards, atol=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_camera_and_a_mirror_see_the_disc(context: Context, method: str) -> None:
    """All pixels of a small field of view see it, to rounding; none do next to the sun."""
    up = {"position": [0, 1, 0], "look_at": [0, 2, 0], "up": [0, 0, 1], "fov": 0.3}
    radiance = IRRADIANCE / (np.pi * np.sin(np.radians(0.265)) ** 2)
    direct = rendered(sunny(camera=up), context, 4, method=method).radiance
    assert_allclose(direct, np.broadcast_to(radiance, direct.shape), rtol=1e-6)
    down = {**up, "look_at": [0, 0, 0]}
    plate = plane([0, 0, 0], [0, 1, 0], "mirror")
    mirrored = rendered(sunny(plate, camera=down), context, 4, method=method).radiance
    assert_allclose(mirrored, direct, rtol=1e-6)
    beside = sunny(camera=up, elevation=89.0)
    assert not rendered(beside, context, 4, method=method).radiance.any()


def test_the_disc_covers_its_solid_angle(context: Context) -> None:
    up = {"position": [0, 0, 0], "look_at": [0, 1, 0], "up": [0, 0, 1], "fov": 2.0}
    size = {"width": 64, "height": 64}
    image = rendered(sunny(camera=up, angle=1.0), context, 64, **size)
    disc = Sun(elevation=90, angle=1.0, irradiance=(3, 2, 1))
    covered = image.radiance[..., 0].mean() / disc.radiance((3, 2, 1))[0]
    half, edge = np.tan(np.radians([0.5, 1.0]))  # on the plane of the picture
    assert covered == pytest.approx(np.pi * half**2 / (2 * edge) ** 2, rel=0.01)


@pytest.mark.parametrize("method", METHODS)
def test_a_penumbra_is_as_wide_as_the_disc(context: Context, method: str) -> None:
    """Behind a half-plane at height 1: from 1 to 0 over 2 tan(angle / 2), by the disc's segment."""
    wall = quad([-50, 1, -50], [50, 0, 0], [0, 0, 100], "m")
    angle = 20.0
    reach = np.tan(np.radians(angle / 2))
    for x, share in ((-1.01 * reach, 0.0), (0.0, 0.5), (1.01 * reach, 1.0)):
        camera = {"position": [x, 0.5, 0], "look_at": [x, 0, 0], "up": [0, 0, 1], "fov": 0.1}
        scene = sunny(FLOOR, wall, camera=camera, angle=angle)
        image = rendered(scene, context, 2048, method=method, bounces=1)
        if share:
            assert_mean(whole(image), share * IRRADIANCE * 0.5 / np.pi, within=0.1, floor=1e-4)
        else:
            assert not image.radiance.any()


@pytest.mark.slow
def test_methods_agree_under_sun_and_sky_and_lamp(context: Context) -> None:
    things = [
        FLOOR,
        sphere([0, 0.3, 0], 0.3, "mirror"),
        sphere([0.7, 0.3, 0], 0.3, "frost"),
        sphere([-0.7, 0.7, 0], 0.2, "lamp"),
    ]
    sky = {"bottom": [0.1] * 3, "top": [0.6] * 3}
    camera = {**ABOVE, "fov": 60}
    scene = sunny(*things, camera=camera, elevation=50.0, angle=20.0, background=sky)
    naive, nee, mis = (
        rendered(scene, context, 2048, method=method, seed=seed, bounces=4)
        for seed, method in enumerate(METHODS)
    )
    assert_agree(nee, naive, within=0.1)
    assert_agree(mis, naive, within=0.1)


def test_the_group_sun_is_a_factor(context: Context) -> None:
    scene = sunny(FLOOR, sphere([0, 0.3, 0], 0.3, "m"))
    plain = rendered(scene, context, 16).radiance
    twice = rendered(with_lights(scene, {"sun": 2.0}), context, 16).radiance
    assert (2 * plain).tobytes() == twice.tobytes()
    assert not rendered(with_lights(scene, {"sun": 0.0}), context, 16).radiance.any()
    assert list(scene.light_groups) == ["sun", "background"]


@pytest.mark.slow
def test_all_ways_and_sizes_show_the_same_bits(context: Context) -> None:
    def picture(scale: float = 1.0, **way: Any) -> bytes:
        camera = {"position": [0, scale, scale], "look_at": [0, 0, 0], "fov": 40}
        ball = sphere([0, 0.3 * scale, 0], 0.3 * scale, "m")
        scene = sunny(FLOOR, ball, camera=camera, elevation=35.0, azimuth=20.0)
        return rendered(scene, context, 16, **way).radiance.tobytes()

    ways: list[dict[str, Any]] = [{}, {"pipeline": "fragment"}, {"tier": "complete"}]
    ways += [{"scale": 2.0**10}, {"scale": 2.0**-10}]
    assert len({picture(**way) for way in ways}) == 1


def test_a_scene_without_a_sun_asks_for_none() -> None:
    scene = scene_of([FLOOR], {"m": MATTE}, background={"color": [1, 1, 1]})
    needs = needs_of(SceneFacts(scene), Settings())
    assert not needs.has_sun
    assert not needs.sample_sun
    dark = with_lights(sunny(FLOOR), {"sun": 0.0})
    assert not needs_of(SceneFacts(dark), Settings()).has_sun
    assert "the sun lights nothing" in omissions(SceneFacts(sunny(FLOOR)), Settings(method="cook"))


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({}, "must stand in one place"),
        ({"elevation": 10, "direction": [0, 1, 0]}, "must stand in one place"),
        ({"direction": [0, 1, 0], "azimuth": 3}, "direction excludes azimuth"),
        ({"elevation": 91}, "elevation"),
        ({"elevation": 10, "angle": 0}, "angle"),
        ({"elevation": 10, "angle": 91}, "angle"),
        ({"elevation": 10, "irradiance": [1, 1, -1]}, "irradiance"),
        ({"elevation": 10, "colour": [1, 1, 1]}, "colour"),
    ],
)
def test_a_sun_that_cannot_be_is_refused(keys: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        scene_of([FLOOR], {"m": MATTE}, sun={"irradiance": [1, 1, 1], **keys})
