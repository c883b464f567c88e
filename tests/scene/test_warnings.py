"""Scenes beyond a known limit are rendered with a word of caution; all others without."""

from pathlib import Path
from typing import Any

import pytest

from glrt.cli.main import main
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.builders import MATTE, glass, lamp, plane, quad, scene_of, sphere
from tests.support.renders import rendered

MATERIALS = {"m": MATTE, "glass": glass(1.5), "lamp": lamp(1.0)}


def told(scene: Scene, **settings: Any) -> list[str]:
    return cautions(scene, settings_for(scene.render, **settings))


def with_balls(*balls: dict[str, Any], **camera: Any) -> Scene:
    things = [plane([0, -9, 0], [0, 1, 0], "m"), *balls]
    return scene_of(things, MATERIALS, camera, background={"color": [1, 1, 1]})


@pytest.mark.slow_cases("drink", "water")
@pytest.mark.parametrize("name", scene_names())
def test_scenes_that_come_with_glrt_need_no_caution(name: str) -> None:
    assert told(load(name)) == []


@pytest.mark.parametrize(("radius", "warns"), [(1e3, False), (0.9e4, False), (2e4, True)])
def test_huge_ball_close_to_the_camera_is_reported(radius: float, warns: bool) -> None:
    ground = {**sphere([0, -radius - 1, 0], radius, "m"), "name": "ground"}
    found = told(with_balls(ground))
    assert bool(found) == warns
    if warns:
        assert found[0].startswith("objects[1] 'ground': its radius is 2e+04 times")
        assert "0.1 %" in found[0]
        assert found[0].endswith("Use a plane or a smaller ball.")


@pytest.mark.parametrize(("radius", "warns"), [(0.3, False), (1e-3, True)])
def test_huge_ball_under_a_small_one_is_reported(radius: float, warns: bool) -> None:
    ground = sphere([0, -1600, -50], 1e3, "m")  # the camera is 600 above it
    small = sphere([0, -600 + radius, -50], radius, "m")
    far = sphere([0, 50, -50], 1e-3, "m")
    assert bool(told(with_balls(ground, small, far))) == warns


def test_camera_on_the_surface_of_a_ball_is_reported() -> None:
    text = told(with_balls(sphere([0, -2, 0], 2, "m")))[0]
    assert "times the distance of the camera" in text
    assert "to 100 % of that" in text


@pytest.mark.parametrize(
    ("center", "radius", "warns"),
    [
        ([1.5, 0, -5], 1.0, True),
        ([2.0, 0, -5], 1.0, False),  # touching
        ([3.0, 0, -5], 1.0, False),  # apart
        ([0.2, 0, -5], 0.5, False),  # within
        ([0.5, 0, -5], 0.5, False),  # within and touching
        ([0.0, 0, -5], 1.0, False),  # the same
    ],
)
def test_glass_that_crosses_glass_is_reported(center: Any, radius: float, warns: bool) -> None:
    first = sphere([0, 0, -5], 1, "glass")
    found = about("and cross", with_balls(first, sphere(center, radius, "glass")))
    assert len(found) == warns
    assert all(text.startswith("objects[1] and objects[2] are glass") for text in found)
    assert not told(with_balls(first, sphere(center, radius, "m")))


def about(words: str, scene: Scene) -> list[str]:
    """The cautions that have these words."""
    return [text for text in told(scene) if words in text]


AROUND = sphere([0, 0, 0.5], 2, "m")  # the camera is at the origin


@pytest.mark.parametrize(
    ("things", "warns"),
    [
        ([AROUND], True),
        ([sphere([0, 0, 0.5], 2, "glass")], False),
        ([sphere([0, 0, 0.5], 2, "lamp")], False),
        ([sphere([0, 0, 2.5], 2, "m")], False),  # next to it
        ([AROUND, sphere([0, 0, 5], 1, "lamp")], True),  # a lamp outside
        ([AROUND, sphere([0, 0, 0.5], 4, "lamp")], True),  # around
        ([AROUND, sphere([0, 1, 0], 0.2, "lamp")], False),  # inside
        ([AROUND, sphere([0, 3, 0], 2, "lamp")], False),  # through the wall
        ([AROUND, quad([-1, 1, -1], [2, 0, 0], [0, 0, 2], "lamp")], False),
        ([AROUND, quad([-1, 4, -1], [2, 0, 0], [0, 0, 2], "lamp")], True),
        ([AROUND, plane([0, 1, 0], [0, 3, 0], "lamp")], False),
        ([AROUND, plane([0, 4, 0], [0, 3, 0], "lamp")], True),
        ([AROUND, sphere([0, 1, 0], 0.2, "lamp"), sphere([0, 0, 0], 0.5, "m")], True),  # in two
    ],
)
def test_a_camera_within_a_dark_ball_is_reported(
    context: Context, things: list[dict[str, Any]], warns: bool
) -> None:
    """Its picture is black under a white sky; all other pictures show something."""
    scene = scene_of(things, MATERIALS, background={"color": [1, 1, 1]})
    found = told(scene)
    assert len(found) == warns
    assert all("the camera is inside this ball, which is not glass" in text for text in found)
    picture = rendered(scene, context, 64, width=16, height=16).radiance
    assert picture.any() != warns


