"""Values between keys, and scenes at a frame of their animation."""

import copy
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

from glrt.core.errors import SceneError, UsageError
from glrt.image.sources import load
from glrt.scene.animation.interpolation import between
from glrt.scene.animation.rotations import angles, matrix, of_angles, slerp
from glrt.scene.animation.tracks import Animation, Track, parse_target
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import find
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.scene.shapes.box import rotation

SCENE: dict[str, Any] = {
    "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
    "materials": {
        "red": {"type": "lambertian", "color": [0.8, 0.1, 0.1]},
        "lamp": {"type": "light", "emission": [1, 1, 1]},
    },
    "objects": [
        {"shape": "sphere", "name": "ball", "center": [0, 0, 0], "radius": 1, "material": "red"},
        {"shape": "box", "min": [0, 0, 0], "max": [1, 1, 1], "name": "a b", "material": "lamp"},
    ],
}


def animated(*tracks: dict[str, Any], **table: Any) -> Scene:
    keys = {"fps": 4, **table, "tracks": list(tracks)}
    return parse_scene({**copy.deepcopy(SCENE), "animation": keys}, "x.toml")


def track(target: str, times: Any, values: Any, **more: Any) -> dict[str, Any]:
    return {"target": target, "times": times, "values": values, **more}


def test_a_line_is_exact_where_its_numbers_are() -> None:
    scene = animated(track("objects.ball.center", [0, 2], [[0, 0, 0], [8, -4, 1]]))
    assert scene.frames == 9
    found = [scene.at_frame(frame).objects[0].model_dump()["center"] for frame in range(9)]
    assert found == [(float(k), -k / 2, k / 8) for k in range(9)]


def test_a_step_holds_until_the_next_key_and_ends_hold_beyond() -> None:
    key = {"times": [0.5, 1], "values": [30, 60], "interpolation": "step"}
    scene = animated({"target": "camera.fov", **key}, frames=7)
    fovs = [scene.at_frame(frame).camera.fov for frame in range(7)]
    assert fovs == [30, 30, 30, 30, 60, 60, 60]


def test_a_cubic_meets_its_keys_and_follows_any_parabola() -> None:
    """Slopes of chords are those of a parabola where keys are equally far apart."""
    times = [0.0, 1.0, 2.0, 3.0]
    values = np.array([[t * t - 3 * t] for t in times])
    for moment in np.linspace(1, 2, 9):
        expected = moment * moment - 3 * moment
        assert between(times, values, float(moment), "cubic")[0] == pytest.approx(expected, 1e-12)
    assert [between(times, values, t, "cubic")[0] for t in times] == values[:, 0].tolist()


def test_rotations_turn_evenly_along_the_shorter_arc() -> None:
    start = np.array([0, 0, 0, 1.0])
    for turn in (50.0, 170.0, 200.0, 1e-4):
        half = math.radians(turn) / 2
        end = np.array([0, math.sin(half), 0, math.cos(half)])
        way = turn if turn < 180 else turn - 360
        for share in (0.0, 0.25, 0.5, 1.0):
            expected = rotation((0, way * share, 0))
            assert matrix(slerp(start, end, share)) == pytest.approx(expected, abs=1e-12)
            assert matrix(slerp(start, -end, share)) == pytest.approx(expected, abs=1e-12)


@given(some.lists(some.floats(-1, 1), min_size=4, max_size=4))
def test_angles_of_a_quaternion_turn_as_it_does(parts: list[float]) -> None:
    quaternion = np.array(parts)
    if np.linalg.norm(quaternion) < 1e-3:
        return
    x, y, z = map(float, angles(quaternion))
    assert rotation((x, y, z)) == pytest.approx(matrix(quaternion), abs=1e-7)


@given(some.lists(some.floats(-720, 720), min_size=3, max_size=3))
def test_a_quaternion_of_angles_turns_as_they_do(degrees: list[float]) -> None:
    x, y, z = degrees
    found = of_angles(degrees)
    assert np.linalg.norm(found) == pytest.approx(1, abs=1e-12)
    assert found[3] >= 0
    assert matrix(found) == pytest.approx(rotation((x, y, z)), abs=1e-12)


@pytest.mark.parametrize("y", [90, -90])
def test_angles_where_two_axes_fall_together(y: float) -> None:
    half = math.radians(y) / 2
    about_y = np.array([0, math.sin(half), 0, math.cos(half)])
    x, turned, z = map(float, angles(about_y))
    assert rotation((x, turned, z)) == pytest.approx(rotation((0, y, 0)), abs=1e-12)


def test_a_box_takes_quaternions_and_angles() -> None:
    half = math.sqrt(0.5)
    quarter = track('objects."a b".rotate', [0, 1], [[0, 0, 0, 1], [0, half, 0, half]])
    turned = animated(quarter).at_frame(2).objects[1].model_dump()["rotate"]
    assert turned == pytest.approx((0, 45, 0), abs=1e-12)
    whole = track('objects."a b".rotate', [0, 1], [[0, 0, 0], [0, 360, 0]])
    assert animated(whole).at_frame(3).objects[1].model_dump()["rotate"] == (0, 270, 0)


def test_every_kind_of_target_changes_and_the_rest_stays() -> None:
    scene = animated(
        track("camera.position", [0, 1], [[0, 0, 5], [1, 1, 5]]),
        track("materials.red.color", [0, 1], [[1, 0, 0], [0, 0, 1]]),
        track("lights.lamp", [0, 1], [1, 3]),
        track("background.color", [0, 1], [[0, 0, 0], [1, 1, 1]]),
    )
    middle = scene.at_frame(2)
    expected = copy.deepcopy(SCENE) | {"lights": {"lamp": 2}, "background": {"color": [0.5] * 3}}
    expected["camera"]["position"] = [0.5, 0.5, 5]
    expected["materials"]["red"]["color"] = [0.5, 0, 0.5]
    assert middle == parse_scene(expected, "x")
    assert middle.animation is None
    assert middle.objects[1] is scene.objects[1]


