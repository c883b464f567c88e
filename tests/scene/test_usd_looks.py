"""Materials of USD files: UsdPreviewSurface, and textures."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glrt
from glrt.scene.materials.principled import Principled
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


def look(scene: glrt.Scene, name: str) -> Principled:
    """A material of the file of a scene."""
    found = scene.materials[f"model.usda:{name}"]
    assert isinstance(found, Principled)
    return found


def with_looks(folder: Path, **looks: str) -> glrt.Scene:
    """A scene with a square of each material, given by the inputs of its surface."""
    text = "".join(
        square(f"of_{name}", COORDINATES + moved(3 * k, 0, 0), f"/{name}") + surface(name, inputs)
        for k, (name, inputs) in enumerate(looks.items())
    )
    return scene_of(folder, layer(text))


def test_numbers_of_materials_are_kept(tmp_path: Path) -> None:
    """Others have the defaults of UsdPreviewSurface."""
    inputs = """
    color3f inputs:diffuseColor = (0.8, 0.4, 0.2)
    float inputs:metallic = 0.25
    float inputs:roughness = 0.3
    float inputs:ior = 1.33
    float inputs:clearcoat = 0.5
    float inputs:clearcoatRoughness = 0.2
    float inputs:opacity = 0.75
    """
    masked = "float inputs:opacity = 0.5\nfloat inputs:opacityThreshold = 0.25"
    lamp = "color3f inputs:emissiveColor = (4, 2, 1)\nfloat inputs:opacity = 0.5"
    scene = with_looks(tmp_path, full=inputs, plain="", masked=masked, lamp=lamp)
    full = look(scene, "full")
    assert (full.color, full.metallic, full.roughness) == ((0.8, 0.4, 0.2), 0.25, 0.3)
    assert (full.ior, full.clearcoat, full.clearcoat_roughness) == (1.33, 0.5, 0.2)
    assert (full.alpha, full.alpha_cutoff) == (0.75, None)
    plain = look(scene, "plain")
    assert (plain.color, plain.metallic, plain.roughness) == ((0.18,) * 3, 0.0, 0.5)
    assert (plain.ior, plain.clearcoat, plain.alpha) == (1.5, 0.0, 1.0)
    assert look(scene, "masked").alpha_cutoff == 0.25
    assert (look(scene, "lamp").emission, look(scene, "lamp").alpha) == ((4, 2, 1), 1.0)
    assert "opacity of what emits" in left_out(scene)


def test_the_specular_workflow_has_its_reflectance_head_on(tmp_path: Path) -> None:
    """No metal; the color is what is reflected head-on."""
    inputs = "int inputs:useSpecularWorkflow = 1\nfloat inputs:metallic = 1\n"
    colored = inputs + "color3f inputs:specularColor = (0.9, 0.5, 0.1)"
    found = with_looks(tmp_path, colored=colored, black=inputs)
    assert look(found, "colored").head_on == pytest.approx((0.9, 0.5, 0.1), abs=1e-6)
    assert look(found, "colored").metallic == 0
    assert look(found, "black").head_on == (0, 0, 0)


def test_values_that_no_material_has_are_moved_and_reported(tmp_path: Path) -> None:
    """Roughness of 2, and a color that is no number."""
    scene = with_looks(
        tmp_path,
        rough="float inputs:roughness = 2",
        none="color3f inputs:diffuseColor = (nan, 0, 0)",
    )
    assert look(scene, "rough").roughness == 1.0
    assert look(scene, "none").color == (0, 0, 0)
    assert "the part of roughness outside 0 to 1" in left_out(scene)
    assert "diffuseColor that is no number" in left_out(scene)


PAINT = """
    color3f inputs:diffuseColor.connect = </paint/color.outputs:rgb>
    float inputs:roughness.connect = </paint/rough.outputs:g>
    float inputs:opacity.connect = </paint/color.outputs:a>
    normal3f inputs:normal.connect = </paint/bumps.outputs:rgb>
    color3f inputs:emissiveColor.connect = </paint/tiles.outputs:rgb>
