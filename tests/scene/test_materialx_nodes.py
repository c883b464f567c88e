"""Nodes of MaterialX documents: textures, how they lie, and numbers that nodes give."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import glrt
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.textures import Texture
from tests.support.gltf_files import COLORS, png
from tests.support.materialx_files import (
    connected,
    given,
    image,
    left_out,
    look,
    material,
    node,
    scene_of,
)

pytest.importorskip("MaterialX", reason="materialx is not installed")

Point = NDArray[np.float64]


def painted(folder: Path, nodes: str, **inputs: str) -> glrt.Scene:
    """A scene of a surface of glTF; each input is given by a node, of color or number."""
    (folder / "dots.png").write_bytes(png(COLORS))
    kinds = {"base_color": "color3", "emissive": "color3", "normal": "vector3"}
    links = [connected(key, name, kinds.get(key, "float")) for key, name in inputs.items()]
    return scene_of(folder, nodes, material("m", "gltf_pbr", *links))


def map_of(found: Principled, key: str = "color") -> Texture:
    """A texture of a material."""
    texture = getattr(found, f"{key}_map")
    assert isinstance(texture, Texture)
    return texture


def test_textures_have_their_channels_factors_and_edges(tmp_path: Path) -> None:
    """A product with a number is a factor; each channel of an image has its letter."""
    edges = (given("uaddressmode", "mirror", "string"), given("vaddressmode", "clamp", "string"))
    nodes = (
        image("dots", "dots.png", "color3", *edges)
        + node(
            "multiply",
            "half",
            "color3",
            given("in1", "0.5, 0.25, 1", "color3"),
            connected("in2", "dots", "color3"),
        )
        + image("data", "dots.png", "vector3")
        + node("separate3", "parts", "multioutput", connected("in", "data", "vector3"))
        + node(
            "extract",
            "rough",
            "float",
            connected("in", "data", "vector3"),
            given("index", "1", "integer"),
        )
        + node(
            "normalmap",
            "bumps",
            "vector3",
            connected("in", "data", "vector3"),
            given("scale", "0.5"),
        )
    )
    (tmp_path / "dots.png").write_bytes(png(COLORS))
    scene = scene_of(
        tmp_path,
        nodes,
        material(
            "m",
            "gltf_pbr",
            connected("base_color", "half", "color3"),
            connected("metallic", "parts", "float", "outb"),
            connected("roughness", "rough"),
            connected("normal", "bumps", "vector3"),
        ),
    )
    assert left_out(scene) == ""
    found = look(scene, "m")
    assert found.color == (0.5, 0.25, 1)
    assert map_of(found).wrap == ("mirror", "clamp")
    assert map_of(found).image is not None
    assert map_of(found, "metallic").channel == "b"
    assert map_of(found, "roughness").channel == "g"
    assert found.normal is not None
    assert found.normal.strength == 0.5


def place(**values: str) -> str:
    """Inputs of a placement."""
    kinds = {"rotate": "float", "operationorder": "integer"}
    return "".join(given(key, value, kinds.get(key, "vector2")) for key, value in values.items())


def turned(point: Point, degrees: float) -> Point:
    """As rotate2d of MaterialX turns it."""
    sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return np.array([cos * point[0] + sin * point[1], -sin * point[0] + cos * point[1]])


def placed(point: Point, order: int, inverse: bool = False) -> Point:
    """As place2d of MaterialX does it, or gltf_image, with the numbers of the test below."""
    pivot, scale = np.array([0.25, 0.5]), np.array([2.0, 2.0] if order else [2.0, 4.0])
    turn, offset = 30.0, np.array([0.1, 0.2])
    if inverse:
        scale, turn, offset = 1 / scale, -turn, offset * (-1, 1)
    found: Point = point - pivot
    if order:
        found = turned(found - offset, turn) / scale + pivot
    else:
        found = turned(found / scale, turn) - offset + pivot
    return found


@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize("kind", ["place2d", "gltf_image", "tiledimage", "nodes"])
def test_textures_lie_as_materialx_places_them(tmp_path: Path, kind: str, order: int) -> None:
    """Each point of a surface has the same place in the image as by the formulas of the nodes."""
    scale = "2, 2" if order else "2, 4"
    way = place(pivot="0.25, 0.5", scale=scale, rotate="30", offset="0.1, 0.2")
    way += place(operationorder=str(order))
    file = given("file", "dots.png", "filename", colorspace="srgb_texture")
    if kind == "place2d":
        nodes = node("place2d", "way", "vector2", way)
        nodes += node("image", "dots", "color3", file, connected("texcoord", "way", "vector2"))
    elif kind == "gltf_image":
        nodes = node("gltf_image", "dots", "color3", file, way)
    elif kind == "tiledimage":
        tiles = place(uvtiling="3, 2", uvoffset="0.1, 0.3", realworldimagesize="0.5, 2")
        nodes = node("tiledimage", "dots", "color3", file, tiles)
    else:
        uv = node("texcoord", "uv", "vector2", given("index", "1", "integer"))
        wide = connected("in1", "uv", "vector2") + given("in2", "3, 2", "vector2")
        moved = connected("in1", "wide", "vector2") + given("in2", "0.1, 0.3", "vector2")
        nodes = uv + node("multiply", "wide", "vector2", wide)
        nodes += node("subtract", "moved", "vector2", moved)
        nodes += node("image", "dots", "color3", file, connected("texcoord", "moved", "vector2"))
    scene = painted(tmp_path, nodes, base_color="dots")
    assert left_out(scene) == ""
    texture = map_of(look(scene, "m"))
    assert texture.uv == 0
    for u, v in itertools.product((0.0, 0.3, 1.0), (0.0, 0.7, 1.0)):
        point = np.array([u, v])
        if kind in ("place2d", "gltf_image"):
            expected = placed(point, order, kind == "gltf_image")
        else:
            sizes = (0.5, 2.0) if kind == "tiledimage" else (1.0, 1.0)
            expected = (point * (3, 2) - (0.1, 0.3)) / sizes
        right, down = texture.transform @ (u, 1 - v, 1)
        assert (right, 1 - down) == pytest.approx(tuple(expected), abs=1e-6)


def test_skewed_textures_are_left_out(tmp_path: Path) -> None:
    """Turned first, then scaled unevenly."""
    way = place(scale="2, 4", rotate="30", operationorder="1")
    nodes = node("place2d", "way", "vector2", way)
    nodes += image("dots", "dots.png", "color3", connected("texcoord", "way", "vector2"))
    scene = painted(tmp_path, nodes, base_color="dots")
    assert "skewed" in left_out(scene)
    assert look(scene, "m").color == (1, 1, 1)


@pytest.mark.parametrize(
    ("nodes", "expected"),
    [
        (node("constant", "x", "float", given("value", "0.25")), 0.25),
        (node("add", "x", "float", given("in1", "0.25"), given("in2", "0.5")), 0.75),
        (node("subtract", "x", "float", given("in1", "0.75"), given("in2", "0.5")), 0.25),
        (node("divide", "x", "float", given("in1", "0.75"), given("in2", "3")), 0.25),
        (node("power", "x", "float", given("in1", "0.5"), given("in2", "2")), 0.25),
        (node("min", "x", "float", given("in1", "0.5"), given("in2", "2")), 0.5),
        (node("sqrt", "x", "float", given("in", "0.25")), 0.5),
        (node("invert", "x", "float", given("in", "0.25")), 0.75),
        (node("clamp", "x", "float", given("in", "3"), given("high", "0.5")), 0.5),
        (node("mix", "x", "float", given("bg", "0"), given("fg", "1"), given("mix", "0.25")), 0.25),
        (
            node(
                "combine3",
                "v",
                "color3",
                given("in1", "0.1"),
                given("in2", "0.2"),
                given("in3", "0.3"),
            )
            + node(
                "extract",
                "x",
                "float",
                connected("in", "v", "color3"),
                given("index", "2", "integer"),
            ),
            0.3,
        ),
        (node("luminance", "x", "color3", given("in", "0, 1, 0", "color3")), 0.7152),
    ],
)
def test_numbers_by_nodes_are_worked_out(tmp_path: Path, nodes: str, expected: float) -> None:
    """Arithmetic of constants, and nothing is left out."""
    scene = painted(tmp_path, nodes, roughness="x")
    assert left_out(scene) == ""
    assert look(scene, "m").roughness == pytest.approx(expected)


def test_colors_in_codes_are_decoded(tmp_path: Path) -> None:
    """A code of 0.5 is a light of 0.214, by IEC 61966-2-1; other spaces are reported."""
    grey = given("base_color", "0.5, 0.5, 0.5", "color3", colorspace="srgb_texture")
    scene = scene_of(tmp_path, material("m", "gltf_pbr", grey))
    assert look(scene, "m").color == pytest.approx((0.2140411,) * 3)
    wide = given("base_color", "0.5, 0.5, 0.5", "color3", colorspace="acescg")
    assert "acescg" in left_out(scene_of(tmp_path, material("m", "gltf_pbr", wide)))
    linear = image("dots", "dots.png", "color3", colorspace="lin_rec709")
    assert "lin_rec709" in left_out(painted(tmp_path, linear, base_color="dots"))
    codes = image("dots", "dots.png", "color3") + node(
        "extract", "x", "float", connected("in", "dots", "color3")
    )
    assert "srgb_texture" in left_out(painted(tmp_path, codes, roughness="x"))


def test_other_nodes_are_named_and_their_texture_is_shown(tmp_path: Path) -> None:
    """An adjustment is left out; noise has no texture, so the default stands."""
    dots = image("dots", "dots.png") + node(
        "saturate", "strong", "color3", connected("in", "dots", "color3"), given("amount", "2")
    )
    scene = painted(tmp_path, dots, base_color="strong")
    assert left_out(scene).replace('"', "'") == "base_color by nodes 'saturate'"
    assert map_of(look(scene, "m")).image is not None
    noise = node("fractal3d", "noise", "float")
    scene = painted(tmp_path, noise, roughness="noise")
    assert "fractal3d" in left_out(scene)
    assert look(scene, "m").roughness == 1
    mixed = noise + node(
        "mix",
        "veins",
        "color3",
        given("bg", "1, 0, 0", "color3"),
        given("fg", "0, 1, 0", "color3"),
        connected("mix", "noise"),
    )
    scene = painted(tmp_path, mixed, base_color="veins")
    assert look(scene, "m").color == (0.5, 0.5, 0)
    assert "taken as one half" in left_out(scene)


def test_rings_and_towers_of_nodes_end(tmp_path: Path) -> None:
    """A node that takes itself, a chain of 200, and 40 that take the one before them twice."""
    ring = node("add", "x", "float", connected("in1", "x"), given("in2", "1"))
    assert look(painted(tmp_path, ring, roughness="x"), "m").roughness == 1
    chain = node("constant", "n0", "float", given("value", "0.5"))
    chain += "".join(
        node("dot", f"n{k}", "float", connected("in", f"n{k - 1}")) for k in range(1, 200)
    )
    assert "too many" in left_out(painted(tmp_path, chain, roughness="n199"))
    tower = node("constant", "n0", "float", given("value", "0.5"))
    tower += "".join(
        node(
            "multiply",
            f"n{k}",
            "float",
            connected("in1", f"n{k - 1}"),
            connected("in2", f"n{k - 1}"),
        )
        for k in range(1, 41)
    )
    scene = painted(tmp_path, tower, roughness="n40")
    assert (look(scene, "m").roughness, left_out(scene)) == (0, "")
