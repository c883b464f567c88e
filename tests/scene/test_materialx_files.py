"""MaterialX documents as files: includes, folders, damage, and the balls that show materials."""

import random
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

import glrt
from glrt.cli.main import main
from glrt.core.errors import SceneError
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.materials.principled import Principled
from glrt.scene.model_files.conversion import process
from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.conversion.reports import LeftOut, UnshownError
from tests.support.gltf_files import COLORS, png
from tests.support.materialx_files import (
    HEAD,
    connected,
    document,
    given,
    image,
    left_out,
    look,
    material,
    node,
    scene_of,
)
from tests.support.usd_files import COORDINATES, layer, prim, square
from tests.support.usd_files import left_out as left_out_of_usd
from tests.support.usd_files import scene_of as usd_scene_of

pytest.importorskip("MaterialX", reason="materialx is not installed")

from glrt.scene.model_files.materialx.conversion import converted

PLAIN = material("m", "gltf_pbr")
COLORS_OF_SURFACES = [
    ("standard_surface", "base_color"),
    ("open_pbr_surface", "transmission_color"),
    ("gltf_pbr", "emissive"),
    ("UsdPreviewSurface", "specularColor"),
    ("standard_surface", "opacity"),
    ("open_pbr_surface", "fuzz_color"),
]


def include(path: str) -> str:
    """An element that includes a document."""
    return f'<xi:include href="{path}" xmlns:xi="http://www.w3.org/2001/XInclude"/>'


