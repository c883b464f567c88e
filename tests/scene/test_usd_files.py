"""USD files as files: layers, packages, damage, and without usd-core."""

import random
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import glrt
from glrt.core.errors import SceneError
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.model_files.conversion import process
from tests.support.gltf_files import COLORS, png
from tests.support.usd_files import (
    COORDINATES,
    layer,
    left_out,
    moved,
    package,
    prim,
    reader,
    scene_of,
    square,
    surface,
    texture,
)

pytest.importorskip("pxr", reason="usd-core is not installed")


def referring(path: str, kind: str = "references") -> str:
    """A prim that takes another file's prim `square`, and moves it."""
    place = moved(9 if kind == "references" else 19, 0, 0)
    return prim("Mesh", f"by_{kind}", place, f"prepend {kind} = @{path}@</square>")


def test_layers_next_to_a_file_are_read_and_known(tmp_path: Path) -> None:
    """References, payloads and sublayers; a recipe has their SHA-256."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "one.usda").write_text(layer(referring("../two.usda") + square()))
    (tmp_path / "two.usda").write_text(layer(square()))
    (tmp_path / "three.usda").write_text(layer(prim("Scope", "empty")))
    body = referring("parts/one.usda") + referring("./two.usda", "payload")
    scene = scene_of(tmp_path, layer(body, more="subLayers = [@three.usda@]"))
    assert len(scene.meshes[0].triangles_of_file.faces) == 4
    assert set(hashes_of(scene)) == {"model.usda", "parts/one.usda", "two.usda", "three.usda"}
    assert left_out(scene) == ""


def test_layers_outside_of_the_folder_need_leave(tmp_path: Path) -> None:
    """By a path, or by a link."""
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "secret.usda").write_text(layer(square()))
    (inner / "link.usda").symlink_to(tmp_path / "secret.usda")
    text = layer(square() + referring("../secret.usda") + referring("link.usda", "payload"))
    scene = scene_of(inner, text)
    assert len(scene.meshes[0].triangles_of_file.faces) == 2
    assert "outside of the folder" in left_out(scene)
    assert "secret.usda" in left_out(scene)
    assert "link.usda" in left_out(scene)
    allowed = scene_of(inner, text, allow_outside=True)
    assert len(allowed.meshes[0].triangles_of_file.faces) == 6


def test_images_outside_of_the_folder_are_left_out(tmp_path: Path) -> None:
    """As for all models."""
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "secret.png").write_bytes(png(COLORS))
    inputs = "color3f inputs:diffuseColor.connect = </paint/color.outputs:rgb>"
    nodes = texture("/paint/color", "../secret.png") + reader()
    text = layer(square(more=COORDINATES, material="/paint") + surface("paint", inputs, nodes))
    scene = scene_of(inner, text)
    assert "secret.png" in left_out(scene)
    assert all(not it.textures for it in scene.materials.values() if hasattr(it, "textures"))


def test_missing_layers_and_prims_are_reported(tmp_path: Path) -> None:
    """By name; the rest is shown."""
    nowhere = prim("Xform", "b", about="references = </nowhere>")
    told = left_out(scene_of(tmp_path, layer(square() + referring("lost.usda") + nowhere)))
    assert "layers that cannot be read" in told
    assert "lost.usda" in told
    assert "references that lead nowhere" in told


def test_binary_files_and_packages_are_as_text(tmp_path: Path) -> None:
    """The same square as .usda, .usdc, .usd and .usdz."""
    from pxr import Sdf

    text = layer(square(more=COORDINATES))
    expected = scene_of(tmp_path, text).meshes[0].triangles_of_file
    written = Sdf.Layer.FindOrOpen(str(tmp_path / "model.usda"))
    for name in ("binary.usdc", "either.usd"):
        written.Export(str(tmp_path / name))
    content = (tmp_path / "binary.usdc").read_bytes()
    package(tmp_path / "box.usdz", {"binary.usdc": content})
    for name in ("either.usd", "box.usdz"):
        found = glrt.load(tmp_path / name).meshes[0].triangles_of_file
        assert np.array_equal(found.vertices, expected.vertices)


def test_a_file_without_triangles_is_refused(tmp_path: Path) -> None:
    """It says so."""
    with pytest.raises(SceneError, match="shows no triangles"):
        scene_of(tmp_path, layer(prim("Xform", "empty")))


def test_without_the_library_the_message_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For a model, and for the camera of a scene file."""
    monkeypatch.setattr(process, "find_spec", lambda name: None)
    with pytest.raises(SceneError, match=r"-m pip install .*\[usd\]"):
        scene_of(tmp_path, layer(square()))
    (tmp_path / "room.toml").write_text(
        'background = { color = [1, 1, 1] }\n[camera]\nfile = "model.usda"\n'
    )
    with pytest.raises(SceneError, match=r"-m pip install .*\[usd\]"):
        glrt.load(tmp_path / "room.toml")