def test_frames_end_with_the_last_key() -> None:
    assert animated(track("camera.fov", [0, 1.25], [40, 50])).frames == 6
    assert animated(track("camera.fov", [0, 0.1 * 3], [40, 50]), fps=10).frames == 4  # 0.3 + 4e-17
    assert animated(track("camera.fov", [0, 1], [40, 50]), frames=100).frames == 100
    assert animated().frames == 1
    assert parse_scene(SCENE, "x").frames == 1


def test_a_frame_beyond_the_last_is_refused() -> None:
    scene = animated(track("camera.fov", [0, 1], [40, 50]))
    with pytest.raises(UsageError, match="no frame 5: the scene has frames 0 to 4"):
        scene.at_frame(5)
    with pytest.raises(UsageError, match="frame 0 alone"):
        parse_scene(SCENE, "x").at_frame(1)


def test_a_curve_that_leaves_the_range_names_the_frame() -> None:
    wild = track("camera.fov", [0, 1, 2, 3], [1, 1, 170, 1], interpolation="cubic")
    scene = animated(wild)
    with pytest.raises(SceneError, match=r"^frame 2: camera: fov must be greater than 0"):
        scene.at_frame(2)


FOV = track("camera.fov", [0, 1], [40, 50])
BAD = {
    "unknown object": (track("objects.bell.center", [0], [[0, 0, 0]]), "did you mean 'ball'"),
    "unknown key": (track("objects.ball.centre", [0], [[0, 0, 0]]), "did you mean 'center'"),
    "unknown group": (track("lights.lump", [0], [1]), "did you mean 'lamp'"),
    "dark group": (track("lights.lamp", [0], [-1]), "values[0] must be a number from 0 to 1e+15"),
    "no sun": (track("sun.elevation", [0], [1]), "tracks[0].target: the scene has no [sun]"),
    "settings": (track("render.samples", [0], [1]), "names no value that can change"),
    "a table": (track("camera", [0], [1]), "names no value that can change"),
    "no target": (track("", [0], [1]), "is not the name of a value"),
    "bare spaces": (track("objects.a b.min", [0], [1]), "such as camera.position, lights.lamp"),
    "two keys": (track("camera.fov=1\na", [0], [1]), "is not the name of a value"),
    "one time": ({**FOV, "times": 3}, "times must be a list, got 3"),
    "no time": ({**FOV, "times": []}, "times must be a list of at least 1"),
    "lengths": ({**FOV, "times": [0]}, "has 1 times and 2 values"),
    "order": ({**FOV, "times": [1, 1]}, "times must grow from key to key"),
    "range": ({**FOV, "values": [40, 200]}, "tracks[0].values[1]: fov must be less than 180"),
    "text": ({**FOV, "values": [40, "a"]}, "values[1] must be a number, or a list of numbers"),
    "mixed": ({**FOV, "values": [40, [1, 2, 3]]}, "values must have as many numbers each"),
    "a name": (track("objects.ball.material", [0], [1]), "material must be text in quotes"),
    "misspelt": ({**FOV, "interpolation": "cubik"}, "did you mean 'cubic'"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_tracks_are_refused_by_name(case: str) -> None:
    wrong, words = BAD[case]
    with pytest.raises(SceneError) as refused:
        animated(wrong)
    text = str(refused.value)
    assert text.startswith("x.toml: animation.tracks[0]")
    assert words in text
    assert "\n" not in text


def test_two_tracks_of_one_value_and_two_objects_of_one_name_are_refused() -> None:
    with pytest.raises(SceneError, match=r"tracks\[0\] and tracks\[1\] both change camera.fov"):
        animated(FOV, FOV)
    twins = copy.deepcopy(SCENE)
    twins["objects"][1]["name"] = "ball"
    move = track("objects.ball.hidden", [0], [1])
    with pytest.raises(SceneError, match="2 objects are named 'ball': give each its own name"):
        parse_scene({**twins, "animation": {"tracks": [move]}}, "x")


def test_targets_follow_the_rules_of_toml() -> None:
    assert parse_target('objects."my ball, 2".center') == ("objects", "my ball, 2", "center")
    assert parse_target("materials.a-b_2.roughness") == ("materials", "a-b_2", "roughness")
    with pytest.raises(ValueError, match="is not the name of a value"):
        parse_target("camera." + "a" * 1000)


def test_python_builds_what_a_file_says() -> None:
    line = Track(target="camera.fov", times=(0, 1), values=(40, 50))
    built = Scene.build(
        SCENE["camera"],
        SCENE["objects"],
        materials=SCENE["materials"],
        animation=Animation(fps=4, tracks=(line,)),
    )
    assert built.animation == animated(FOV).animation
    assert built.at_frame(2).camera.fov == 45


def test_an_edited_scene_keeps_its_animation(tmp_path: Path) -> None:
    """The window writes edits into the file, with its comments."""
    file = tmp_path / "cradle.toml"
    file.write_text(find("cradle").read_text())
    scene = load(file)
    moved = scene.camera.model_copy(update={"fov": 50.0})
    assert write_scene(scene.model_copy(update={"camera": moved}), file, file)
    again = load(file)
    assert again.animation == scene.animation
    assert again.camera.fov == 50
    assert "# The right ball swings out" in file.read_text()
