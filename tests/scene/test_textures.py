"""Textures in scene files: read, checked, written back, and their images."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.image.sources import load
from glrt.scene.images.texture_sizes import reduced, sizes_of
from glrt.scene.loading.scene_files import files_of, hashes_of
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.textures import Texture
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict
from tests.support.builders import box, cylinder, scene_of, sphere
from tests.support.gltf_files import png
from tests.support.meshes import icosphere, mesh

BALL = sphere([0, 0, -3], 1, "m")
CODES = np.array([[[0, 255, 188], [51, 102, 10]], [[1, 2, 3], [128, 64, 32]]], np.uint8)
LINEAR = np.where(
    CODES / 255 <= 0.04045, CODES / 255 / 12.92, ((CODES / 255 + 0.055) / 1.055) ** 2.4
)


def scene_with(**keys: Any) -> Scene:
    return scene_of([BALL], {"m": {"type": "principled", **keys}})


TEXTURES: dict[str, dict[str, Any]] = {
    "an image": {"color": {"image": "a.png"}},
    "a checkerboard": {"color": {"checker": [[1, 0, 0], [0, 0, 1]], "scale": [2, 3]}},
    "all keys": {
        "roughness": {
            "image": "a.png",
            "channel": "g",
            "factor": 0.5,
            "scale": [2, 3],
            "offset": [0.5, 0],
            "rotation": 30,
            "wrap": "mirror",
            "filter": "nearest",
            "uv": 1,
        }
    },
    "a factor that is the default of its key": {
        "metallic": {"image": "a.png", "factor": 0.0},
        "roughness": {"image": "a.png", "factor": 0.4},
        "emission": {"image": "a.png", "factor": [0, 0, 0]},
    },
    "a normal": {"normal": {"image": "n.png", "strength": 0.5}},
    "alpha that is cut": {"alpha": {"image": "a.png", "channel": "a"}, "alpha_cutoff": 0.5},
}


@pytest.mark.parametrize("name", TEXTURES)
def test_a_scene_is_written_back_as_it_was(name: str, tmp_path: Path) -> None:
    scene = scene_with(**TEXTURES[name])
    assert parse_scene(scene_to_dict(scene), "again") == scene, "as in recipes"
    scene.save(tmp_path / "scene.toml")
    for image in files_of(scene):
        (tmp_path / image).write_bytes(png(CODES))
    again = load(tmp_path / "scene.toml")
    assert scene_to_dict(again) == scene_to_dict(scene), "as in files"


def test_a_key_is_the_factor_of_its_texture() -> None:
    material = scene_with(color={"image": "a.png", "factor": 0.5}).materials["m"]
    assert isinstance(material, Principled)
    assert material.color == (0.5, 0.5, 0.5)
    assert list(material.textures) == ["color"]
    assert scene_with(roughness={"image": "a.png"}).materials["m"].roughness == 1  # type: ignore[union-attr]


def test_python_gives_textures(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(png(CODES))
    material = Lambertian(color=Texture(image="a.png", scale=2, factor=(1, 0.5, 0)))
    scene = Scene.build(
        {"position": [0, 0, 3], "look_at": [0, 0, 0]},
        [glrt.Sphere(center=(0, 0, 0), radius=1, material="m")],
        materials={"m": material},
        folder=tmp_path,
    )
    found = scene.materials["m"]
    assert isinstance(found, Lambertian)
    assert found.color == (1, 0.5, 0)
    texture = found.textures["color"]
    assert texture.scale == (2, 2)
    assert_allclose(texture.texels[..., :3], LINEAR, rtol=1e-3)
    assert (texture.texels[..., 3] == 1).all()


def test_colors_are_decoded_and_numbers_are_not(tmp_path: Path) -> None:
    """The test uses one file as base colour and as roughness."""
    (tmp_path / "a.png").write_bytes(png(CODES))
    scene = scene_with(color={"image": "a.png"}, roughness={"image": "a.png"})
    scene.save(tmp_path / "scene.toml")
    material = load(tmp_path / "scene.toml").materials["m"]
    assert isinstance(material, Principled)
    textures = material.textures
    assert_allclose(textures["color"].texels[..., :3], LINEAR, rtol=1e-3)
    assert_allclose(textures["roughness"].texels[..., :3], CODES / 255, rtol=1e-3)
    assert list(hashes_of(load(tmp_path / "scene.toml"))) == ["a.png"]


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "neither": ({"color": {}}, "materials.m.color must have either image or checker"),
    "both": (
        {"color": {"image": "a", "checker": [0, 1]}},
        "materials.m.color must have either image or checker",
    ),
    "a misspelt key": (
        {"color": {"image": "a", "chanel": "r"}},
        "materials.m.color: unknown key 'chanel'; did you mean 'channel'?",
    ),
    "a factor too high": ({"roughness": {"image": "a", "factor": 2}}, "materials.m.roughness must"),
    "a color too bright": ({"color": {"checker": [0, 2]}}, "materials.m.color.checker[1][0] must"),
    "another wrap": ({"color": {"image": "a", "wrap": "no"}}, "materials.m.color.wrap"),
    "a key that is none": ({"color_map": {"image": "a"}}, "color_map is no key"),
    "a normal of a checkerboard": ({"normal": {"checker": [0, 1]}}, "must be an image"),
    "a key without textures": ({"ior": {"image": "a"}}, "materials.m.ior must be a number"),
    "a lamp with holes": (
        {"alpha": {"image": "a"}, "emission": [1, 1, 1]},
        "a lamp has no alpha",
    ),
    "metallic glass": (
        {"metallic": {"image": "a"}, "transmission": 0.5},
        "metallic as a texture with transmission is not known",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_reported_by_its_key(name: str) -> None:
    keys, message = WRONG[name]
    with pytest.raises(SceneError) as caught:
        scene_with(**keys)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "thing", [box([0, 0, 0], [1, 1, 1], "m"), cylinder([0] * 3, [1] * 3, 1, "m")]
)
def test_what_has_no_coordinates_is_refused(thing: dict[str, Any]) -> None:
    message = rf"objects\[0\].material: has a texture, and a {thing['shape']} has no texture"
    with pytest.raises(SceneError, match=message):
        scene_of([thing], {"m": {"type": "lambertian", "color": {"checker": [0, 1]}}})


def test_a_mesh_without_coordinates_is_refused(tmp_path: Path) -> None:
    board = {"m": {"type": "lambertian", "color": {"checker": [0, 1]}}}
    scene_of([mesh(icosphere(0), "m")], board).save(tmp_path / "scene.toml")
    with pytest.raises(SceneError, match=r"mesh-\w+.ply has no texture coordinates"):
        load(tmp_path / "scene.toml")


def test_coordinates_of_arrays_are_saved_with_their_mesh(tmp_path: Path) -> None:
    points, faces = icosphere(1)
    uv = points[:, :2] / 3
    board = {"m": {"type": "lambertian", "color": {"checker": [0, 1]}}}
    scene_of([mesh((points, faces), "m", uv=uv)], board).save(tmp_path / "scene.toml")
    (found,) = load(tmp_path / "scene.toml").meshes
    assert found.triangles.uv is not None
    assert_allclose(found.triangles.uv, np.tile(uv, (1, 2)), atol=1e-15)


@pytest.mark.parametrize(
    ("uv", "message"),
    [
        (np.zeros((4, 3)), r"uv must be an array of numbers of shape \(n, 2\)"),
        (np.zeros((3, 2)), "it has 3 texture coordinates for 4 vertices"),
        (np.full((4, 2), np.nan), "the texture coordinates of vertex 0 are no numbers"),
    ],
)
def test_wrong_coordinates_are_refused(uv: Any, message: str) -> None:
    points = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    with pytest.raises(ValueError, match=message):
        glrt.Mesh(points, [[0, 1, 2], [1, 2, 3]], uv=uv, material="m")


def test_a_missing_image_is_reported_with_its_key(tmp_path: Path) -> None:
    scene_with(color={"image": "wood.png"}).save(tmp_path / "scene.toml")
    with pytest.raises(SceneError, match=r"materials.m.color.image: there is no file 'wood.png'"):
        load(tmp_path / "scene.toml")


def test_large_images_are_halved_until_there_is_room() -> None:
    assert sizes_of([(100, 100), (8192, 4096)]) == [(100, 100), (8192, 4096)]
    assert sizes_of([(100, 100), (16384, 8191)]) == [(100, 100), (8192, 4095)]
    assert sizes_of([(1, 1)]) == [(1, 1)]


@pytest.mark.parametrize("size", [(4, 4), (5, 7), (1, 6)])
def test_halved_images_have_means_of_their_pixels(size: tuple[int, int]) -> None:
    image = np.random.default_rng(1).random((*size, 4)).astype(np.float16)
    height, width = (max(length // 2, 1) for length in size)
    found = reduced(image, (height, width)).astype(float)
    rows = image[: max(2 * height, 1)][: size[0]].astype(float)
    expected = [
        [rows[2 * y : 2 * y + 2, 2 * x : 2 * x + 2].mean(axis=(0, 1)) for x in range(width)]
        for y in range(height)
    ]
    assert_allclose(found, expected, rtol=2e-3)
