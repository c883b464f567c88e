"""Looks of a lone model that cannot be had are left out and reported; the rest is as it was."""

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image as Pillow

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.gltf_files import COLORS, POINTS, SQUARE, Builder, png, square, textured_square
from tests.support.renders import rendered, same

Files = dict[str, str | bytes]

RED = Lambertian(color=(0.8, 0.1, 0.1))
GREY = Lambertian(color=(0.6, 0.58, 0.55))
MTL = "newmtl m\nKd 0.8 0.1 0.1\n"
HEAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
BOTH = HEAD + "usemtl m\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
FIRST = HEAD + "f 1/1 2/2 3/3\nusemtl m\nf 1/1 3/3 4/4\n"


def told(scene: Scene) -> list[str]:
    """The names of looks that are reported as left out."""
    texts = [text for text in cautions(scene, settings_for(scene.render)) if "left out" in text]
    return [text.split(": ", 2)[2].split(". docs/")[0] for text in texts]


def model(folder: Path, text: str, **files: str | bytes) -> Scene:
    """The scene of an OBJ file with others next to it, `a_b` for a.b."""
    (folder / "thing.obj").write_bytes(text.encode())
    for name, content in files.items():
        path = folder / name.replace("_", ".").replace(",", "/")
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return load(folder / "thing.obj")


def looks(scene: Scene) -> list[Material]:
    return [scene.materials[mesh.material] for mesh in scene.meshes]


SPELLINGS = {
    "as it is": "mtllib a.mtl\n",
    "with a backslash": "mtllib .\\a.mtl\n",
    "of another machine": "mtllib C:/Users/x/a.mtl\n",
    "with backslashes of another machine": "mtllib C:\\Users\\x\\a.mtl\n",
    "from the root": "mtllib /home/x/a.mtl\n",
    "in capitals": "mtllib A.MTL\n",
    "behind a byte order mark": "\ufeffmtllib a.mtl\n",
    "before a comment": "mtllib a.mtl # of 2 materials\n",
    "indented": "  mtllib  a.mtl\n",
}


@pytest.mark.parametrize("name", SPELLINGS)
def test_an_mtl_file_is_found(name: str, tmp_path: Path) -> None:
    scene = model(tmp_path, SPELLINGS[name] + BOTH, a_mtl=MTL)
    assert looks(scene) == [RED]
    assert told(scene) == []


def test_an_mtl_file_in_a_folder_is_found(tmp_path: Path) -> None:
    files: Files = {"sub,a_mtl": MTL + "map_Kd T.PNG\n", "sub,t_png": png(COLORS)}
    scene = model(tmp_path, "mtllib sub\\a.mtl\n" + BOTH, **files)
    (material,) = looks(scene)
    assert isinstance(material, Lambertian)
    assert sorted(hashes_of(scene)) == ["sub/t.png", "thing.obj"]


MISSING: dict[str, tuple[str, list[Material], list[str]]] = {
    "faces before usemtl": (
        "mtllib a.mtl\n" + FIRST,
        [RED, GREY],
        ["the material of 1 triangle (no usemtl)"],
    ),
    "one of two files": ("mtllib a.mtl b.mtl\n" + BOTH, [RED], ["'b.mtl', which cannot be read"]),
    "the only file": (
        "mtllib b.mtl\n" + BOTH,
        [GREY],
        ["'b.mtl', which cannot be read, the material 'm', which is missing"],
    ),
    "no file": (BOTH, [GREY], ["the material 'm', which is missing"]),
    "one of two materials": (
        "mtllib a.mtl\n" + FIRST.replace("f 1/1 2", "usemtl rod\nf 1/1 2"),
        [RED, GREY],
        ["the material 'rod', which is missing"],
    ),
    "nothing, with usemtl in a group": (
        "mtllib a.mtl\n" + BOTH.replace("\nf 1/1 3", "\ng usemtl x\nf 1/1 3"),
        [RED],
        [],
    ),
}


@pytest.mark.parametrize("name", MISSING)
def test_materials_that_are_there_are_taken(name: str, tmp_path: Path) -> None:
    text, expected, left_out = MISSING[name]
    scene = model(tmp_path, text, a_mtl=MTL)
    found = looks(scene)
    assert sorted(map(str, found)) == sorted(map(str, expected))
    assert told(scene) == left_out


