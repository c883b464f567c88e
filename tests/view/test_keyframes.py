"""Frames of an animation in the window: shown without an edit, keys set and deleted, and saved."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from glrt.core.errors import SceneError, UsageError
from glrt.image.sources import load
from glrt.scene.animation.tracks import Animation, Track
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.view.controls import replaced
from glrt.view.edits.edited_state import State, plain
from glrt.view.edits.editing import Editing
from glrt.view.edits.keyframes import (
    at_frame,
    frames_of_keys,
    last_frame,
    rested,
    target_of,
    value_of,
    values_with_keys,
    with_key,
    without_key,
)
from glrt.view.edits.scene_edits import with_object
from glrt.view.edits.unsaved import is_edited
from glrt.view.timeline import Timeline
from tests.support.builders import MATTE, box, scene_of, sphere

CENTER = ("objects", "ball", "center")
LIGHTS: Any = {"background": {"color": [1, 1, 1]}}


def ball(name: str | None = "ball") -> Scene:
    thing = sphere([0, 0, -5], 1.0, "m") | ({"name": name} if name else {})
    return scene_of([thing], {"m": MATTE}, **LIGHTS)


def moving() -> Scene:
    track = Track(target="objects.ball.center", times=(0, 1), values=((0, 0, -5), (4, 0, -5)))
    return replaced(ball(), animation=Animation(fps=4, tracks=(track,)))


def test_a_frame_has_the_bits_of_the_frame_that_is_rendered() -> None:
    scene = moving()
    shown = at_frame(scene, 3)
    assert shown.objects == scene.at_frame(3).objects
    assert shown.animation == scene.animation
    assert value_of(at_frame(scene, 99), CENTER) == (4, 0, -5)
    assert at_frame(ball(), 7) == ball()


def test_a_key_for_angles_in_a_track_of_quaternions_is_a_quaternion() -> None:
    """The object is turned at frame 2 and set; before, nothing turns."""
    keys = ("objects", "crate", "rotate")
    crate = {**box([0, 0, -5], [1, 1, 1], "m"), "name": "crate"}
    track = Track(target="objects.crate.rotate", times=(0,), values=((0, 0, 0, 1),))
    scene = replaced(
        scene_of([crate], {"m": MATTE}, **LIGHTS), animation=Animation(fps=4, tracks=(track,))
    )
    turned = with_object(scene, 0, replaced(scene.objects[0], rotate=(0.0, 90.0, 0.0)))
    found = with_key(turned, keys, 2)
    assert frames_of_keys(found, keys) == [0, 2]
    assert found.animation
    half = 0.5**0.5
    assert found.animation.tracks[0].values[1] == pytest.approx((0, half, 0, half))
    assert value_of(at_frame(found, 1), keys) == pytest.approx((0, 45, 0), abs=1e-9)
    assert value_of(at_frame(found, 2), keys) == pytest.approx((0, 90, 0), abs=1e-9)


def test_a_frame_that_is_shown_is_no_edit_and_changes_no_saved_value() -> None:
    scene = moving()
    shown = at_frame(scene, 3)
    assert is_edited(scene, shown)
    assert not is_edited(scene, rested(shown, scene))
    assert rested(shown, scene).objects == scene.objects
    other = replaced(shown, materials={"m": replaced(shown.materials["m"], color=(0, 0, 0))})
    assert is_edited(scene, rested(other, scene))


def test_a_key_makes_animation_and_track_and_the_next_one_is_sorted_in() -> None:
    scene = with_key(ball(), CENTER, 24)
    assert scene.animation
    assert scene.animation.tracks[0].times == (1.0,)
    aside = with_key(moved(scene, 2.0), CENTER, 12)
    first = with_key(moved(aside, 7.0), CENTER, 0)
    assert first.animation
    track = first.animation.tracks[0]
    assert track.times == (0, 0.5, 1)
    assert track.values == ((7, 0, -5), (2, 0, -5), (0, 0, -5))
    assert frames_of_keys(first, CENTER) == [0, 12, 24]
    assert frames_of_keys(first, ("camera", "fov")) == []
    again = with_key(moved(first, 3.0), CENTER, 12)
    assert again.animation
    assert again.animation.tracks[0].values[1] == (3, 0, -5)
    assert value_of(at_frame(again, 6), CENTER) == (5, 0, -5)


def moved(scene: Scene, x: float) -> Scene:
    return replaced(scene, objects=(replaced(scene.objects[0], center=(x, 0, -5)),))


def test_the_last_key_of_a_track_takes_it_along() -> None:
    scene = without_key(moving(), CENTER, 4)
    assert scene.animation
    assert scene.animation.tracks[0].times == (0,)
    assert without_key(scene, CENTER, 3) == scene
    scene = without_key(scene, CENTER, 0)
    assert scene.animation == Animation(fps=4)


def test_objects_without_a_name_get_the_one_that_the_list_shows() -> None:
    scene = ball(name=None)
    keys = next(it for it in values_with_keys(scene, 0) if it[-1] == "center")
    assert keys == ("objects", "sphere", "center")
    named = with_key(scene, keys, 0, selected=0)
    assert named.objects[0].name == "sphere"
    assert named.moved == [keys]


def test_values_of_selection_camera_and_light_can_have_keys() -> None:
    found = values_with_keys(moving(), 0)
    assert found[0] == CENTER
    assert {("objects", "ball", "radius"), ("materials", "m", "color")} <= {*found}
    assert {("camera", "fov"), ("lights", "background")} <= {*found}
    assert not any(key[-1] in ("hidden", "name", "material", "type") for key in found)
    assert not any(keys[0] == "objects" for keys in values_with_keys(ball(), None))
    with pytest.raises(UsageError, match=r"objects\.ball\.name"):
        with_key(ball(), ("objects", "ball", "name"), 0)
    assert target_of(("objects", "my ball", "center")) == 'objects."my ball".center'


def test_there_is_room_for_a_second_after_the_last_key() -> None:
    assert last_frame(ball()) == 24
    assert last_frame(moving()) == 4 + 4
    animation = moving().animation
    assert animation
    assert last_frame(replaced(moving(), animation=replaced(animation, frames=3))) == 2


def test_keys_are_saved_with_the_comments_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "ball.toml"
    write_scene(ball(), file)
    file.write_text(f"# by hand\n{file.read_text()}")
    scene = load(str(file))
    edited = with_key(moved(with_key(scene, CENTER, 0), 3.0), CENTER, 12)
    assert write_scene(rested(edited, scene), file, file)
    assert file.read_text().startswith("# by hand\n")
    table = tomllib.loads(file.read_text())
    assert table["animation"]["tracks"][0]["times"] == [0.0, 0.5]
    assert table["objects"][0]["center"] == [0.0, 0.0, -5.0], "the value that stood there"
    assert value_of(load(str(file)).at_frame(12), CENTER) == (3, 0, -5)


@pytest.fixture
def played() -> tuple[Timeline, Any]:
    """A timeline of a session without a renderer."""
    session: Any = Editing(State(moving(), plain(moving().render)))
    vars(session).update(is_behind=False, is_shown=True)
    return Timeline(session), session


def test_playback_shows_frames_at_their_time_and_begins_again(played: tuple[Timeline, Any]) -> None:
    line, session = played
    line.play(10.0)
    seen = list[int]()
    for now in (10.1, 10.26, 10.3, 10.52, 11.03, 11.29):
        line.follow(now)
        seen.append(line.frame)
    assert seen == [0, 1, 1, 2, 4, 0]
    session.is_behind = True
    line.follow(20.0)
    assert line.frame == 0, "the frame before has no sample yet"
    session.is_behind = False
    line.play(20.0)
    line.follow(30.0)
    assert line.frame == 0


def test_frames_are_no_steps_of_undo_and_keys_are(played: tuple[Timeline, Any]) -> None:
    line, session = played
    line.show(3)
    assert value_of(session.scene, CENTER) == (3, 0, -5)
    assert not session.history.can_undo
    session.edit(with_key(session.scene, ("camera", "fov"), 3))
    session.undo()
    assert session.scene.moved == [CENTER]


def test_a_frame_that_cannot_be_shown_is_reported(played: tuple[Timeline, Any]) -> None:
    line, session = played
    line.play(0.0)
    session.show(replaced(session.scene, animation=Animation(tracks=(low(),))))
    with pytest.raises(SceneError, match="frame 12"):
        at_frame(session.scene, 12)
    before = session.scene
    line.show(12)
    assert "fov" in session.problem
    assert session.scene is before
    assert not line.is_playing


def low() -> Track:
    """A curve that leaves the range of its value between two keys."""
    values = 100, 1, 1, 100
    return Track(target="camera.fov", times=(0, 0.4, 0.6, 1), values=values, interpolation="cubic")
