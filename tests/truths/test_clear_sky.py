"""A clear sky: its model, its unit, its ground and its sun."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.omissions import omissions
from glrt.plan.plan import prepare
from glrt.scene.lights.clear_sky import ClearSky, sky_pixels
from glrt.scene.lights.sun import Sun
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import decode_scene
from glrt.settings import Settings
from tests.support.builders import MATTE, plane, scene_of, sphere
from tests.support.numerics import Array
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole
from tests.support.sky_images import sky64
from tests.support.system_packages import needs_mitsuba

ROOT = Path(__file__).parents[2]
FLOOR = plane([0, 0, 0], [0, 1, 0], "m")
ABOVE = {"position": [0, 1, 1], "look_at": [0, 0, 0], "fov": 10}
LUX = 683.002 * 106.857  # of one unit
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def day(*things: dict[str, Any], **changes: Any) -> Scene:
    """A sky with its sun, and with what else `sky`, `sun` and `camera` say."""
    sky = {"turbidity": 3.0, **changes.get("sky", {})}
    sun = {"elevation": 40.0, "azimuth": 30.0, **changes.get("sun", {})}
    camera = changes.get("camera", ABOVE)
    used = {"m": MATTE} if things else {}
    return scene_of(list(things), used, camera, sun=sun, background={"sky": sky})


def upper(count: int, seed: int = 1) -> Array:
    """Directions above the horizon, each as likely."""
    random = np.random.default_rng(seed)
    height, azimuth = random.random(count), 2 * np.pi * random.random(count)
    flat = np.sqrt(1 - height**2)
    return np.stack([flat * np.sin(azimuth), height, -flat * np.cos(azimuth)], axis=-1)


def received(sky: ClearSky, towards: Array) -> Array:
    """Irradiance of a level surface by the sky alone: Gauss and Legendre's rule by the formula."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    height = (nodes + 1) / 2
    azimuth = 2 * np.pi * (np.arange(400) + 0.5) / 400
    flat = np.sqrt(1 - height**2)[:, None]
    parts = flat * np.sin(azimuth), height[:, None] + 0 * azimuth, -flat * np.cos(azimuth)
    radiance = sky.radiance(towards, np.stack(parts, axis=-1).reshape(-1, 3))
    rings = radiance.reshape(400, 400, 3).mean(axis=1)
    found: Array = 2 * np.pi * (weights / 2 * height) @ rings
    return found


@pytest.mark.slow
def test_it_is_the_sky_that_mitsuba_shows() -> None:
    """Another program, the same coefficients: the formula and what is between its tables."""
    needs_mitsuba()
    random, cases = np.random.default_rng(1), []
    for seed, elevation in enumerate((0.1, 0.3, 5.0, 20.0, 47.0, 80.0, 90.0)):
        towards = Sun(elevation=elevation, azimuth=float(random.uniform(-180, 180))).towards
        cases.append(
            {
                "turbidity": float(random.uniform(1, 10)) if seed else 10.0,
                "albedo": float(random.random()),
                "towards": towards.tolist(),
                "directions": upper(200, seed).tolist(),
            }
        )
    command = [sys.executable, "-m", "tests.mitsuba.clear_skies"]
    done = subprocess.run(
        command, input=json.dumps(cases), cwd=ROOT, capture_output=True, text=True, check=True
    )
    for case, theirs in zip(cases, json.loads(done.stdout), strict=True):
        sky = ClearSky(turbidity=case["turbidity"], ground=case["albedo"])
        ours = sky.radiance(np.array(case["towards"]), np.array(case["directions"]))
        expected = np.maximum(np.array(theirs) * (106.7502593994140625 / 106.856980), 0)
        assert_allclose(ours, expected, rtol=1e-4, atol=1e-4 * expected.mean())