@pytest.mark.parametrize(("fov", "height", "warns"), [(1e-3, 64, False), (1e-3, 512, True)])
def test_pixels_narrower_than_a_rounding_are_reported(fov: float, height: int, warns: bool) -> None:
    found = told(with_balls(sphere([0, 0, -5], 1, "m"), fov=fov), height=height)
    assert bool(found) == warns
    if warns:
        assert found[0].startswith("camera.fov 0.001 at 512 rows makes pixels of 3e-08 radians")


BALL = sphere([0, 0, -5], 1, "m")
LAMP = sphere([0, 4, -5], 1, "lamp")
BLACK = {"color": [0, 0, 0]}


@pytest.mark.parametrize(
    ("things", "tables", "remedy"),
    [
        ([BALL], {}, 'Give an object a material of type "light"'),
        ([BALL], {"background": BLACK}, "add a [background]"),
        ([BALL, LAMP], {"lights": {"lamp": 0}}, "the intensity of its group"),
        ([BALL, LAMP], {}, ""),
        ([BALL], {"background": {"bottom": [0, 0, 0], "top": [0, 0, 1]}}, ""),
        ([BALL], {"background": {"color": [1, 1, 1]}, "lights": {"background": 0}}, "[background]"),
    ],
)
def test_a_scene_without_light_is_reported_with_the_remedy(
    context: Context, things: list[dict[str, Any]], tables: dict[str, Any], remedy: str
) -> None:
    """Its picture is black, with an error of 0; all other pictures show something."""
    scene = scene_of(things, MATERIALS, **tables)
    found = told(scene)
    assert len(found) == bool(remedy)
    assert all("there is no light in this scene" in text and remedy in text for text in found)
    image = rendered(scene, context, 32, width=16, height=16)
    assert image.radiance.any() != bool(remedy)
    assert (image.error == 0) == bool(remedy)


SCENE = """
[camera]
position = [0.0, 0.0, 0.0]
look_at = [0.0, 0.0, -1.0]
[background]
color = [1.0, 1.0, 1.0]
[materials.white]
type = "lambertian"
color = [0.5, 0.5, 0.5]
[[objects]]
shape = "sphere"
center = [0.0, -100001.0, 0.0]
radius = 100000.0
material = "white"
"""


def test_commands_report_it_and_go_on(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)
    render = ["render", str(scene), "-o", str(tmp_path / "a.npy"), "--samples", "1"]
    small = ["--width", "8", "--height", "8"]
    assert main([*render, *small]) == 0
    first, last = capsys.readouterr().err.splitlines()
    assert first.startswith("glrt: caution: objects[0]: its radius is 1e+05 times")
    assert last.startswith("Wrote")
    assert main([*render, *small, "--quiet"]) == 0
    assert capsys.readouterr().err.splitlines() == [first]
    assert main(["inspect", str(scene)]) == 0
    assert "\ncaution: objects[0]" in capsys.readouterr().out


BOX = {"shape": "box", "min": [-1, -1, -6], "max": [1, 1, -4], "material": "glass"}
TURNED = {**BOX, "rotate": [0, 45, 0]}
CAN = {"shape": "cylinder", "from": [0, -1, -5], "to": [0, 1, -5], "radius": 1, "material": "glass"}


