"""Variants of the materials of glTF files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from glrt.core.errors import SceneError, UsageError
from glrt.image.sources import load
from glrt.scene.materials.principled import Principled
from glrt.scene.model_files.mesh_formats import decode_mesh
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.summary import summary
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.gltf_files import Builder, square, textured_square
from tests.support.meshes import box

COLORS = {"red": [1.0, 0, 0, 1], "green": [0, 1.0, 0, 1], "blue": [0, 0, 1.0, 1]}
KEY = "KHR_materials_variants"


def mapped(*mappings: tuple[int, list[int]]) -> dict[str, Any]:
    """The extension of a primitive: materials and their variants."""
    listed = [{"material": material, "variants": variants} for material, variants in mappings]
    return {KEY: {"mappings": listed}}


def varied(**keys: Any) -> Builder:
    """A file of two squares, both red; the first is green in `meadow` and blue in `sea`."""
    builder = Builder()
    for name, color in COLORS.items():
        builder.add("materials", {"name": name, "pbrMetallicRoughness": {"baseColorFactor": color}})
    names = [{"name": "meadow"}, {"name": "sea"}, {"name": "sea"}]
    builder.json["extensions"] = {KEY: {"variants": names}}
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = [KEY]
    builder.shown(
        square(builder, material=0, extensions=mapped((1, [0]), (2, [1])), **keys), name="first"
    )
    builder.shown(square(builder, material=0), translation=[2, 0, 0])
    return builder


def materials_of(scene: Scene) -> dict[float, tuple[float, ...]]:
    """The colour of each mesh by its lowest x."""
    found = dict[float, tuple[float, ...]]()
    for mesh in scene.objects:
        if isinstance(mesh, Mesh):
            material = scene.materials[mesh.material]
            assert isinstance(material, Principled)
            found[float(mesh.world_vertices[:, 0].min())] = material.color
    return found


CLAY = '[materials.m]\ntype = "lambertian"\ncolor = [1, 1, 1]'
RED, GREEN, BLUE = (1, 0, 0), (0, 1, 0), (0, 0, 1)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "thing.glb"
    path.write_bytes(varied().glb())
    return path


def scene_with(folder: Path, *objects: str) -> Scene:
    """A scene file with objects of the model."""
    head = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n"
    tables = [f'[[objects]]\nshape = "mesh"\nfile = "thing.glb"\n{text}\n' for text in objects]
    path = folder / "scene.toml"
    path.write_text(head + "".join(tables))
    return load(path)


def test_a_variant_replaces_the_materials_that_it_maps(model: Path) -> None:
    assert materials_of(load(model)) == {0: RED}  # both squares are one mesh
    assert materials_of(load(model, variant="meadow")) == {0: GREEN, 2: RED}
    assert materials_of(load(model, variant="sea")) == {0: BLUE, 2: RED}
    assert materials_of(load(model, variant="2")) == {0: RED}, "its name is taken, it maps nothing"


def test_objects_of_one_file_have_variants_of_their_own(model: Path) -> None:
    green = 'variant = "meadow"\ntranslate = [10, 0, 0]'
    scene = scene_with(model.parent, "", green, 'variant = "sea"\ntranslate = [20, 0, 0]')
    assert materials_of(scene) == {0: RED, 10: GREEN, 12: RED, 20: BLUE, 22: RED}


def test_a_part_is_one_of_the_variant(model: Path) -> None:
    scene = scene_with(model.parent, 'variant = "meadow"\npart = "green"')
    assert materials_of(scene) == {0: GREEN}
    with pytest.raises(SceneError, match=r"unknown part 'green'.* The file has: red\."):
        scene_with(model.parent, 'part = "green"')


def test_parts_of_one_name_are_different_triangles_in_variants(model: Path) -> None:
    scene = scene_with(model.parent, "", 'variant = "meadow"\npart = "red"')
    usual, meadow = scene.meshes
    assert (len(usual.triangles.faces), len(meadow.triangles.faces)) == (4, 2)
    assert usual.form != meadow.form, "meshes of one form share a tree"


def test_a_saved_scene_has_the_same_variant(model: Path) -> None:
    path = model.parent / "again.toml"
    load(model, variant="sea").save(path)
    assert materials_of(load(path)) == {0: BLUE, 2: RED}


def test_a_variant_moves_with_the_animation(model: Path) -> None:
    builder = varied()
    tables = {
        "input": builder.accessor([0.0, 1]),
        "output": builder.accessor([[0, 0, 0], [0, 4, 0]]),
    }
    channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
    builder.add("animations", {"samplers": [tables], "channels": [channel]})
    model.write_bytes(builder.glb())
    scene = scene_with(model.parent, 'variant = "sea"\ntime = 0.5')
    assert materials_of(scene) == {0: BLUE, 2: RED}
    lows = {mesh.part: mesh.world_vertices[:, 1].min() for mesh in scene.meshes}
    assert lows == {"blue": 2, "red": 0}


def test_triangles_that_are_left_out_shift_no_material() -> None:
    builder = Builder()
    for name in COLORS:
        builder.add("materials", {"name": name})
    builder.json["extensions"] = {KEY: {"variants": [{"name": "a"}]}}
    flat = {"indices": builder.accessor([0, 0, 1, 0, 1, 2], "u2")}
    builder.shown({**square(builder, material=0, extensions=mapped((1, [0]))), **flat})
    builder.shown(square(builder, material=0, extensions=mapped((2, [0]))), translation=[2, 0, 0])
    mesh = decode_mesh(builder.glb(), "a.glb", "x").varied("a")
    assert mesh.names == ("green", "blue")
    assert_array_equal(mesh.labels, [0, 1, 1])


def test_glass_that_is_open_in_one_variant_is_thin_there_alone(tmp_path: Path) -> None:
    points, faces = box([0, 0, 0], [1, 1, 1])
    builder = Builder()
    glass = {
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 1},
    }
    builder.add("materials", {"name": "glass", "extensions": glass})
    builder.add("materials", {"name": "red"})
    builder.json["extensions"] = {KEY: {"variants": [{"name": "broken"}]}}
    attributes = {"POSITION": builder.accessor(points)}
    for rows, more in ((faces[:6], {}), (faces[6:], {"extensions": mapped((1, [0]))})):
        order = builder.accessor(rows.ravel(), "u1")
        builder.shown({"attributes": attributes, "indices": order, "material": 0, **more})
    (tmp_path / "thing.glb").write_bytes(builder.glb())
    scene = scene_with(tmp_path, "", 'variant = "broken"\ntranslate = [5, 0, 0]')
    panes = [mesh.material for mesh in scene.meshes if mesh.part == "glass"]
    found = [scene.materials[name] for name in panes]
    assert [isinstance(it, Principled) and it.thin for it in found] == [False, True]


def test_variants_share_a_material_with_an_image(model: Path) -> None:
    builder = textured_square()
    red = builder.add("materials", {"name": "red"})
    builder.json["extensions"] = {KEY: {"variants": [{"name": "a"}]}}
    mapping = mapped((red, [0]))
    builder.shown(square(builder, material=0, extensions=mapping), translation=[2, 0, 0])
    model.write_bytes(builder.glb())
    scene = scene_with(model.parent, "", 'variant = "a"\ntranslate = [5, 0, 0]')
    assert set(scene.materials) == {"thing.glb:painted", "thing.glb:red"}


def test_variants_are_named_until_one_is_chosen(model: Path) -> None:
    def told(scene: Scene) -> str:
        return " ".join(cautions(scene, settings_for(scene.render)))

    scene = load(model)
    assert "variant 'meadow' (--variant), variant 'sea' (--variant)" in told(scene)
    assert "variants   thing.glb: meadow, sea, 2" in summary(scene)
    assert "left out" not in told(load(model, variant="sea"))


def test_unknown_variants_are_refused_with_a_list(model: Path) -> None:
    with pytest.raises(SceneError, match=r"'medow'; did you mean 'meadow'\? .*: meadow, sea, 2\."):
        load(model, variant="medow")
    with pytest.raises(SceneError, match=r"objects\[0\].file: thing.glb: unknown variant 'blue'"):
        scene_with(model.parent, 'variant = "blue"')
    with pytest.raises(SceneError, match=r"objects\[0\].file: thing.glb: unknown variant 'blue'"):
        scene_with(model.parent, f'variant = "blue"\nmaterial = "m"\n{CLAY}')


def test_variants_of_files_without_them_are_refused(model: Path) -> None:
    builder = Builder()
    builder.shown(square(builder))
    model.write_bytes(builder.glb())
    with pytest.raises(SceneError, match="it has no variants of its materials: leave `variant`"):
        load(model, variant="sea")
    scene = model.parent / "scene.toml"
    load(model).save(scene)
    for source in (scene, "cornell"):
        with pytest.raises(UsageError, match="is no model, and only a model"):
            load(source, variant="sea")


WRONG = {
    "names a variant that there is not": mapped((0, [3])),
    r"names materials\[9\]": mapped((9, [0])),
    "variants must be a list": {KEY: {"mappings": [{"material": 0}]}},
}


@pytest.mark.parametrize("message", WRONG)
def test_mappings_that_do_not_fit_are_damage(message: str) -> None:
    builder = varied()
    builder.json["meshes"][1]["primitives"][0]["extensions"] = WRONG[message]
    with pytest.raises(SceneError, match=message):
        decode_mesh(builder.glb(), "a.glb", "x")


def test_bits_of_a_variant_are_those_of_a_file_with_its_materials(model: Path) -> None:
    """Triangles, labels and names are equal: so are all pictures."""
    builder = varied()
    builder.json["meshes"][0]["primitives"][0]["material"] = 2
    expected = decode_mesh(builder.glb(), "a.glb", "x")
    found = decode_mesh(model.read_bytes(), "a.glb", "x").varied("sea")
    assert found.names == expected.names
    for key in ("vertices", "faces", "labels", "normals"):
        assert np.array_equal(getattr(found, key), getattr(expected, key))


def two_in_one_place(**second: Any) -> Builder:
    """Two red squares in one place; the second has more keys."""
    builder = varied()
    builder.json["nodes"] = []
    for more in ({}, second):
        builder.shown(square(builder, material=0, **more))
    return builder


def repeats(scene: Scene) -> bool:
    return any("repeat others" in text for text in cautions(scene, settings_for(scene.render)))


def parts(scene: Scene) -> dict[str | None, int]:
    """The number of triangles of each part, covered ones included."""
    return {it.part: len(it.triangles.faces) for it in scene.objects if isinstance(it, Mesh)}


def test_of_two_squares_in_one_place_a_variant_loses_none(model: Path) -> None:
    model.write_bytes(two_in_one_place(extensions=mapped((1, [0]))).glb())
    usual, meadow = load(model), load(model, variant="meadow")
    assert parts(usual) == {"red": 2}, "they are one, both red"
    assert parts(meadow) == {"red": 2, "green": 2}
    assert repeats(usual)
    assert not repeats(meadow)


def test_two_squares_in_one_place_that_a_variant_makes_alike_are_one(model: Path) -> None:
    builder = two_in_one_place(extensions=mapped((0, [0])))
    builder.json["meshes"][-1]["primitives"][0]["material"] = 1
    model.write_bytes(builder.glb())
    assert parts(load(model)) == {"red": 2, "green": 2}
    assert parts(load(model, variant="meadow")) == {"red": 2}