def test_included_documents_are_read_and_known(tmp_path: Path) -> None:
    """Also one that an included document includes, and one twice; a recipe has their SHA-256."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "a.mtlx").write_text(
        document(include("../b.mtlx"), material("a", "gltf_pbr"))
    )
    (tmp_path / "b.mtlx").write_text(document(include("b.mtlx"), material("b", "gltf_pbr")))
    scene = scene_of(tmp_path, include("parts/a.mtlx"), include("b.mtlx"), PLAIN)
    assert {"looks.mtlx:a", "looks.mtlx:b", "looks.mtlx:m"} <= set(scene.materials)
    assert set(hashes_of(scene)) == {"looks.mtlx", "parts/a.mtlx", "b.mtlx"}
    assert left_out(scene) == ""


def test_documents_outside_of_the_folder_need_leave(tmp_path: Path) -> None:
    """By a path, or by a link; and so do images."""
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "secret.mtlx").write_text(document(material("secret", "gltf_pbr")))
    (tmp_path / "secret.png").write_bytes(png(COLORS))
    (inner / "link.mtlx").symlink_to(tmp_path / "secret.mtlx")
    dots = image("dots", "../secret.png")
    paint = material("m", "gltf_pbr", connected("base_color", "dots", "color3"))
    parts = (include("../secret.mtlx"), include("link.mtlx"), include("none.mtlx"), dots, paint)
    scene = scene_of(inner, *parts)
    assert "looks.mtlx:secret" not in scene.materials
    for words in ("outside of the folder", "secret.mtlx", "link.mtlx", "none.mtlx", "secret.png"):
        assert words in left_out(scene)
    assert look(scene, "m").color_map is None
    allowed = scene_of(inner, *parts, allow_outside=True)
    assert "looks.mtlx:secret" in allowed.materials
    assert look(allowed, "m").color_map is not None


def test_prefixes_of_files_and_inputs_of_graphs(tmp_path: Path) -> None:
    """A prefix names a folder; an input of a graph gives its nodes a value."""
    (tmp_path / "tex").mkdir()
    (tmp_path / "tex" / "dots.png").write_bytes(png(COLORS))
    inner = (
        '<nodegraph name="g" fileprefix="tex/"><input name="tint" type="color3" value="0.5, 1, 1"/>'
        + image("dots", "dots.png")
        + node(
            "multiply",
            "dyed",
            "color3",
            connected("in1", "dots", "color3"),
            '<input name="in2" type="color3" interfacename="tint"/>',
        )
        + '<output name="out" type="color3" nodename="dyed"/></nodegraph>'
    )
    link = '<input name="base_color" type="color3" nodegraph="g" output="out"/>'
    scene = scene_of(tmp_path, inner, material("m", "gltf_pbr", link))
    paint = look(scene, "m")
    assert paint.color == (0.5, 1, 1)
    assert paint.color_map is not None
    assert paint.color_map.image is not None
    assert paint.color_map.image.file == "tex/dots.png"
    assert left_out(scene) == ""


def test_documents_of_older_versions_are_read(tmp_path: Path) -> None:
    """Version 1.37 has materials with references to shaders; the library upgrades them."""
    (tmp_path / "looks.mtlx").write_text(
        '<materialx version="1.37"><material name="gold"><shaderref name="s" '
        'node="standard_surface"><bindinput name="metalness" type="float" value="1"/></shaderref>'
        "</material></materialx>"
    )
    assert look(glrt.load(tmp_path / "looks.mtlx"), "gold").metallic == 1


def test_surfaces_without_a_material_are_shown(tmp_path: Path) -> None:
    """By their own names; materials of other surfaces are left out by name."""
    bare = node("standard_surface", "bare", "surfaceshader", given("metalness", "1"))
    assert look(scene_of(tmp_path, bare), "bare").metallic == 1
    other = material("odd", "disney_principled")
    scene = scene_of(tmp_path, PLAIN, other)
    assert left_out(scene).replace('"', "'") == "materials of 'disney_principled'"
    with pytest.raises(SceneError, match="has no material with a surface that glrt reads, which"):
        scene_of(tmp_path, other)


def test_parts_that_no_scene_has_are_reported(tmp_path: Path) -> None:
    """Looks, units, normals of coats, and materials without a surface."""
    coat = connected("coat_normal", "bumps", "vector3")
    depth = given("transmission_depth", "1", unit="inch", unittype="distance")
    paint = material("m", "standard_surface", coat, depth)
    others = (node("surfacematerial", "empty", "material"), '<look name="l"/>')
    bumps = image("bumps", "dots.png", "vector3")
    told = left_out(scene_of(tmp_path, bumps, paint, *others)).replace('"', "'").split("; ")
    assert told[:3] == ["coat_normal", "looks", "materials without a surface 'empty'"]
    assert told[3:] == ["units of 'transmission_depth'"]


def test_images_that_are_missing_or_of_many_tiles_are_left_out(tmp_path: Path) -> None:
    """By name."""
    nodes = image("a", "none.png") + image("b", "tiles.<UDIM>.png")
    links = connected("base_color", "a", "color3") + connected("emissive", "b", "color3")
    told = left_out(scene_of(tmp_path, nodes, material("m", "gltf_pbr", links)))
    assert "none.png" in told
    assert "textures of many tiles" in told


@pytest.mark.parametrize(
    "text",
    ["", "junk", "<materialx", HEAD, f"{HEAD}<a></b></materialx>", "<materialx>" + "<a>" * 10_000],
)
def test_damaged_documents_are_refused(tmp_path: Path, text: str) -> None:
    """In a sentence without words of the library."""
    (tmp_path / "looks.mtlx").write_text(text)
    with pytest.raises(SceneError, match=r"(is damaged, or no MaterialX file|has no material)"):
        glrt.load(tmp_path / "looks.mtlx")


def test_documents_by_chance_are_converted_or_refused(tmp_path: Path) -> None:
    """Values and elements change places in 60 documents, and some lose marks of XML."""
    (tmp_path / "dots.png").write_bytes(png(COLORS))
    text = document(
        image("dots", "dots.png"),
        node("combine3", "three", "color3", given("in1", "0.5"), given("in2", "1")),
        node("mix", "mixed", "color3", connected("bg", "dots", "color3"), given("mix", "0.5")),
        *(
            material(
                f"m{k}",
                surface,
                connected(color, ("dots", "three", "mixed")[k % 3], "color3"),
                given("roughness", "0.5"),
            )
            for k, (surface, color) in enumerate(COLORS_OF_SURFACES)
        ),
    )
    values = [*re.findall(r'"[^"]*"', text), '"1e999"', '"nan"', '""', '"1, 2"', '"-1"', '"../x"']
    chance, ends = random.Random(5), Counter[bool]()
    for _ in range(60):
        changed = text
        for _ in range(chance.randint(1, 4)):
            found = list(re.finditer(r'"[^"]*"|<[^>]*/>', changed))
            place = chance.choice(found)
            piece = chance.choice(values) if place[0][0] == '"' else chance.choice(found)[0]
            changed = changed[: place.start()] + piece + changed[place.end() :]
        if chance.random() < 0.25:
            changed = changed.replace(chance.choice('<>"='), " ", 9)
        (tmp_path / "looks.mtlx").write_text(changed)
        try:
            content = converted(Folder(tmp_path / "looks.mtlx", tmp_path, False, LeftOut()))
        except UnshownError:
            content = b""
        ends[content[:4] == b"glTF"] += 1
    assert ends[True] >= 30
    assert ends[False] >= 5


def test_without_the_library_the_message_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a process that crashes leaves a sentence."""
    library = process.LIBRARIES[1]
    crashing = replace(library, module="this_module_is_not_there")
    monkeypatch.setattr(process, "LIBRARIES", (crashing,))
    with pytest.raises(SceneError, match="is damaged, or no MaterialX file"):
        scene_of(tmp_path, PLAIN)
    monkeypatch.setattr(process, "find_spec", lambda name: None)
    with pytest.raises(SceneError, match=r"-m pip install .*\[materialx\]"):
        scene_of(tmp_path, PLAIN)


