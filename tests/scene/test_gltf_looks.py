"""Looks of glTF files that other programs show otherwise: images in WebP, and backs."""

import io
from pathlib import Path

import pytest
from PIL import Image as Pillow

from glrt.image.sources import load
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from tests.scene.test_lost_looks import told
from tests.support.gltf_files import textured_square


def webp(color: tuple[int, int, int]) -> bytes:
    file = io.BytesIO()
    Pillow.new("RGB", (2, 2), color).save(file, "WEBP", lossless=True)
    return file.getvalue()


def with_webp(folder: Path, content: bytes | None, is_spare: bool = True) -> Scene:
    """A square with a WebP image in a file next to it, and perhaps a PNG image to show instead."""
    builder = textured_square()
    texture, images = builder.json["textures"][0], builder.json["images"]
    builder.add("images", {"uri": "look.webp", "mimeType": "image/webp"})
    texture["extensions"] = {"EXT_texture_webp": {"source": len(images) - 1}}
    if not is_spare:
        del texture["source"]
        builder.json["extensionsRequired"] = ["EXT_texture_webp"]
    builder.json["extensionsUsed"] = ["EXT_texture_webp"]
    if content is not None:
        (folder / "look.webp").write_bytes(content)
    (folder / "thing.glb").write_bytes(builder.glb())
    return load(folder / "thing.glb")


def image_of(scene: Scene) -> str:
    look = scene.materials["thing.glb:painted"]
    assert isinstance(look, Principled)
    return look.color_map.image.file if look.color_map and look.color_map.image else ""


@pytest.mark.parametrize("is_spare", [True, False])
def test_webp_images_of_a_gltf_file_are_read(tmp_path: Path, is_spare: bool) -> None:
    scene = with_webp(tmp_path, webp((255, 0, 0)), is_spare)
    assert image_of(scene) == "look.webp"
    assert "look.webp" in hashes_of(scene)
    assert told(scene) == []


@pytest.mark.parametrize("content", [None, b"RIFF....WEBP"])
def test_an_unreadable_webp_image_gives_way_to_the_spare_one(
    tmp_path: Path, content: bytes | None
) -> None:
    scene = with_webp(tmp_path, content)
    assert image_of(scene) == "thing.glb#0"
    assert told(scene) == []
    assert image_of(with_webp(tmp_path, content, is_spare=False)) == ""


def test_two_images_that_stand_in_for_each_other_end_without_one(tmp_path: Path) -> None:
    builder = textured_square()
    for uri in ("a.webp", "b.webp"):
        builder.add("images", {"uri": uri})
    for first, second in ((1, 2), (2, 1)):
        both = {"source": second, "extensions": {"EXT_texture_webp": {"source": first}}}
        builder.add("textures", both)
    look = builder.json["materials"][0]["pbrMetallicRoughness"]
    look["baseColorTexture"]["index"] = 1
    look["metallicRoughnessTexture"] = {"index": 2}
    (tmp_path / "thing.glb").write_bytes(builder.glb())
    assert image_of(load(tmp_path / "thing.glb")) == ""


@pytest.mark.parametrize("stated", [False, True, None])
def test_backs_that_a_file_leaves_out_are_shown_and_told(
    tmp_path: Path, stated: bool | None
) -> None:
    keys = {} if stated is None else {"doubleSided": stated}
    (tmp_path / "thing.glb").write_bytes(textured_square(**keys).glb())
    hint = ["the hidden backs of 'painted' (backfaces = hidden)"]
    assert told(load(tmp_path / "thing.glb")) == (hint if stated is False else [])
    head = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[background]\ncolor = [1, 1, 1]\n"
    mesh = '[[objects]]\nshape = "mesh"\nfile = "thing.glb"\nbackfaces = "hidden"'
    (tmp_path / "scene.toml").write_text(head + mesh)
    assert told(load(tmp_path / "scene.toml")) == []
