"""Grids of densities: files and arrays, where they lie, and what is refused."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.image.sources import load
from glrt.packing.media import pack_media
from glrt.packing.voxel_texture import grids_of
from glrt.plan.facts import SceneFacts
from glrt.scene.files.named_grids import BRICK, MOST_VOXELS, GridFile, decode_grid
from glrt.scene.grids import grid_of, holders_of, placement_of, steps_across
from glrt.scene.loading.scene_files import check_loaded, files_of, hashes_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.scenefile.toml_writer import write_scene
from tests.support.builders import box, plane, scene_of, sphere
from tests.support.media import filled
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import mesh
from tests.support.numerics import Array

SCENE = """
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]

[media.smoke]
scattering = [1, 1, 1]
density = { file = "grids/smoke.npy", scale = 3 }

[[objects]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "none"
medium = "smoke"
"""
BLOCK = mesh(box_of_triangles([0, 0, 0], [4, 2, 2]), "")
CAMERA = {"position": [0, 0, 1], "look_at": [0, 0, 0]}
VALUES = np.random.default_rng(1).uniform(0, 4, (20, 9, 17)).astype(np.float32)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene and its grid."""
    (tmp_path / "grids").mkdir()
    np.save(tmp_path / "grids/smoke.npy", VALUES)
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path


def in_it(thing: dict[str, Any], values: Array = VALUES, **more: Any) -> Scene:
    smoke = glrt.Medium(scattering=(1, 1, 1), density=glrt.Density(values, **more))
    return scene_of([filled(thing, "smoke")], {}, media={"smoke": smoke})


def content(values: Any) -> bytes:
    file = io.BytesIO()
    np.save(file, values)
    return file.getvalue()


# --- files and arrays ------------------------------------------------------------------------


def test_a_scene_is_read_with_its_grid(folder: Path) -> None:
    scene = load(folder / "scene.toml")
    grid = grid_of(scene, "smoke")
    assert grid.top == pytest.approx(3 * VALUES.max())
    assert_allclose(grid.top * grid.voxels.astype(float), 3 * VALUES, rtol=2**-11)
    assert files_of(scene) == ["grids/smoke.npy"]
    assert list(hashes_of(scene)) == ["grids/smoke.npy"]


def test_a_grid_of_other_content_is_another_one(folder: Path) -> None:
    first = load(folder / "scene.toml")
    assert first == load(folder / "scene.toml")
    np.save(folder / "grids/smoke.npy", 2 * VALUES)
    assert first != load(folder / "scene.toml")


def test_an_array_is_saved_with_its_scene(tmp_path: Path) -> None:
    scene = in_it(sphere([0, 0, 0], 1, ""))
    write_scene(scene, tmp_path / "a.toml")
    again = load(tmp_path / "a.toml")
    (file,) = files_of(again)
    assert np.array_equal(np.load(tmp_path / file), VALUES)
    assert np.array_equal(grid_of(again, "smoke").voxels, grid_of(scene, "smoke").voxels)
    first, second = (placement_of(it, "smoke", 0).linear for it in (scene, again))
    assert np.array_equal(first, second)


@pytest.mark.parametrize("dtype", ["float16", "float32", ">f4"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_files_of_both_orders_hold_the_same_grid(dtype: str, order: Any) -> None:
    values = np.asarray(VALUES.astype(dtype), order=order)
    assert np.array_equal(decode_grid(content(values)), values)


def test_the_bound_of_a_brick_holds_between_voxels_too() -> None:
    """A place in a brick depends on voxels one beyond it: they count for both bricks."""
    for voxel, tops in ((BRICK - 1, [1, 1, 0]), (BRICK, [1, 1, 0]), (BRICK + 1, [0, 1, 0])):
        values = np.zeros((20, 3, 3), np.float32)
        values[voxel] = 1.0
        assert GridFile(file="a.npy").read_as("", values, None).tops.ravel().tolist() == tops


# --- places ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("thing", "middle", "corner"),
    [
        (sphere([1, 2, 3], 2, ""), [1, 2, 3], [-1, 0, 1]),
        (box([0, 0, 0], [4, 2, 2], ""), [2, 1, 1], [0, 0, 0]),
        ({**box([0, 0, 0], [4, 2, 2], ""), "rotate": [0, 0, 90]}, [2, 1, 1], [3, -1, 0]),
        ({**BLOCK, "rotate": [0, 0, 90], "scale": 2.0}, [-2, 4, 2], [0, 0, 0]),
    ],
    ids=["sphere", "box", "turned box", "turned mesh"],
)
def test_a_grid_fills_the_box_of_its_object(thing: Any, middle: Any, corner: Any) -> None:
    place, size = placement_of(in_it(thing), "smoke", 0), np.array(VALUES.shape[::-1])
    assert_allclose(place.linear @ middle + place.origin, size / 2, atol=1e-9)
    assert_allclose(place.linear @ corner + place.origin, [0, 0, 0], atol=1e-9)


def test_a_grid_has_a_box_of_its_own() -> None:
    place = placement_of(in_it(sphere([0, 0, 0], 2, ""), min=(0, 0, 0), max=(1, 1, 1)), "smoke", 0)
    assert_allclose(place.linear @ [1, 1, 1] + place.origin, VALUES.shape[::-1])


def test_steps_across_count_bricks_and_collisions() -> None:
    """A cube of edge 2 and even density 3: depth 3 * 2 sqrt(3) on its diagonal."""
    even = np.full((16, 16, 16), 3, np.float32)
    found = steps_across(in_it(box([-1, -1, -1], [1, 1, 1], ""), even), "smoke")
    assert found == 3 * 2 + 11  # 10.4 collisions


# --- refusals --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.zeros((2, 2, 2), np.int32), "type int32, not float16 or float32"),
        (np.zeros((2, 2, 2)), "type float64"),
        (np.zeros((2, 2), np.float32), r"the shape \(2, 2\), not three sizes"),
        (np.zeros((2, 0, 2), np.float32), r"the shape \(2, 0, 2\)"),
        (np.array([[[0, np.nan]]], np.float32), r"voxel \[0, 0, 1\] is not finite"),
        (np.array([[[0], [-1]]], np.float16), r"voxel \[0, 1, 0\] is below 0"),
        (np.array([[[object()]]]), "not float16"),
    ],
    ids=["integers", "doubles", "flat", "empty", "NaN", "negative", "objects"],
)
def test_a_grid_that_holds_no_densities_is_refused(folder: Path, values: Any, message: str) -> None:
    np.save(folder / "grids/smoke.npy", values, allow_pickle=True)
    with pytest.raises(SceneError, match=message) as error:
        load(folder / "scene.toml")
    assert "media.smoke.density.file: grids/smoke.npy: " in str(error.value)


