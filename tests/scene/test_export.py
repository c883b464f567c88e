"""Scenes as glTF files: what is written is read again as it was, and the rest is reported."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.cli.main import main
from glrt.comparison.verdict import compare
from glrt.image.sources import load
from glrt.scene.export.gltf import to_gltf
from glrt.scene.export.triangles import AROUND, Ball, corners_around, triangles_of
from glrt.scene.files.assets import AssetFolder
from glrt.scene.loading.scene_files import with_files
from glrt.scene.materials.principled import Principled
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from tests.support.builders import box, cylinder, disk, glass, plane, quad, scene_of, sphere
from tests.support.gltf_files import COLORS, png, textured_square
from tests.support.meshes import icosphere, mesh

CAMERA = {"position": [1, 2, 6], "look_at": [0, 0.5, 0], "up": [0.1, 1, 0], "fov": 35.0}
PAINT: dict[str, Any] = {
    "type": "principled",
    "color": [0.25, 0.5, 0.75],
    "metallic": 0.25,
    "roughness": 0.5,
    "ior": 1.25,
    "specular": 0.5,
    "clearcoat": 0.25,
    "clearcoat_roughness": 0.75,
}
LAMP = {"type": "light", "emission": [8.0, 4.0, 2.0], "group": "l"}


def again(scene: Scene, folder: Path, name: str = "again.glb") -> Scene:
    """The scene after it was written and read."""
    content, _ = to_gltf(scene, name.endswith(".glb"))
    (folder / name).write_bytes(content)
    return load(folder / name)


def left_out(scene: Scene) -> str:
    return ", ".join(to_gltf(scene, True)[1])


def whole(**changes: Any) -> Scene:
    """A scene that glTF holds wholly."""
    ball = mesh(icosphere(2), "paint", scale=[0.5, 0.75, 0.5], rotate=[0, 30, 0])
    parts = [ball, quad([-2, 3, -2], [4, 0, 0], [0, 0, 4], "lamp")]
    parts.append(box([-2, -1, -2], [2, -0.5, 2], "paint", [0, 10, 0]))
    given = {"lights": {"l": 0.5}, "sun": None, **changes}
    return scene_of(parts, {"paint": PAINT, "lamp": LAMP}, CAMERA, **given)


@pytest.mark.parametrize("name", ["again.glb", "again.gltf"])
def test_what_gltf_holds_is_as_it_was(tmp_path: Path, name: str) -> None:
    scene = whole()
    assert left_out(scene) == ""
    read = again(scene, tmp_path, name)
    assert_allclose(read.camera.position, scene.camera.position)
    assert_allclose(_unit(read.camera.view), _unit(scene.camera.view))
    assert_allclose(read.camera.fov, 35)
    paint = read.materials[f"{name}:paint"]
    assert isinstance(paint, Principled)
    for key, value in PAINT.items():
        assert_allclose(getattr(paint, key), value) if key != "type" else None
    lamp = read.materials[f"{name}:lamp"]
    assert isinstance(lamp, Principled)
    assert_allclose(lamp.emission, [4, 2, 1])
    ball = scene.objects[0]
    assert isinstance(ball, Mesh)
    found = next(it for it in read.meshes if it.material == f"{name}:paint")
    count = len(ball.world_vertices)
    assert_allclose(found.triangles.vertices[:count], ball.world_vertices, atol=1e-6)


def _unit(vector: Any) -> Any:
    return np.array(vector) / np.linalg.norm(vector)


def test_textures_of_a_model_are_as_they_were(tmp_path: Path) -> None:
    look = {"alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": True}
    builder = textured_square(**look)
    image = {"index": builder.texture(COLORS, wrapS=33071, wrapT=33648)}
    moved = {"KHR_texture_transform": {"scale": [2, 3], "offset": [0.5, 0], "rotation": 1.0}}
    table = builder.json["materials"][0]
    table["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {**image, "extensions": moved}
    table["normalTexture"] = {**image, "scale": 2}
    table["emissiveTexture"], table["emissiveFactor"] = image, [0.5, 0.25, 0.125]
    (tmp_path / "thing.glb").write_bytes(builder.glb())
    scene = load(tmp_path / "thing.glb")
    read = again(scene, tmp_path)
    old, new = scene.materials["thing.glb:painted"], read.materials["again.glb:thing.glb:painted"]
    assert isinstance(old, Principled)
    assert isinstance(new, Principled)
    assert set(new.textures) == set(old.textures)
    for key, texture in old.textures.items():
        other = new.textures[key]
        assert_allclose(other.transform, texture.transform)
        assert (other.wrap, other.filter, other.uv) == (texture.wrap, texture.filter, texture.uv)
        channels = {"metallic": 2, "roughness": 1, "alpha": 3}
        one = slice(channels[key], channels[key] + 1) if key in channels else slice(3)
        assert np.array_equal(other.texels[..., one], texture.texels[..., one]), key
    assert (new.alpha_cutoff, new.emission) == (old.alpha_cutoff, old.emission)
    assert new.normal is not None
    assert new.normal.strength == 2


def test_a_checkerboard_stays_sharp_among_smooth_images(tmp_path: Path) -> None:
    (tmp_path / "paint.png").write_bytes(png(COLORS))
    board = {"checker": [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], "scale": 3.0}
    looks = {"image": {"image": "paint.png"}, "board": board}
    materials = {name: {"type": "lambertian", "color": it} for name, it in looks.items()}
    parts = [quad([k, 0, 0], [1, 0, 0], [0, 1, 0], name) for k, name in enumerate(looks)]
    scene = scene_of(parts, materials, CAMERA, background={"color": [1, 1, 1]})
    read = again(with_files(scene, AssetFolder(tmp_path), "test"), tmp_path)
    found = {name: read.materials[f"again.glb:{name}"] for name in looks}
    filters = {
        name: it.textures["color"].filter for name, it in found.items() if it.type == "principled"
    }
    assert filters == {"image": "linear", "board": "nearest"}
    texture = found["board"].textures["color"]  # type: ignore[union-attr]
    assert texture.scale == (3, 3)
    assert texture.texels[..., :3].tolist() == [[[1, 0, 0], [0, 0, 1]], [[0, 0, 1], [1, 0, 0]]]


UNIT = Ball(np.zeros(3), 1.0)
SHAPES = {
    "sphere": sphere([0, 0, 0], 0.5, "m"),
    "box": box([-1, 0, 0.1], [0.7, 1.3, 2], "m", [10, 20, 30]),
    "cylinder": cylinder([1, 0, 0], [2, 1, 0.5], 0.3, "m"),
}


@pytest.mark.parametrize("name", SHAPES)
def test_solids_are_closed_and_face_outwards(name: str) -> None:
    scene = scene_of([SHAPES[name]], {"m": glass(1.5)}, CAMERA, background={"color": [1, 1, 1]})
    found = triangles_of(scene.objects[0], UNIT)
    assert found is not None
    points = found.points.astype(np.float32).astype(np.float64)
    solid = TriangleMesh(points, found.faces, found.normals)
    assert solid.opening == ""
    assert solid.outward is solid
    assert found.normals is not None
    corners = points[found.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("nk,nck->nc", across, found.normals[found.faces]) > 0).all()


@pytest.mark.parametrize(("count", "most"), [(1, 96), (108, 96), (480, 44), (65_536, 12)])
def test_what_is_round_has_fewer_corners_where_there_is_much(count: int, most: int) -> None:
    assert corners_around(count) == most
    ball = scene_of([SHAPES["sphere"]], {"m": glass(1.5)}, CAMERA, background={"color": [1, 1, 1]})
    found = triangles_of(ball.objects[0], UNIT, most)
    assert found is not None
    assert len(found.faces) == most * (most - 2)


def test_coordinates_of_flat_and_round_shapes_are_those_of_textures() -> None:
    parts = [
        sphere([0, 0, 0], 1, "m"),
        disk([0, 1, 0], [0, 1, 1], 2, "m"),
        plane([0, 0, 1], [1, 2, 3], "m"),
    ]
    scene = scene_of(parts, {"m": PAINT}, CAMERA, background={"color": [1, 1, 1]})
    ball, flat, ground = (triangles_of(it, UNIT) for it in scene.objects)
    assert ball is not None
    assert ball.uv is not None
    x, y, z = ball.points.T
    inside = (np.abs(y) < 0.999) & (ball.uv[:, 0] > 0) & (ball.uv[:, 0] < 1)
    assert_allclose(ball.uv[inside, 0], np.arctan2(x, -z)[inside] / (2 * np.pi) + 0.5, atol=1e-9)
    assert_allclose(ball.uv[:, 1], np.arccos(y.clip(-1, 1)) / np.pi, atol=1e-7)
    assert len(ball.uv) == (AROUND + 1) * (AROUND // 2 + 1)
    for thing, found in zip(scene.objects[1:], (flat, ground), strict=True):
        assert found is not None
        assert found.uv is not None
        axes: Any = thing.texture_axes
        expected = (found.points - axes.origin) @ np.stack([axes.u, axes.v], axis=1)
        assert_allclose(found.uv, expected, atol=1e-9)


def test_what_gltf_cannot_hold_is_reported() -> None:
    camera = CAMERA | {"defocus_angle": 3.0}
    materials = {
        "m": {"type": "metal", "color": [0.9, 0.9, 0.9]},
        "g": glass(1.5, priority=1),
        "spot": LAMP | {"cone": {"axis": [0, -1, 0], "inner": 10, "outer": 20}},
    }
    lamp = quad([-2, 3, -2], [4, 0, 0], [0, 0, 4], "spot") | {"emission_side": "front"}
    parts = [plane([0, -1, 0], [0, 1, 0], "m"), sphere([0, 0, 0], 1, "g"), lamp]
    sun = {"elevation": 30.0, "irradiance": [1.0, 1.0, 1.0], "angle": 2.0}
    said = left_out(scene_of(parts, materials, camera, background={"color": [1, 1, 1]}, sun=sun))
    for words in (
        "defocus",
        "a plane",
        "roundness of a sphere",
        "priority of 'g'",
        "cone of 'spot'",
    ):
        assert words in said
    for words in ("dark backs of 'spot'", "angles of 'm'", "background", "width of the sun, 2"):
        assert words in said


def read_again(scene: Scene, folder: Path) -> list[Principled]:
    """The principled materials of a scene after it was written and read."""
    found = again(scene, folder).materials.values()
    return [it for it in found if isinstance(it, Principled)]


def test_anisotropy_is_read_again_and_its_direction_on_a_box_is_reported(tmp_path: Path) -> None:
    brushed = PAINT | {"anisotropy": 0.5, "anisotropy_rotation": 90.0}
    ball = mesh(icosphere(1), "paint")
    scene = scene_of([ball], {"paint": brushed}, CAMERA)
    assert left_out(scene) == ""
    found = read_again(scene, tmp_path)[-1]
    assert found.anisotropy == 0.5
    assert found.anisotropy_rotation == pytest.approx(90)
    steel = {"type": "metal", "color": [1, 1, 1], "roughness": 0.5, "anisotropy": 0.25}
    parts = [ball, box([-2, -1, -2], [2, -0.5, 2], "steel")]
    scene = scene_of(parts, {"paint": brushed, "steel": steel}, CAMERA)
    assert "the direction of anisotropy on 'box 1', a box" in left_out(scene)
    assert [it.anisotropy for it in read_again(scene, tmp_path)] == [0.5, 0.25]


def test_a_thin_film_is_read_again(tmp_path: Path) -> None:
    film = {"iridescence": 0.5, "iridescence_ior": 1.75, "iridescence_thickness": 250.0}
    scene = scene_of([mesh(icosphere(1), "paint")], {"paint": PAINT | film}, CAMERA)
    assert left_out(scene) == ""
    found = read_again(scene, tmp_path)[-1]
    assert {key: getattr(found, key) for key in film} == film


def test_sheen_is_read_again(tmp_path: Path) -> None:
    cloth = {"sheen": (0.5, 0.25, 1.0), "sheen_roughness": 0.75}
    scene = scene_of([mesh(icosphere(1), "paint")], {"paint": PAINT | cloth}, CAMERA)
    assert left_out(scene) == ""
    found = read_again(scene, tmp_path)[-1]
    assert {key: getattr(found, key) for key in cloth} == cloth


def test_diffuse_transmission_is_read_again(tmp_path: Path) -> None:
    leaf = {"diffuse_transmission": 0.5, "diffuse_transmission_color": (0.5, 0.25, 1.0)}
    scene = scene_of([mesh(icosphere(1), "paint")], {"paint": PAINT | leaf}, CAMERA)
    assert left_out(scene) == ""
    found = read_again(scene, tmp_path)[-1]
    assert {key: getattr(found, key) for key in leaf} == leaf


def test_dispersion_is_read_again(tmp_path: Path) -> None:
    clear = PAINT | {"clearcoat": 0.0, "transmission": 1.0, "roughness": 0.0, "dispersion": 0.5}
    flint = glass(1.75, dispersion=0.25)
    parts = [mesh(icosphere(1), "paint"), mesh(icosphere(1), "flint", translate=[3, 0, 0])]
    scene = scene_of(parts, {"paint": clear, "flint": flint}, CAMERA)
    assert left_out(scene) == ""
    assert sorted(it.dispersion for it in read_again(scene, tmp_path)) == [0.25, 0.5]


def test_the_sun_is_read_again(tmp_path: Path) -> None:
    sun = {"direction": [1.0, 2.0, 3.0], "irradiance": [1.0, 2.0, 4.0]}
    read = again(whole(sun=sun, lights={"sun": 0.5}), tmp_path)
    assert read.sun is not None
    assert_allclose(read.sun.towards, _unit([1, 2, 3]), atol=1e-6)
    assert_allclose(read.sun_irradiance, [0.5, 1, 2])


def test_the_command_writes_a_file_and_names_what_it_lacks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "room.glb"
    assert main(["export", "cornell", "-o", str(target)]) == 0
    told = capsys.readouterr()
    assert "left out: the far parts of 'floor', a plane" in told.err
    assert "Wrote" in told.out
    assert load(target).meshes
    assert main(["export", "cornell", "-o", str(tmp_path / "room.abc")]) == 2
    assert "exports .glb, .gltf, .xml (Mitsuba) and .pbrt files" in capsys.readouterr().err


@pytest.mark.slow
def test_a_scene_that_gltf_holds_renders_to_the_same_picture(tmp_path: Path) -> None:
    scene = whole()
    again(scene, tmp_path)
    thing = '[camera]\nfile = "again.glb"\n[[objects]]\nshape = "mesh"\nfile = "again.glb"\n'
    (tmp_path / "again.toml").write_text(thing)  # a model by itself may get a studio
    one, other = (
        glrt.render(it, samples=1024, seed=seed, width=48, height=48)
        for seed, it in enumerate((scene, load(tmp_path / "again.toml")))
    )
    found = compare(one, other)
    assert found.verdict == "same", found.reasons