def test_a_reader_that_hangs_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a message that says so."""
    monkeypatch.setattr(process, "_PATIENCE", 0.01)
    with pytest.raises(SceneError, match="cannot be read in 0 s"):
        scene_of(tmp_path, layer(square()))


def test_a_reader_that_crashes_leaves_a_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without words of the library."""
    usd = replace(process.LIBRARIES[0], module="this_module_is_not_there")
    monkeypatch.setattr(process, "LIBRARIES", (usd,))
    with pytest.raises(SceneError, match=r"is damaged, or no USD file\. Export it again\.$"):
        scene_of(tmp_path, layer(square()))


def test_a_syntax_error_is_named_by_its_line(tmp_path: Path) -> None:
    """A bracket that is not closed in line 8; the next one, 9, is where the reader stops."""
    text = (
        '#usda 1.0\n(\n)\n\ndef Mesh "a"\n{\n\nint[] faceVertexCounts = [3\npoint3f[] points\n}\n'
    )
    with pytest.raises(SceneError, match=r"is damaged: line 9, column 1 cannot be read\. Export"):
        scene_of(tmp_path, text)


WORDS = ("Traceback", "pxr", "Tf", "Boost", "Error in", "Sdf", "/opt")  # of the library


def damaged(content: bytes, seed: int) -> bytes:
    """A file cut off, or with a few bits of it changed."""
    rng = random.Random(seed)
    if seed % 3 == 0:
        return content[: rng.randrange(len(content))]
    found = bytearray(content)
    for _ in range(rng.choice((1, 4, 32))):
        found[rng.randrange(len(found))] ^= 1 << rng.randrange(8)
    return bytes(found)


def sound_files(folder: Path) -> dict[str, bytes]:
    """A scene in each format."""
    from pxr import Sdf

    inputs = "color3f inputs:diffuseColor.connect = </paint/color.outputs:rgb>"
    nodes = texture("/paint/color", "dots.png") + reader()
    text = layer(
        square(more=COORDINATES, material="/paint")
        + surface("paint", inputs, nodes)
        + prim("Sphere", "ball")
        + prim("Camera", "eye")
        + prim("SphereLight", "lamp")
    )
    (folder / "sound.usda").write_text(text)
    Sdf.Layer.FindOrOpen(str(folder / "sound.usda")).Export(str(folder / "sound.usdc"))
    binary = (folder / "sound.usdc").read_bytes()
    package(folder / "sound.usdz", {"a.usdc": binary, "dots.png": png(COLORS)})
    names = ("sound.usda", "sound.usdc", "sound.usdz")
    return {Path(name).suffix: (folder / name).read_bytes() for name in names}


def check_damage(folder: Path, count: int) -> int:
    """Load damaged files: each is shown, or refused in one paragraph; returns how many are."""
    refused = list[str]()
    for suffix, content in sound_files(folder).items():
        for seed in range(count):
            file = folder / f"damaged{suffix}"
            file.write_bytes(damaged(content, seed))
            try:
                glrt.load(file)
            except SceneError as error:
                refused.append(str(error))
    assert not [it for it in refused if len(it) > 600 or any(word in it for word in WORDS)]
    return len(refused)


def test_damaged_files_are_shown_or_refused(tmp_path: Path) -> None:
    """One of each format, cut off."""
    assert check_damage(tmp_path, 1) == 3


@pytest.mark.slow
def test_many_damaged_files_are_shown_or_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """120, cut off or with bits changed."""
    monkeypatch.setattr(process, "_PATIENCE", 20.0)
    assert check_damage(tmp_path, 40) > 40