def test_a_header_of_too_many_voxels_allocates_nothing(folder: Path) -> None:
    header = content(np.zeros((1, 1, 1), np.float32)).replace(b"(1, 1, 1)", b"(9999, 9999, 999)")
    (folder / "grids/smoke.npy").write_bytes(header)
    with pytest.raises(SceneError, match=f"and {MOST_VOXELS:,} are the most"):
        load(folder / "scene.toml")


@pytest.mark.parametrize(
    "damage", [lambda it: it[:-1], lambda it: it + b"\0", lambda it: it[:9], lambda it: b"PK" + it]
)
def test_a_damaged_file_is_refused(folder: Path, damage: Any) -> None:
    (folder / "grids/smoke.npy").write_bytes(damage(content(VALUES)))
    with pytest.raises(SceneError, match=r"smoke\.npy: .* (?:Write|Scale)"):
        load(folder / "scene.toml")


def test_a_grid_lies_in_each_object_that_its_medium_fills() -> None:
    """Its voxels are kept once, and so are those of another medium with the same grid."""
    ball, grid = sphere([0, 0, 0], 1, ""), glrt.Density(VALUES)
    smoke = {it: glrt.Medium(scattering=(1, 1, 1), density=grid) for it in ("smoke", "ash")}
    balls = [{**ball, "center": [x, 0, 0]} for x in (0, 5, 9)]
    three = [filled(it, name) for it, name in zip(balls, ("smoke", "smoke", "ash"), strict=True)]
    found = scene_of(three, {}, media=smoke)
    check_loaded(found)
    assert [holders_of(found, name) for name in smoke] == [(0, 1), (2,)]
    rows = pack_media(SceneFacts(found))
    assert rows["Medium"]["first"].tolist() == [0, 0, 0]
    assert [it.sha256 for it in grids_of(SceneFacts(found))] == [grid.file.sha256]
    places = rows["Medium"]["at_x"] / rows["Medium"]["x"][:, 0]
    assert_allclose(places, [1, -4, -8])  # the lowest corner, from the camera, which is at 0
    assert rows["Boundary"]["inside"].tolist() == [0, 1, 2]


@pytest.mark.parametrize("medium", [None, "smoke"])
def test_a_grid_in_endless_space_needs_a_box(medium: str | None) -> None:
    smoke = glrt.Medium(scattering=(1, 1, 1), density=glrt.Density(VALUES))
    ground = [] if medium else [filled(plane([0, -1, 0], [0, 1, 0], ""), "smoke")]
    sky = {"color": [1, 1, 1]}
    found = scene_of(ground, {}, media={"smoke": smoke}, medium=medium, background=sky)
    with pytest.raises(SceneError, match=r"media\.smoke\.density\.min: is missing"):
        check_loaded(found)


def test_a_scene_without_its_grid_is_not_rendered() -> None:
    smoke = {"scattering": [1, 1, 1], "density": {"file": "a.npy"}}
    ball = filled(sphere([0, 0, 0], 1, ""), "smoke")
    found = parse_scene({"camera": CAMERA, "media": {"smoke": smoke}, "objects": [ball]}, "a")
    with pytest.raises(SceneError, match=r"smoke\.density\.file: the file a\.npy was not read"):
        glrt.render(found, samples=1)