@pytest.mark.parametrize(
    ("first", "second", "warns"),
    [
        (BOX, sphere([0, 0, -5], 1.2, "glass"), True),
        (BOX, sphere([0, 0, -5], 0.9, "glass"), False),
        (BOX, sphere([0, 0, -5], 1.0, "glass"), False),
        (BOX, sphere([0, 0, -5], 2.0, "glass"), False),
        (BOX, sphere([2.5, 0, -5], 1.5, "glass"), False),
        (BOX, sphere([2.4, 0, -5], 1.5, "glass"), True),
        (TURNED, sphere([2.4, 0, -5], 1.1, "glass"), True),
        (CAN, {**CAN, "radius": 0.9, "from": [0, -0.9, -5], "to": [0, 0.5, -5]}, False),
        (CAN, {**CAN, "radius": 1.1, "from": [0, -0.9, -5], "to": [0, 0.5, -5]}, True),
        (CAN, {**BOX, "min": [-1, -0.9, -4.5], "max": [1, 0.9, -3]}, True),
        (plane([0, 0, 0], [0, 1, 0], "glass"), CAN, True),
        (plane([0, 2, 0], [0, 1, 0], "glass"), CAN, False),
        (plane([0, -2, 0], [0, 1, 0], "glass"), plane([0, 0, 0], [0, 1, 0], "glass"), False),
        (plane([0, -2, 0], [0, 1, 0], "glass"), plane([0, 0, 0], [1, 1, 0], "glass"), True),
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_solids_of_glass_that_cross_are_reported(
    first: Any, second: Any, warns: bool, turned: bool
) -> None:
    """A tumbler and its water, for one: apart and within each other are fine."""
    objects = [plane([0, -9, 0], [0, 1, 0], "m"), *([second, first] if turned else [first, second])]
    scene = scene_of(objects, MATERIALS, background={"color": [1, 1, 1]})
    assert len(about("are glass and cross", scene)) == warns
    assert not about("share a part", scene)


UPPER = {"from": [0, 0.2, -5], "to": [0, 0.9, -5]}
BESIDE = {"min": [1, -1, -6], "max": [2, 1, -4]}


@pytest.mark.parametrize(
    ("first", "second", "shares"),
    [
        (CAN, BOX, True),
        (BOX, {**BOX, **BESIDE}, True),  # side by side
        (BOX, {**BOX, **BESIDE, "min": [1.001, -1, -6]}, False),
        (BOX, {**BOX, "min": [2, -1, -6], "max": [3, 1, -4]}, False),  # on one table
        (BOX, {**BOX, "min": [1, 1, -6], "max": [2, 2, -4]}, False),  # an edge in common
        ({**CAN, **UPPER}, {**CAN, "to": [0, 0.2, -5]}, True),  # air on water
        ({**CAN, **UPPER}, {**CAN, "to": [0, 0.199, -5]}, False),
        ({**CAN, **UPPER, "capped": False}, {**CAN, "to": [0, 0.2, -5]}, False),
        ({**CAN, "radius": 0.3}, CAN, True),  # up to the rim
        (plane([0, -1, 0], [0, 2, 0], "glass"), CAN, True),
        (plane([0, -1, 0], [0, -2, 0], "glass"), BOX, True),
        (plane([0, -1.001, 0], [0, 1, 0], "glass"), CAN, False),
        (TURNED, sphere([0, 2, -5], 1, "glass"), False),  # touches in a point
    ],
)
def test_glass_that_shares_a_face_is_reported(first: Any, second: Any, shares: bool) -> None:
    """The warning has a remedy, for example for the water in a glass and the air on it."""
    materials = MATERIALS | {"open": MATERIALS["m"]}
    things = [
        item if item.get("capped", True) else {**item, "material": "open"}
        for item in (first, second)
    ]
    found = about("share a part of a flat face", scene_of(things, materials))
    assert len(found) == shares
    assert all("Leave a hair between them" in text for text in found)


@pytest.mark.parametrize(
    ("inner", "outer", "advice"),
    [
        (1.333, 1.5, "1.333 / 1.5 = 0.889"),  # water in glass, against air
        (0.889, 1.5, ""),  # as it should be
        (1.5, 1.333, "1.5 / 1.333 = 1.13"),
        (2.4, 1.333, ""),  # a gem
        (1 / 1.5, 1.5, ""),  # a bubble
        (1.1, 1.5, ""),
    ],
)
@pytest.mark.parametrize("solid", [BOX, sphere([0, 0, -5], 1, "glass")])
def test_glass_in_glass_that_looks_given_against_air_is_reported(
    inner: float, outer: float, advice: str, solid: Any
) -> None:
    materials = {"glass": glass(outer), "water": glass(inner)}
    within = {**sphere([0.1, 0, -5], 0.5, "water"), "name": "drop"}
    found = about("against air", scene_of([solid, within], materials))
    assert len(found) == bool(advice)
    assert all(
        advice in text and text.startswith("objects[1] 'drop' lies inside") for text in found
    )
