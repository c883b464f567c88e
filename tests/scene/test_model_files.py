"""Models of every format as scenes, with the files that lie next to them."""

from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from glrt import Renderer
from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.loading import scene_files
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.gltf_files import COLORS, png, textured_square
from tests.support.renders import rendered, same

FORMATS = {
    "thing.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "thing.stl": b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    b"vertex 0 1 0\nendloop\nendfacet\nendsolid x\n",
}


@pytest.mark.parametrize("name", FORMATS)
def test_models_without_materials_are_of_clay(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(FORMATS[name])
    scene = load(tmp_path / name)
    assert [mesh.material for mesh in scene.meshes] == ["clay"]
    assert scene.title == name


def test_an_obj_file_has_its_image(tmp_path: Path) -> None:
    (tmp_path / "thing.obj").write_text(
        "mtllib thing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wood\n"
        "f 1/1 2/2 3/3\n"
    )
    (tmp_path / "thing.mtl").write_text("newmtl wood\nKd 0 0 0\nmap_Kd wood.png\n")
    (tmp_path / "wood.png").write_bytes(png(COLORS))
    scene = load(tmp_path / "thing.obj")
    (mesh,) = scene.meshes
    assert mesh.triangles.uv is not None
    places = mesh.triangles.vertices[:, :2] * [1, -1] + [0, 1]
    assert_allclose(mesh.triangles.uv[:, :2], places, atol=1e-12), "v grows downwards"
    assert sorted(hashes_of(scene)) == ["thing.obj", "wood.png"]
    (tmp_path / "wood.png").unlink()
    told = load(tmp_path / "thing.obj")
    assert "map_Kd" in " ".join(cautions(told, settings_for(told.render)))


@pytest.mark.slow
def test_a_saved_model_has_the_same_picture_elsewhere(tmp_path: Path, context: Context) -> None:
    """The files that it needs are saved with it."""
    builder = textured_square()
    (tmp_path / "thing.gltf").write_bytes(builder.gltf("data/thing.bin"))
    (tmp_path / "data").mkdir()
    (tmp_path / "data/thing.bin").write_bytes(builder.binary)
    scene = load(tmp_path / "thing.gltf")
    assert sorted(hashes_of(scene)) == ["data/thing.bin", "thing.gltf"]
    (tmp_path / "other").mkdir()
    scene.save(tmp_path / "other/scene.toml")
    assert sorted(path.name for path in (tmp_path / "other").rglob("*")) == [
        *("data", "scene.toml", "thing.bin", "thing.gltf"),
    ]
    again = load(tmp_path / "other/scene.toml")
    assert same(rendered(scene, context, 4), rendered(again, context, 4))


def test_a_missing_buffer_is_reported_with_the_name_of_its_file_once(tmp_path: Path) -> None:
    (tmp_path / "thing.gltf").write_bytes(textured_square().gltf("away.bin"))
    with pytest.raises(SceneError) as refused:
        load(tmp_path / "thing.gltf")
    assert str(refused.value).startswith(f"{tmp_path}/thing.gltf: there is no file 'away.bin'")


def test_an_image_file_next_to_a_gltf_is_named_itself(tmp_path: Path) -> None:
    builder = textured_square()
    builder.json["images"] = [{"uri": "a%20b.png"}]
    (tmp_path / "models").mkdir()
    (tmp_path / "models/thing.gltf").write_bytes(builder.gltf())
    (tmp_path / "models/a b.png").write_bytes(png(COLORS))
    camera = "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n"
    objects = '[[objects]]\nshape = "mesh"\nfile = "models/thing.gltf"\n'
    (tmp_path / "scene.toml").write_text(camera + objects)
    scene = load(tmp_path / "scene.toml")
    assert sorted(hashes_of(scene)) == ["models/a b.png", "models/thing.gltf"]


def test_files_outside_are_refused(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    builder = textured_square()
    (tmp_path / "thing.bin").write_bytes(builder.binary)
    path = tmp_path / "inner/thing.gltf"
    path.write_bytes(builder.gltf("../thing.bin"))
    with pytest.raises(SceneError, match="lies outside the folder"):
        load(path)
    assert load(path, allow_outside=True).meshes


def test_a_texture_stays_on_the_driver_through_edits(tmp_path: Path, context: Context) -> None:
    (tmp_path / "thing.glb").write_bytes(textured_square().glb())
    scene = load(tmp_path / "thing.glb")
    renderer = Renderer(scene, context=context, width=16, height=16)
    renderer.step(4)
    camera = scene.camera.model_copy(update={"fov": 20.0})
    moved = scene.model_copy(update={"camera": camera})
    renderer.update(moved)
    renderer.step(4)
    found = renderer.image()
    renderer.release()
    fresh = Renderer(moved, context=context, width=16, height=16)
    fresh.step(4)
    assert same(found, fresh.image())
    fresh.release()


def test_too_many_triangles_of_all_meshes_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each file alone has room; meshes that are kept once count once."""
    monkeypatch.setattr(scene_files, "MOST_TRIANGLES", 5)
    (tmp_path / "thing.glb").write_bytes(textured_square().glb())
    camera = "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n"
    one = '[[objects]]\nshape = "mesh"\nfile = "thing.glb"\n'
    apart = "translate = [3, 0, 0]\n"
    (tmp_path / "scene.toml").write_text(camera + one + one + apart)
    assert len(load(tmp_path / "scene.toml").meshes) == 2
    (tmp_path / "scene.toml").write_text(camera + 3 * one)
    with pytest.raises(SceneError, match="the meshes of this scene have 6 triangles"):
        load(tmp_path / "scene.toml")