def test_an_imported_document_is_the_same_scene(tmp_path: Path) -> None:
    """`glrt import` writes the materials, which can be edited."""
    scene = scene_of(tmp_path, material("m", "open_pbr_surface", given("coat_weight", "1")))
    assert main(["import", str(tmp_path / "looks.mtlx"), "-o", str(tmp_path / "scene.toml")]) == 0
    again = glrt.load(tmp_path / "scene.toml")
    assert again.materials == scene.materials
    assert again.camera == scene.camera


GRAPH = """
    color3f inputs:base_color.connect = </paint/half.outputs:out>
    float inputs:metalness = 1
    float inputs:specular_roughness.connect = </paint.inputs:rough>
    token outputs:surface
"""


def test_networks_of_materialx_in_usd_files_are_read(tmp_path: Path) -> None:
    """The same surface, and textures by a primvar; the material has an input of its own."""
    pytest.importorskip("pxr", reason="usd-core is not installed")
    (tmp_path / "dots.png").write_bytes(png(COLORS))
    shaders = {
        "s": ("ND_standard_surface_surfaceshader", GRAPH),
        "half": (
            "ND_multiply_color3",
            "color3f inputs:in1.connect = </paint/dots.outputs:out>\n"
            "color3f inputs:in2 = (0.5, 0.25, 1)\ncolor3f outputs:out",
        ),
        "dots": (
            "ND_image_color3",
            'asset inputs:file = @dots.png@ (colorSpace = "srgb_texture")\n'
            "float2 inputs:texcoord.connect = </paint/st.outputs:out>\ncolor3f outputs:out",
        ),
        "st": ("ND_geompropvalue_vector2", 'string inputs:geomprop = "st"\nfloat2 outputs:out'),
    }
    body = "float inputs:rough = 0.3\n"
    body += "token outputs:mtlx:surface.connect = </paint/s.outputs:surface>\n"
    for name, (kind, inputs) in shaders.items():
        body += prim("Shader", name, f'uniform token info:id = "{kind}"\n{inputs}')
    text = layer(square(more=COORDINATES, material="/paint") + prim("Material", "paint", body))
    scene = usd_scene_of(tmp_path, text)
    assert left_out_of_usd(scene) == ""
    paint = scene.materials["model.usda:paint"]
    assert isinstance(paint, Principled)
    assert (paint.color, paint.metallic, paint.roughness) == ((0.5, 0.25, 1), 1, 0.3)
    assert paint.color_map is not None
    assert scene.meshes[0].triangles.uv is not None
