"""Images that are dropped on an object and become its color; no window, no OpenGL."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError, UsageError
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.image.sources import load
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.settings import Settings
from glrt.view.edits.texture_images import is_texture, with_texture_image
from tests.support.builders import box, glass, scene_of, sphere
from tests.support.image_bytes import COLOR, png
from tests.support.meshes import mesh

RED = png(np.full((2, 4, 3), (255, 0, 0), np.uint8), COLOR)
TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
GOLD = {"type": "metal", "preset": "gold", "roughness": 0.2}


@pytest.fixture
def image(tmp_path: Path) -> Path:
    file = tmp_path / "images" / "red.png"
    file.parent.mkdir()
    file.write_bytes(RED)
    return file


def room(*objects: Any, **materials: Any) -> Scene:
    return scene_of(list(objects), materials)


def matte() -> dict[str, Any]:
    return {"type": "lambertian", "color": [0.2, 0.3, 0.4]}


def texture_of(scene: Scene, index: int) -> Any:
    material: Any = scene.materials[scene.objects[index].material]
    return material.color_map


def test_an_image_is_the_color_of_one_object_alone(image: Path) -> None:
    before = room(sphere([0, 0, 0], 1, "m"), sphere([3, 0, 0], 1, "m"), m=matte())
    after = with_texture_image(before, 1, image)
    texels = texture_of(after, 1).image.texels
    np.testing.assert_array_equal(texels[0, 0], [1, 0, 0, 1])
    material = after.materials[after.objects[1].material]
    assert isinstance(material, Lambertian)
    assert material.color == (1, 1, 1), "the image is not tinted"
    assert after.objects[0] == before.objects[0]
    assert after.materials["m"] == before.materials["m"]


def test_an_image_takes_the_place_of_another(image: Path) -> None:
    before = room(sphere([0, 0, 0], 1, "m"), m=matte())
    once = with_texture_image(before, 0, image)
    other = image.with_name("other.png")
    other.write_bytes(RED)
    twice = with_texture_image(once, 0, other)
    assert twice.materials.keys() == {"m"}, "nobody shares it"
    assert texture_of(twice, 0).image.file == "other.png"


def test_a_measured_metal_reflects_by_the_image_alone(image: Path) -> None:
    after = with_texture_image(room(sphere([0, 0, 0], 1, "m"), m=GOLD), 0, image)
    material = after.materials["m"]
    assert isinstance(material, Metal)
    assert (material.preset, material.roughness) == (None, 0.2)
    assert texture_of(after, 0).image.file == "red.png"


@pytest.mark.parametrize(
    ("shape", "material", "told"),
    [
        (sphere([0, 0, 0], 1, "m"), glass(), "dielectric"),
        (box([0, 0, 0], [1, 1, 1], "m"), matte(), "a box"),
        (mesh(TRIANGLE, "m"), matte(), "coordinates"),
    ],
    ids=["glass", "box", "mesh"],
)
def test_objects_that_take_no_image_are_refused_by_name(
    image: Path, shape: Any, material: Any, told: str
) -> None:
    with pytest.raises(UsageError, match=told):
        with_texture_image(room(shape, m=material), 0, image)


@pytest.mark.parametrize("content", [b"", b"no image", RED[:50]])
def test_what_is_no_image_is_refused(image: Path, content: bytes) -> None:
    image.write_bytes(content)
    with pytest.raises(SceneError, match=r"red\.png"):
        with_texture_image(room(sphere([0, 0, 0], 1, "m"), m=matte()), 0, image)


def test_a_save_copies_the_image_next_to_the_scene(image: Path) -> None:
    after = with_texture_image(room(sphere([0, 0, 0], 1, "m"), m=matte()), 0, image)
    file = image.parents[1] / "mine.toml"
    write_scene(after, file)
    assert file.with_name("red.png").read_bytes() == RED
    assert load(file) == after


def test_a_picture_with_a_recipe_is_no_texture(image: Path) -> None:
    names = ("a.jpg", "A.JPEG", "a.webp", "a.toml", "a.exr", "a.hdr", "a.glb", "missing.png")
    found = [is_texture(image.with_name(name)) for name in names]
    assert found == [True, True, True, *[False] * 5]
    assert is_texture(image)
    scene = load("cornell")
    recipe = Recipe(scene=scene, settings=Settings(), samples=1, version="0", renderer="")
    black = np.zeros((1, 1, 3), np.float32)
    Image(black, black, 1, recipe).save(image)
    assert not is_texture(image)
