"""Frames of a series: their scenes, and the bits of their pictures."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError, UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.phong import Phong
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption
from glrt.scene.camera import Camera
from glrt.scene.scenefile.toml import parse_scene
from glrt.series.rendering import FrameRenderer, RenderOptions
from glrt.series.series import Series, chosen, turned
from glrt.series.sweeps import parse_sweep
from glrt.settings import Settings, settings_for
from tests.support.images import same_bits

SMALL = Settings(width=24, height=16, samples=16)
MOVING: dict[str, Any] = {
    "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0]},
    "background": {"bottom": [0.2, 0.2, 0.2], "top": [1, 1, 1]},
    "materials": {"red": {"type": "lambertian", "color": [0.8, 0.1, 0.1]}},
    "objects": [
        {"shape": "sphere", "name": "ball", "center": [0, 0, 0], "radius": 1, "material": "red"}
    ],
    "animation": {
        "fps": 4,
        "tracks": [
            {"target": "objects.ball.center", "times": [0, 1], "values": [[-1, 0, 0], [1, 0, 0]]},
            {"target": "camera.position", "times": [0, 1], "values": [[0, 1, 5], [0, 2, 4]]},
            {"target": "materials.red.color", "times": [0, 1], "values": [[1, 0, 0], [0, 0, 1]]},
        ],
    },
}


def test_a_frame_has_the_bits_of_a_still_with_its_values(context: Context) -> None:
    """The film goes through its frames with one renderer; the still is rendered on its own."""
    scene = parse_scene(MOVING, "x")
    still = {name: table for name, table in MOVING.items() if name != "animation"}
    still["camera"] = {"position": [0, 1.5, 4.5], "look_at": [0, 0, 0]}
    still["materials"] = {"red": {"type": "lambertian", "color": [0.5, 0, 0.5]}}
    own = Renderer(parse_scene(still, "x"), SMALL, context, "baked")
    expected = own.render().image().radiance
    own.release()
    series = Series(scene, SMALL)
    work = FrameRenderer(RenderOptions(context=context), Interruption())
    found = []
    for number in (0, 1, 2, 4, 2):
        frame = series.still(number)
        image = work.render(frame, RenderOptions().limits(frame))
        assert image
        found.append(image.radiance)
    work.release()
    assert same_bits(found[2], expected)
    assert same_bits(found[4], expected)
    assert not same_bits(found[1], expected)


def test_a_moving_camera_and_a_moving_ball_compile_nothing(context: Context) -> None:
    series = Series(parse_scene(MOVING, "x"), SMALL)
    renderer = Renderer(series.still(0).scene, SMALL, context, "generic")
    costs = {renderer.update(series.still(number).scene) for number in range(1, 5)}
    renderer.release()
    assert costs == {"restart"}


def test_a_picture_of_a_frame_holds_a_still(context: Context) -> None:
    scene = parse_scene(MOVING, "x")
    renderer = Renderer(scene, SMALL, context)
    recipe = renderer.render().image().recipe
    renderer.release()
    assert recipe
    assert recipe.scene == scene.still


def test_a_turntable_closes_and_keeps_its_distance() -> None:
    camera = Camera(position=(1, 2, 3), look_at=(0.5, 0, 0), up=(0.1, 1, 0))
    scene = load("cornell").model_copy(update={"camera": camera})
    frames = [Series(scene, SMALL, turns=8).still(number).scene.camera for number in range(8)]
    assert frames[0] == camera
    assert turned(camera, 360).position == pytest.approx(camera.position, abs=1e-15)
    places = np.array([frame.position for frame in frames]) - np.array(camera.look_at)
    assert np.linalg.norm(places, axis=1) == pytest.approx(np.linalg.norm(places[0]))
    assert places.sum(axis=0) / 8 == pytest.approx(
        np.array(camera.up) * (places[0] @ camera.up) / 1.01
    )
    steps = np.linalg.norm(places - np.roll(places, 1, axis=0), axis=1)
    assert steps == pytest.approx(steps[0])


def test_a_turntable_turns_counter_clockwise_from_above() -> None:
    camera = Camera(position=(0, 0, 2), look_at=(0, 0, 0))
    assert turned(camera, 90).position == (2, 0, 0)


def test_sweeps_are_exact_at_their_ends_and_fill_rows() -> None:
    rows, columns = (
        parse_sweep("materials.white.color=0.1,0.2,0.3:0.7,0.6,0.5:3"),
        parse_sweep("render.bounces=1:4:4"),
    )
    series = Series(load("cornell"), SMALL, sweeps=(rows, columns))
    assert (series.count, series.columns(12)) == (12, 4)
    first, fifth, last = (series.still(number) for number in (0, 4, 11))
    assert first.scene.materials["white"].model_dump()["color"] == (0.1, 0.2, 0.3)
    assert fifth.scene.materials["white"].model_dump()["color"] == pytest.approx((0.4, 0.4, 0.4))
    assert last.scene.materials["white"].model_dump()["color"] == (0.7, 0.6, 0.5)
    assert [still.settings.bounces for still in (first, fifth, last)] == [1, 1, 4]
    assert fifth.label == "color 0.4 0.4 0.4, bounces 1"


@pytest.mark.parametrize(
    ("text", "instead"),
    [
        ("render.bounces=1:2:3", "render.bounces=1:2:2"),
        ("render.samples=1:11:5", "render.samples=1:11:6"),
        ("render.bounces=0.4:8:2", "render.bounces=0:8:2"),
        ("materials.glass.priority=1:4:3", "materials.glass.priority=1:4:4"),
        ("render.bounces=1.5:3:1", "render.bounces=2:3:1"),
    ],
)
def test_a_whole_number_takes_no_steps_between(text: str, instead: str) -> None:
    """A label would name a value that is not rendered."""
    scene = load("cornell")
    series = Series(scene, SMALL, sweeps=(parse_sweep(text),))
    with pytest.raises(UsageError, match="is a whole number") as told:
        series.check()
    key = text.partition("=")[0]
    assert key in str(told.value)
    assert str(told.value).endswith(f"--sweep {instead}.")
    Series(scene, SMALL, sweeps=(parse_sweep(instead),)).check()


def test_a_label_shows_the_value_that_is_rendered() -> None:
    small = parse_sweep("materials.ball.roughness=1e-8:3e-8:3")
    assert [small.label(step) for step in range(3)] == [
        "roughness 1e-08",
        "roughness 2e-08",
        "roughness 3e-08",
    ]
    assert parse_sweep("render.seed=1234567:1234569:3").label(1) == "seed 1234568"
    assert parse_sweep("camera.fov=-0.3:0.6:4").label(1) == "fov 0"


def test_a_sweep_out_of_range_is_found_before_it_renders() -> None:
    series = Series(load("cornell"), SMALL, sweeps=(parse_sweep("materials.glass.ior=0:2:3"),))
    with pytest.raises(SceneError, match=r"^frame 0: materials.glass: ior must be"):
        series.check()
    lacking = Series(load("cornell"), SMALL, sweeps=(parse_sweep("materials.glas.ior=1:2:3"),))
    with pytest.raises(SceneError, match="unknown material 'glas'; did you mean 'glass'"):
        lacking.check()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("camera.fov", "is not KEY=FROM:TO:N"),
        ("camera.fov=1:2", "is not KEY=FROM:TO:N"),
        ("camera.fov=1:2:0", "N must be a whole number from 1 to 10,000"),
        ("camera.fov=a:2:3", "FROM and TO must be numbers"),
        ("camera.up=0,1,0:1:3", "as many numbers each"),
        ("render.width=1:2:2", "a sweep can change"),
        ("fov=1:2:2", "names no value that can change"),
    ],
)
def test_bad_sweeps_are_refused(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words.replace("(", r"\(")):
        parse_sweep(text)


def test_each_frame_may_have_its_own_seed() -> None:
    series = Series(load("cornell"), SMALL.model_copy(update={"seed": 2**32 - 1}), turns=3)
    assert {series.still(number).settings.seed for number in range(3)} == {2**32 - 1}
    own = Series(series.scene, series.settings, turns=3, varies_seed=True)
    assert [own.still(number).settings.seed for number in range(3)] == [2**32 - 1, 0, 1]


def test_frames_are_chosen_from_those_there_are() -> None:
    assert chosen(9, None) == range(9)
    assert chosen(9, (2, 4)) == range(2, 5)
    with pytest.raises(UsageError, match=r"--frames 2-9: the series has frames 0 to 8"):
        chosen(9, (2, 9))
    assert Series(load("cornell"), SMALL, turns=7).columns(7) == 3


# --- constants of Phong's model ------------------------------------------------------------------

SHADED = {
    **MOVING,
    "render": {"method": "blinn", "phong": {"specular": 0.5, "exponent": 10}},
    "animation": {
        "fps": 4,
        "tracks": [
            {"target": "render.phong.exponent", "times": [0, 1], "values": [10, 21]},
            {"target": "render.phong.ambient", "times": [0, 1], "values": [0, 1]},
        ],
    },
}


def test_a_film_changes_the_constants_of_a_model() -> None:
    """Scene and settings of a frame have them; whole numbers are rounded."""
    scene = parse_scene(SHADED, "x")
    series = Series(scene, settings_for(scene.render, width=8, height=8))
    for number, exponent in enumerate((10, 13, 16, 18, 21)):
        still = series.still(number)
        phong = Phong(ambient=number / 4, specular=0.5, exponent=exponent)
        assert still.scene.render.phong == still.settings.phong == phong
        assert still.settings.width == 8


def test_a_sweep_changes_the_constants_of_a_model() -> None:
    scene = parse_scene(SHADED, "x").still
    sweeps = tuple(map(parse_sweep, ("render.phong.exponent=1:4:3", "render.bounces=1:2:2")))
    series = Series(scene, settings_for(scene.render), sweeps=sweeps)
    found = [series.still(number) for number in range(series.count)]
    shown = [(s.settings.phong and s.settings.phong.exponent, s.settings.bounces) for s in found]
    assert shown == [(n, bounces) for n in (1, 2, 4) for bounces in (1, 2)]
    assert all(still.scene.render.phong == still.settings.phong for still in found)


@pytest.mark.parametrize(
    ("target", "values", "text"),
    [
        ("render.phong.shine", [1, 2], "unknown key 'shine'. Keys of render.phong: ambient"),
        ("render.phong.diffuse", [0, -1], r"values\[1\].*must be at least 0"),
        ("render.bounces", [1, 2], "names no value that can change"),
        ("render.width.phong", [1, 2], "names no value that can change"),
    ],
)
def test_wrong_constants_in_tracks_are_refused(target: str, values: list[int], text: str) -> None:
    tracks = [{"target": target, "times": [0, 1], "values": values}]
    with pytest.raises(SceneError, match=text):
        parse_scene({**SHADED, "animation": {"tracks": tracks}}, "x")


def test_a_sweep_of_half_a_highlight_is_refused() -> None:
    scene = parse_scene({**MOVING, "render": {"method": "phong"}}, "x").still
    sweep = parse_sweep("render.phong.exponent=1:5:3")
    with pytest.raises(SceneError, match="exponent is given without specular"):
        Series(scene, settings_for(scene.render), sweeps=(sweep,)).check()
