"""`glrt.show`: what it takes, what it refuses, and the settings of its pictures."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import glrt
from glrt.core.errors import SceneError, UsageError
from glrt.notebook.show import shown_settings
from glrt.notebook.sources import scene_of
from glrt.scene.images.codes import decode_srgb
from tests.support.mixed_scene import everything

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def test_a_scene_a_name_and_a_path_are_what_load_gives(tmp_path: Path) -> None:
    scene = glrt.load("cornell")
    assert scene_of(scene) is scene
    assert scene_of("cornell") == scene
    scene.save(tmp_path / "room.toml")
    assert scene_of(tmp_path / "room.toml") == glrt.load(tmp_path / "room.toml")
    with pytest.raises(SceneError, match="cornel"):
        scene_of("cornel")


def test_arrays_stand_in_a_studio_and_in_the_picture() -> None:
    scene = scene_of(1000 * VERTICES, FACES)
    (mesh,) = scene.meshes
    assert mesh.triangles_of_file.vertices.max() == 1000
    assert {thing.name for thing in scene.objects} == {None, "studio ground", "studio light"}
    camera, middle = scene.camera, mesh.middle
    assert camera.look_at == pytest.approx(middle)
    half = np.sin(np.radians(camera.fov) / 2)
    assert np.linalg.norm(np.subtract(camera.position, middle)) * half >= mesh.reach * 0.999


def test_a_mesh_of_trimesh_keeps_the_colours_of_its_vertices() -> None:
    codes = [[255, 0, 0], [0, 128, 0], [0, 0, 255], [9, 9, 9]]
    mesh = trimesh.Trimesh(VERTICES, FACES, vertex_colors=codes, process=False)
    given = scene_of(mesh).meshes[0].file.triangles
    assert given is not None
    assert given.colors == pytest.approx(decode_srgb(np.array(codes) / 255))
    plain = scene_of(trimesh.Trimesh(VERTICES, FACES))
    assert plain.meshes[0].triangles_of_file.colors is None
    joined = scene_of(trimesh.Scene([trimesh.creation.box(), mesh]))
    assert len(joined.meshes[0].triangles_of_file.faces) == 12 + 4


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ((VERTICES,), "give faces"),
        ((VERTICES, FACES + 9), "no mesh"),
        ((VERTICES[:, :2], FACES), "no mesh"),
        ((3,), "got int"),
    ],
)
def test_what_is_no_scene_is_refused(given: tuple[Any, ...], text: str) -> None:
    with pytest.raises(UsageError, match=text):
        scene_of(*given)


def test_a_picture_is_small_unless_its_size_is_given() -> None:
    scene = everything()
    wide = scene.model_copy(
        update={"render": scene.render.model_copy(update={"width": 960, "height": 300})}
    )
    assert shown_settings(wide, {}).size == (480, 150)
    assert shown_settings(wide, {"width": 900}).size == (900, 300)
    assert shown_settings(wide, {"samples": 7}).samples == 7


def test_settings_that_a_live_picture_does_without_are_refused_by_name() -> None:
    with pytest.raises(UsageError, match=r"aov, denoise.*glrt\.render"):
        glrt.show("cornell", denoise="nlm", aov=("depth",))
    with pytest.raises(UsageError, match="bounces"):
        glrt.show("cornell", bounces=-1)
    with pytest.raises(UsageError, match="forecast"):
        glrt.show("cornell", error=0)


def test_the_message_without_the_extra_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delitem(sys.modules, "glrt.notebook.widget", raising=False)
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(UsageError, match=r"pip install .*\[notebook\]'"):
        glrt.show("cornell")