@pytest.mark.slow
def test_what_was_left_out_is_written_out_in_a_saved_scene(
    tmp_path: Path, context: Context
) -> None:
    """The same bits, without the MTL file."""
    scene = model(tmp_path, "mtllib a.mtl b.mtl\n" + FIRST, a_mtl=MTL)
    scene.save(tmp_path / "scene.toml")
    (tmp_path / "a.mtl").unlink()
    again = load(tmp_path / "scene.toml")
    assert same(rendered(scene, context, 4), rendered(again, context, 4))


def red(kind: str) -> bytes:
    """The content of an image."""
    file = io.BytesIO()
    Pillow.new("RGB", (2, 2), (255, 0, 0)).save(file, kind)
    return file.getvalue()


@pytest.mark.parametrize("kind", ["bmp", "tga", "png"])
def test_images_of_other_programs_are_read(kind: str, tmp_path: Path) -> None:
    files: Files = {"a_mtl": MTL + f"Kd 1 1 1\nmap_Kd t.{kind}\n", f"t_{kind}": red(kind)}
    (material,) = looks(model(tmp_path, "mtllib a.mtl\n" + BOTH, **files))
    assert isinstance(material, Lambertian)
    assert material.color_map is not None
    assert_allclose(material.color_map.texels, np.broadcast_to([1, 0, 0, 1], (2, 2, 4)))


def test_an_image_that_cannot_be_read_is_left_out(tmp_path: Path) -> None:
    for content in (b"", b"DDS ", png(COLORS)[:40]):
        files: Files = {"a_mtl": MTL + "map_Kd t.png\n", "t_png": content}
        scene = model(tmp_path, "mtllib a.mtl\n" + BOTH, **files)
        assert looks(scene) == [RED]
        assert told(scene) == ["map_Kd 't.png', which cannot be read"]


COLORED = "v 0 0 0 {}\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvt {}\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
NUMBERS = {
    ("1 0 0", "0 0"): [],
    ("1.0001 0 0", "0 0"): [],
    ("nan 0 0", "0 0"): ["the color of 1 vertex"],
    ("255 0 0", "0 0"): ["the color of 1 vertex"],
    ("1 0 0", "nan 0"): ["the texture coordinates of 1 vertex"],
}


@pytest.mark.parametrize("given", NUMBERS)
def test_numbers_at_vertices_that_are_none_are_left_out(
    given: tuple[str, str], tmp_path: Path
) -> None:
    scene = model(tmp_path, COLORED.format(*given))
    assert told(scene) == NUMBERS[given]
    (mesh,) = scene.meshes
    colors = mesh.triangles.colors
    assert colors is not None
    first = [1, 1, 1] if "color" in str(NUMBERS[given]) else [1, 0, 0]
    assert_allclose(sorted(map(tuple, colors)), sorted([tuple(first), (0, 1, 0), (0, 0, 1)]))


def test_a_normal_of_no_length_is_that_of_the_triangles(tmp_path: Path) -> None:
    builder = Builder()
    points = POINTS[:, [2, 0, 1]]  # in the plane of y and z
    attributes = {
        "POSITION": builder.accessor(points),
        "NORMAL": builder.accessor([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 0, 0]]),
    }
    builder.shown({"attributes": attributes, "indices": builder.accessor(SQUARE.ravel(), "u2")})
    (tmp_path / "thing.glb").write_bytes(builder.glb())
    (mesh,) = load(tmp_path / "thing.glb").meshes
    assert_allclose(mesh.triangles.shading_normals, np.tile([1, 0, 0], (4, 1)))


# --- glTF ------------------------------------------------------------------------------------


def gltf(folder: Path, builder: Builder) -> Scene:
    (folder / "thing.gltf").write_bytes(builder.gltf())
    return load(folder / "thing.gltf")


def principled(scene: Scene) -> Principled:
    material = scene.materials[scene.meshes[0].material]
    assert isinstance(material, Principled)
    return material


def test_factors_out_of_range_are_moved_into_it(tmp_path: Path) -> None:
    for metallic, left_out in ((1.0000001, 0), (-1e-9, 0), (4, 1)):
        builder = Builder()
        base = {"metallicFactor": metallic, "baseColorFactor": [1.00016, 0, 0, 1]}
        number = builder.add("materials", {"pbrMetallicRoughness": base})
        builder.shown(square(builder, material=number))
        scene = gltf(tmp_path, builder)
        assert principled(scene).metallic == (0 if metallic < 0 else 1)
        assert principled(scene).color == (1, 0, 0)
        assert len(told(scene)) == left_out