def test_the_coefficients_are_those_of_the_model() -> None:
    needs_mitsuba()
    command = [sys.executable, "-c", CHECK]
    done = subprocess.run(command, cwd=ROOT / "tools", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


CHECK = """
import numpy as np, clear_sky
with np.load(clear_sky.TARGET) as file:
    wanted = clear_sky.coefficients()
    assert set(file.files) == set(wanted)
    for name, values in wanted.items():
        np.testing.assert_allclose(file[name], values, rtol=1e-12)
"""


@pytest.mark.parametrize("elevation", [20.0, 30.0, 45.0, 60.0, 75.0, 90.0])
def test_daylight_is_as_bright_as_illuminating_engineers_say(elevation: float) -> None:
    """At turbidity 3, in lux: the clear day of the Illuminating Engineering Society (P. Gillette,
    W. Pierpoint, S. Treado, "A general illuminance model for daylight availability", 1984).
    """
    towards = Sun(elevation=elevation).towards
    sine = np.sin(np.radians(elevation))
    sun = LUX * np.array(ClearSky().sun(towards)) @ LUMINANCE
    assert sun == pytest.approx(127_500 * np.exp(-0.21 / sine), rel=0.15)
    sky = LUX * received(ClearSky(ground=0.2), towards) @ LUMINANCE
    assert sky == pytest.approx(800 + 15_500 * np.sqrt(sine), rel=0.3)
    both = 127_500 * np.exp(-0.21 / sine) * sine + 800 + 15_500 * np.sqrt(sine)
    assert sun * sine + sky == pytest.approx(both, rel=0.1)


def test_low_suns_are_red_and_high_ones_white() -> None:
    suns = np.array([ClearSky().sun(Sun(elevation=high).towards) for high in (0, 5, 20, 60)])
    ratio = suns[:, 2] / suns[:, 0]
    assert (np.diff(ratio) > 0).all()
    assert ratio[0] < 0.1
    assert ratio[-1] > 0.6
    assert (np.diff(suns, axis=0) > 0).all()


def test_nothing_jumps_between_tables() -> None:
    """The sun's height and the haze move on by steps a thousandth apart, and across each end."""
    direction = upper(50)

    def seen(elevation: float, turbidity: float) -> Array:
        sky, towards = ClearSky(turbidity=turbidity), Sun(elevation=elevation).towards
        return np.concatenate([sky.radiance(towards, direction), [sky.sun(towards)]])

    for elevation, turbidity in ((4.0, 3.0), (40.0, 2.0), (89.0, 9.0), (26.67, 9.999)):
        here = seen(elevation, turbidity)
        size = here.max()
        assert np.abs(seen(elevation + 1e-3, turbidity) - here).max() < 1e-3 * size
        assert np.abs(seen(elevation, turbidity - 1e-3) - here).max() < 1e-2 * size
        assert np.abs(seen(elevation, min(turbidity + 1e-3, 10.0)) - here).max() < 1e-2 * size


@pytest.mark.parametrize("elevation", [3.0, 40.0])
def test_its_image_is_the_formula(elevation: float) -> None:
    """Except in the two rows at the horizon, where the image changes to the ground."""
    towards, sky = Sun(elevation=elevation, azimuth=70.0).towards, ClearSky()
    direction = upper(20_000)
    direction = direction[direction[:, 1] > np.sin(np.pi / 512)]
    found = sky64(sky_pixels(3.0, 0.3, tuple(towards)), direction)
    expected = sky.radiance(towards, direction)
    off = np.abs(found - expected) / expected.mean()
    assert off.max() < 0.05  # next to the sun and above the horizon
    assert off.mean() < 1e-3


def test_the_ground_is_lit_by_sun_and_sky() -> None:
    towards, sky = Sun(elevation=25.0, azimuth=-40.0).towards, ClearSky(ground=0.4)
    light = received(sky, towards) + np.array(sky.sun(towards)) * towards[1]
    pixels = sky_pixels(3.0, 0.4, tuple(towards))
    assert_allclose(pixels[256:], np.broadcast_to(0.4 * light / np.pi, (256, 1024, 3)), rtol=2e-3)
    assert not sky_pixels(3.0, 0.0, tuple(towards))[256:].any()


@pytest.mark.slow_cases("nee")
@pytest.mark.parametrize("method", ["nee", "mis"])
def test_a_floor_receives_what_the_model_says(context: Context, method: str) -> None:
    scene = day(FLOOR)
    towards, sky = Sun(elevation=40.0, azimuth=30.0).towards, ClearSky()
    light = received(sky, towards) + np.array(sky.sun(towards)) * towards[1]
    image = rendered(scene, context, 1024, method=method, bounces=1)
    assert_mean(whole(image), light * 0.5 / np.pi, within=0.02, floor=1e-5)


@pytest.mark.slow
def test_methods_agree_under_a_clear_sky(context: Context) -> None:
    """With a wide sun, which scattering finds, and without any that is brighter than the sky."""
    wide = {"angle": 30.0}
    scene = day(FLOOR, sphere([0, 0.3, 0], 0.3, "m"), sun=wide, camera={**ABOVE, "fov": 60})
    naive, nee, mis = (
        rendered(scene, context, 1024, method=method, seed=seed, bounces=4)
        for seed, method in enumerate(METHODS)
    )
    assert_agree(nee, naive, within=0.05)
    assert_agree(mis, naive, within=0.05)


def test_scale_is_a_factor_of_sky_and_sun(context: Context) -> None:
    def picture(scale: float, **sun: Any) -> Array:
        scene = day(FLOOR, sky={"scale": scale}, sun=sun, camera={**ABOVE, "fov": 60})
        return rendered(scene, context, 4).radiance

    assert (2 * picture(1.0)).tobytes() == picture(2.0).tobytes()
    given = day(FLOOR, sky={"scale": 5.0}, sun={"irradiance": [1, 2, 3]})
    assert given.sun_irradiance == (1, 2, 3)
    assert not picture(0.0).any()
    assert day(FLOOR, sky={"scale": 5.0}).sun_irradiance == pytest.approx(
        5 * np.array(day(FLOOR).sun_irradiance)
    )


def test_sky_and_sun_are_two_light_groups() -> None:
    both = day(FLOOR)
    assert list(both.light_groups) == ["sun", "background"]
    plan = prepare(both, Settings(), "groups")
    brighter = day(FLOOR, sky={"scale": 1.5})
    assert plan.relit(brighter, Settings(), "groups") is not None
    hazier = day(FLOOR, sky={"turbidity": 4.0})
    assert plan.relit(hazier, Settings(), "groups") is None


def test_it_is_the_program_of_an_image(context: Context) -> None:
    """No line of the kernel is for it."""
    needs = needs_of(SceneFacts(day(FLOOR)), Settings())
    assert needs.has_environment
    assert needs.sample_sky
    assert needs.sample_sun
    assert "the image of the sky lights nothing" in omissions(
        SceneFacts(day(FLOOR)), Settings(method="cook")
    )


def test_it_survives_a_file() -> None:
    scene = day(FLOOR, sky={"turbidity": 2.5, "ground": 0.1, "scale": 4.0})
    text = "[background]\nsky = { turbidity = 2.5, ground = 0.1, scale = 4 }\n"
    text += "[sun]\nelevation = 40\nazimuth = 30\n[camera]\nposition = [0, 0, 3]\n"
    read = decode_scene((text + "look_at = [0, 0, 0]\n").encode(), "test")
    assert read.background == scene.background
    assert read.sun == scene.sun


@pytest.mark.parametrize(
    ("background", "sun", "said"),
    [
        ({"sky": {}}, None, r"background.sky.*needs \[sun\]"),
        ({"sky": {}}, {"elevation": -1}, "sun.elevation.*is below the horizon"),
        ({"sky": {}}, {"direction": [1, -1, 0]}, "sun.direction.*is below the horizon"),
        ({"sky": {}, "color": [1, 1, 1]}, {"elevation": 1}, "sky excludes color"),
        ({"sky": {}, "rotation": 4}, {"elevation": 1}, "rotation turns an image"),
        ({"sky": {"turbidity": 0.5}}, {"elevation": 1}, "background.sky.turbidity"),
        ({"sky": {"turbidity": 11}}, {"elevation": 1}, "background.sky.turbidity"),
        ({"sky": {"ground": 1.5}}, {"elevation": 1}, "background.sky.ground"),
        ({"sky": {"haze": 1}}, {"elevation": 1}, "haze"),
        ({"sky": 3}, {"elevation": 1}, "background.sky"),
        ({"color": [1, 1, 1]}, {"elevation": 1}, "sun.irradiance.*is missing"),
    ],
)
def test_a_sky_that_cannot_be_is_refused(
    background: dict[str, Any], sun: dict[str, Any] | None, said: str
) -> None:
    with pytest.raises(SceneError, match=said):
        scene_of([FLOOR], {"m": MATTE}, sun=sun, background=background)