"""
TRANSFORM = prim(
    "Shader",
    "turn",
    """
    uniform token info:id = "UsdTransform2d"
    float2 inputs:in.connect = </paint/st.outputs:result>
    float inputs:rotation = 30
    float2 inputs:scale = (2, 3)
    float2 inputs:translation = (0.1, 0.2)
    float2 outputs:result
    """,
)


def painted(image: str) -> str:
    """A square whose material has textures of an image."""
    wraps = 'token inputs:wrapS = "mirror"\ntoken inputs:wrapT = "clamp"\n'
    scale = "float4 inputs:scale = (0.5, 0.25, 1, 1)\nfloat outputs:a"
    bumps = "float4 inputs:scale = (2, 2, 2, 1)\nfloat4 inputs:bias = (-1, -1, -1, 0)\n"
    nodes = (
        texture("/paint/color", image, inputs=wraps + scale)
        + texture("/paint/rough", image, "g", 'token inputs:sourceColorSpace = "raw"')
        + texture("/paint/bumps", image, inputs=bumps, st="/paint/turn.outputs:result")
        + texture("/paint/tiles", "tiles.<UDIM>.png")
        + reader("st")
        + TRANSFORM
    )
    return layer(square(more=COORDINATES, material="/paint") + surface("paint", PAINT, nodes))


def test_textures_have_their_channels_factors_and_edges(tmp_path: Path) -> None:
    """The image lies next to the file."""
    (tmp_path / "dots.png").write_bytes(png(COLORS))
    scene = scene_of(tmp_path, painted("dots.png"))
    paint = look(scene, "paint")
    assert paint.color_map
    assert paint.color_map.wrap == ("mirror", "clamp")
    assert paint.color_map.image
    assert paint.color_map.image.file == "dots.png"
    assert paint.color == (0.5, 0.25, 1)
    assert paint.alpha_map
    assert (paint.alpha_map.channel, paint.alpha) == ("a", 1)
    assert paint.roughness_map
    assert (paint.roughness_map.channel, paint.roughness) == ("g", 1)
    assert paint.normal
    assert paint.normal.strength == 1
    assert "textures of many tiles 'tiles.<UDIM>.png'" in left_out(scene).replace('"', "'")
    assert paint.emission_map is None
    mesh = scene.meshes[0].triangles
    assert mesh.uv is not None
    corner = (mesh.vertices == (-1, 0, 1)).all(axis=1)
    assert (mesh.uv[corner, :2] == (0, 1)).all()  # t = 0 is the bottom row of an image


def test_coordinates_are_transformed_as_usd_does(tmp_path: Path) -> None:
    """Scaled, turned, moved with t upwards; the matrix here has v = 1 - t."""
    (tmp_path / "dots.png").write_bytes(png(COLORS))
    normal = look(scene_of(tmp_path, painted("dots.png")), "paint").normal
    assert normal
    for s, t in ((0.0, 0.0), (1.0, 0.0), (0.3, 0.8)):
        angle = np.radians(30)
        turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        u, up = turned @ (2 * s, 3 * t) + (0.1, 0.2)
        assert np.allclose(normal.transform @ (s, 1 - t, 1), (u, 1 - up))


def test_images_of_packages_are_read_from_them(tmp_path: Path) -> None:
    """And a scene file names them by their number."""
    files = {"model.usda": painted("dots.png").encode(), "dots.png": png(COLORS)}
    scene = glrt.load(package(tmp_path / "box.usdz", files))
    paint: Any = scene.materials["box.usdz:paint"]
    assert paint.color_map.image.file == "box.usdz#0"
    assert paint.color_map.texels.shape[:2] == (2, 2)
    scene.save(tmp_path / "box.toml")
    again = glrt.load(tmp_path / "box.toml")
    found: Any = again.materials["box.usdz:paint"]
    assert np.array_equal(found.color_map.texels, paint.color_map.texels)


def test_missing_images_are_left_out_by_name(tmp_path: Path) -> None:
    """The factor stays."""
    scene = scene_of(tmp_path, painted("lost.png"))
    assert look(scene, "paint").color == (0.5, 0.25, 1)
    assert look(scene, "paint").color_map is None
    assert "lost.png" in left_out(scene)


def test_other_materials_are_left_out_by_name(tmp_path: Path) -> None:
    """Shaders of other kinds, also of MaterialX."""
    other = 'uniform token info:id = "ND_disney_principled"\ntoken outputs:surface'
    materials = ""
    for name, context in (("odd", ""), ("mtlx", "mtlx:")):
        output = f"token outputs:{context}surface.connect = </{name}/s.outputs:surface>\n"
        materials += prim("Material", name, output + prim("Shader", "s", other))
    text = square("a", material="/odd") + square("b", moved(3, 0, 0), "/mtlx") + materials
    told = left_out(scene_of(tmp_path, layer(text)))
    assert "materials of 'ND_disney_principled'" in told.replace('"', "'")


def test_materials_take_colors_of_vertices_that_they_read(tmp_path: Path) -> None:
    """By a node that reads a primvar."""
    node = prim(
        "Shader",
        "dye",
        'uniform token info:id = "UsdPrimvarReader_float3"\n'
        'string inputs:varname = "dye"\nfloat3 outputs:result',
    )
    more = "color3f[] primvars:dye = [(0.5, 0.25, 1)]"
    inputs = "color3f inputs:diffuseColor.connect = </dyed/dye.outputs:result>"
    text = square(more=more, material="/dyed") + surface("dyed", inputs, node)
    mesh = scene_of(tmp_path, layer(text)).meshes[0].triangles
    assert mesh.colors is not None
    assert np.allclose(mesh.colors, (0.5, 0.25, 1))