PLACES = {
    "t.png": "t.png",
    "sub\\t.png": "sub/t.png",
    "T.PNG": "t.png",
    "t%C3%A9.png": "te\u0301.png",  # one letter, and two that look like it
    "a%20b.png": "a%20b.png",
}


@pytest.mark.parametrize("uri", PLACES)
def test_an_image_is_found_under_another_spelling(uri: str, tmp_path: Path) -> None:
    builder = textured_square()
    builder.json["images"] = [{"uri": uri}]
    path = tmp_path / PLACES[uri]
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(png(COLORS))
    scene = gltf(tmp_path, builder)
    assert list(principled(scene).textures) == ["color"]
    assert told(scene) == []
    assert PLACES[uri] in hashes_of(scene)


def test_an_image_that_is_missing_is_left_out(tmp_path: Path) -> None:
    texture: dict[str, Any] = {"index": 0}
    builder = textured_square(
        normalTexture=texture, emissiveTexture=texture, emissiveFactor=[1] * 3
    )
    builder.json["images"] = [{"uri": "t.png"}]
    scene = gltf(tmp_path, builder)
    material = principled(scene)
    assert not material.textures
    assert (material.color, material.emission) == ((1, 1, 1), (0, 0, 0))
    assert told(scene) == [
        ", ".join(f"{key} 't.png', which cannot be read" for key in ("color", "emission", "normal"))
    ]


def test_base64_may_have_lines_and_lack_its_end(tmp_path: Path) -> None:
    content = textured_square().gltf()
    begin = content.index(b"base64,") + 20
    for changed in (content.replace(b"==", b""), content[:begin] + b"\\n " + content[begin:]):
        (tmp_path / "thing.gltf").write_bytes(changed + b"\0")
        assert load(tmp_path / "thing.gltf").meshes


UNLIT: dict[str, Any] = {"extensions": {"KHR_materials_unlit": {}}}


def test_what_is_unlit_has_the_colors_of_its_vertices(tmp_path: Path) -> None:
    base = {"baseColorFactor": [0.5, 1, 1, 1]}
    for colors, emission in (([[0.5, 0.25, 0]] * 4, (0.25, 0.25, 0)), (np.eye(4)[:, :3], None)):
        builder = Builder()
        number = builder.add("materials", {"pbrMetallicRoughness": base, **UNLIT})
        primitive = square(builder, material=number)
        primitive["attributes"]["COLOR_0"] = builder.accessor(np.array(colors, float))
        builder.shown(primitive)
        scene = gltf(tmp_path, builder)
        material = principled(scene)
        if emission:
            assert_allclose(material.emission, emission)
            assert not any(material.color)
        else:
            assert (material.color, any(material.emission)) == ((0.5, 1, 1), False)
        assert bool(told(scene)) == (not emission)


SEEN: dict[str, list[float]] = {"MASK": [0, 0, 0.5], "BLEND": [0.25, 0, 0.375], "OPAQUE": [1, 0, 0]}


@pytest.mark.slow_cases("OPAQUE")
@pytest.mark.parametrize("mode", SEEN)
def test_what_is_unlit_has_holes(mode: str, tmp_path: Path, context: Context) -> None:
    """Red of alpha 0.25 before blue of 0.5, both unlit."""
    builder = Builder()
    front = {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.25]}, "alphaMode": mode}
    back = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0.5, 1]}}
    for z, material in ((0, back), (0.1, front)):
        number = builder.add("materials", {**material, **UNLIT})
        builder.shown(square(builder, material=number), translation=[0, 0, z])
    scene = gltf(tmp_path, builder)
    assert told(scene) == []
    view = {"position": (0.5, 0.5, 2), "look_at": (0.5, 0.5, 0), "fov": 10.0}
    seen = scene.model_copy(update={"camera": scene.camera.model_copy(update=view)})
    image = rendered(seen, context, 256, width=8, height=8)
    assert_allclose(image.radiance.mean(axis=(0, 1)), SEEN[mode], atol=0.02)
