"""A camera of a glTF file in the window: moved, saved, and read again."""

from pathlib import Path

import pytest

from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.view.edits.file_camera import seen_as_before, to_be_saved
from glrt.view.viewport import orbit
from tests.scene.test_file_cameras import cameras, scene_of


@pytest.fixture
def moving(tmp_path: Path) -> Scene:
    (tmp_path / "cams.glb").write_bytes(cameras().glb())
    return scene_of(tmp_path, 'node = "crane"', "fov = 20.0")


def flown(scene: Scene) -> Scene:
    there = orbit.moved(scene.camera, 1, 2, 3)
    return scene.model_copy(update={"camera": there})


def test_a_moved_camera_leaves_its_place_in_the_file(moving: Scene) -> None:
    found = flown(moving).camera
    assert found.position != moving.camera.position
    assert found.fov == 20
    assert dict(found)["position"] == found.position, "a picture of it can be rendered again"


def test_a_save_keeps_the_motion_of_a_camera_that_was_moved(moving: Scene) -> None:
    kept = to_be_saved(flown(moving), moving.camera)
    assert kept.at_frame(48).camera.position == (2, 0, 3)
    assert flown(moving).at_frame(48).camera.position != (2, 0, 3), "a place of its own stays"
    assert kept.camera.fov == 20


def test_a_save_keeps_the_place_of_a_camera_that_stands(tmp_path: Path) -> None:
    (tmp_path / "cams.glb").write_bytes(cameras().glb())
    scene = flown(scene_of(tmp_path, 'node = "still"'))
    kept = to_be_saved(scene, load(tmp_path / "scene.toml").camera)
    assert kept.camera.position == scene.camera.position


def test_a_reload_follows_the_file_unless_the_camera_was_moved(moving: Scene) -> None:
    path = Path(str(moving.camera.file.origin)).parent if moving.camera.file else Path()
    builder = cameras()
    builder.json["nodes"][3]["translation"] = [0, 0, 7]
    (path / "cams.glb").write_bytes(builder.glb())
    found = load(path / "scene.toml")
    assert seen_as_before(found, moving.camera).camera.position == (0, 0, 7)
    there = flown(moving).camera
    after = seen_as_before(found, there).camera
    assert (after.position, after.look_at) == (there.position, there.look_at)
    assert after.file == found.camera.file, "a recipe has one hash for a file"
