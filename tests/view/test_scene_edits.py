"""Objects and materials added, copied, renamed, retyped and removed, by pure functions."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import GlrtError, UsageError
from glrt.image.sources import load
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import TYPES
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene, with_lights
from glrt.scene.shapes.mesh import Mesh
from glrt.view.controls import replaced
from glrt.view.edits.new_objects import ADDED, with_model, with_new
from glrt.view.edits.scene_edits import (
    found_again,
    free_name,
    retyped,
    unused_materials,
    with_duplicate,
    with_new_material,
    with_objects,
    with_own_group,
    with_own_material,
    with_renamed_material,
    with_retyped,
    without_objects,
    without_unused_materials,
)
from tests.support.builders import MATTE, lamp, quad, scene_of, sphere
from tests.support.gltf_files import textured_square

EXAMPLES: dict[str, Any] = {
    "lambertian": Lambertian(color=(0.1, 0.2, 0.3), emission=(1, 0, 0), group="g"),
    "metal": Metal(preset="gold", roughness=0.25),
    "dielectric": Dielectric(ior=1.25, roughness=0.5),
    "light": Light(emission=(1, 2, 3), color=(0.5, 0.5, 0.5)),
    "principled": Principled(color=(0.1, 0.2, 0.3), roughness=0.3, metallic=1.0, ior=1.75),
    "none": Nothing(),
}
# Values that a type keeps of another one.
KEPT: dict[tuple[str, str], dict[str, Any]] = {
    ("lambertian", "metal"): {"color": (0.1, 0.2, 0.3), "emission": (1, 0, 0), "group": "g"},
    ("lambertian", "light"): {"color": (0.1, 0.2, 0.3), "emission": (1, 0, 0), "group": "g"},
    ("metal", "lambertian"): {"color": EXAMPLES["metal"].head_on, "emission": (0, 0, 0)},
    ("metal", "dielectric"): {"roughness": 0.25, "ior": 1.5},
    ("metal", "principled"): {"color": EXAMPLES["metal"].head_on, "roughness": 0.25},
    ("metal", "light"): {"emission": (8, 8, 8)},
    ("dielectric", "metal"): {"roughness": 0.5, "ior": None, "preset": None},
    ("dielectric", "principled"): {"roughness": 0.5, "ior": 1.25},
    ("light", "lambertian"): {"color": (0.5, 0.5, 0.5), "emission": (0, 0, 0)},
    ("principled", "dielectric"): {"roughness": 0.3, "ior": 1.75},
    ("principled", "metal"): {"color": (0.1, 0.2, 0.3), "roughness": 0.3, "ior": None},
}


def test_every_type_is_among_the_examples() -> None:
    assert set(EXAMPLES) == set(TYPES)


@pytest.mark.parametrize("before", EXAMPLES)
@pytest.mark.parametrize("after", TYPES)
def test_another_type_of_material_keeps_what_both_have(before: str, after: str) -> None:
    material = EXAMPLES[before]
    changed: Any = retyped(material, after)
    assert changed.type == after
    keeps_shining = material.emits and before != "light" and after not in ("dielectric", "none")
    assert changed.emits == (after == "light" or keeps_shining)
    for field, value in KEPT.get((before, after), {}).items():
        assert getattr(changed, field) == value, field
    if before == after:
        assert changed is material


def test_a_texture_stays_where_the_other_type_may_have_one() -> None:
    board = Lambertian(color={"checker": [1.0, 0.0]})  # type: ignore[arg-type]
    metal: Any = retyped(board, "metal")
    assert metal.color_map == board.color_map
    assert retyped(board, "light").type == "light"


def test_a_type_that_does_not_fit_a_shape_is_refused() -> None:
    scene = scene_of([quad([0, 0, 0], [1, 0, 0], [0, 1, 0], "a")], {"a": MATTE}, **SKY)
    with pytest.raises(UsageError, match="quad"):
        with_retyped(scene, "a", "dielectric")


SKY: dict[str, Any] = {"background": {"color": [1, 1, 1]}}


def two_balls() -> Scene:
    shapes = [sphere([n, 0, 0], 0.5, "lamp") for n in range(2)]
    return with_lights(scene_of(shapes, {"lamp": lamp(2.0)}), {"lamp": 0.5})


def test_a_duplicate_has_a_name_of_its_own() -> None:
    scene = replaced(two_balls(), objects=(replaced(two_balls().objects[0], name="ball"),))
    twice = with_duplicate(with_duplicate(scene, 0), 1)
    assert [shape.name for shape in twice.objects] == ["ball", "ball 2", "ball 3"]
    assert {replaced(shape, name=None) for shape in twice.objects} == {
        replaced(scene.objects[0], name=None)
    }


def test_a_material_made_unique_leaves_the_others() -> None:
    scene = with_own_material(two_balls(), 1)
    assert [shape.material for shape in scene.objects] == ["lamp", "lamp 2"]
    assert scene.materials["lamp 2"] == scene.materials["lamp"]
    assert scene.light_groups == {"lamp": 0.5, "lamp 2": 1.0, "background": 1.0}


def test_a_new_material_is_matte_and_of_one_object() -> None:
    scene = with_new_material(two_balls(), 1)
    assert scene.materials["material"].type == "lambertian"
    assert [shape.material for shape in scene.objects] == ["lamp", "material"]


def test_a_renamed_material_keeps_its_objects_place_and_intensity() -> None:
    scene = replaced(two_balls(), materials={**two_balls().materials, "z": MATTE})
    renamed = with_renamed_material(scene, "lamp", "sun lamp")
    assert list(renamed.materials) == ["sun lamp", "z"]
    assert {shape.material for shape in renamed.objects} == {"sun lamp"}
    assert renamed.lights == {"sun lamp": 0.5}
    assert renamed.emission_of(renamed.objects[0]) == scene.emission_of(scene.objects[0])
    assert with_renamed_material(scene, "lamp", "lamp") is scene
    assert list(with_renamed_material(scene, "lamp", "z").materials) == ["z 2", "z"]


def test_materials_that_no_object_has_go_with_the_intensities_of_their_groups() -> None:
    scene = two_balls()
    dark = with_objects(
        with_new_material(scene, 0), {1}, lambda it: replaced(it, material="material")
    )
    assert unused_materials(dark) == ["lamp"]
    bright = replaced(dark, background={"color": [1, 1, 1]})
    cleared = without_unused_materials(bright)
    assert (list(cleared.materials), cleared.lights) == (["material"], {})


def test_the_last_object_cannot_go_where_nothing_else_is_to_be_seen() -> None:
    scene = without_objects(two_balls(), {0})
    assert len(scene.objects) == 1
    with pytest.raises(UsageError, match="nothing to see"):
        without_objects(scene, {0})


def test_a_group_of_its_own_dims_one_of_two_lamps() -> None:
    scene = with_own_group(two_balls(), 1)
    dimmed = with_lights(scene, {scene.finish(scene.objects[1]).group: 0.0})
    first, second = (dimmed.emission_of(shape) for shape in dimmed.objects)
    assert (max(first), max(second)) == (1.0, 0.0)


def test_free_names_count_on() -> None:
    assert free_name("ball", []) == "ball"
    assert free_name("ball", ["ball"]) == "ball 2"
    assert free_name("ball 2", ["ball", "ball 2", "ball 3"]) == "ball 4"
    assert free_name("2", ["2"]) == "2 2"


@pytest.mark.parametrize(
    ("after", "selected", "found"),
    [
        ("abc", 1, 1),
        ("ab", 1, 1),
        ("bc", 1, 0),
        ("ac", 1, None),
        ("abcd", None, 3),
        ("xabc", 1, 2),
        ("ab", None, None),
    ],
)
def test_what_was_selected_is_found_again(
    after: str, selected: int | None, found: int | None
) -> None:
    balls: dict[str, Any] = {name: object() for name in "abcdx"}
    before = tuple(balls[name] for name in "abc")
    assert found_again(before, tuple(balls[name] for name in after), selected) == found


# --- what is added ------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ADDED)
def test_one_of_each_kind_comes_to_the_place_in_its_size(kind: str) -> None:
    scene = load("cornell")
    place, size = (0.123456, -0.2, 0.3), 0.123456
    found = with_new(with_new(scene, kind, place, size), kind, place, size)
    shape = found.objects[-1]
    assert found.objects[:-2] == scene.objects
    assert shape.material != found.objects[-2].material
    assert shape.name != found.objects[-2].name
    if kind != "plane":
        assert np.abs(np.subtract(shape.middle, place)).max() < 0.1 * size
        assert 0.9 * size < shape.reach < 2 * size
    group = found.finish(shape).group
    assert bool(group) == (kind == "lamp")
    if kind == "lamp":
        assert group == shape.material
        assert group not in scene.light_groups
        assert np.cross(shape.edge_u, shape.edge_v)[1] < 0  # type: ignore[union-attr]


def test_numbers_of_what_is_added_are_short() -> None:
    ball: Any = with_new(load("cornell"), "sphere", (1 / 3, 2e3 / 7, -1e-9), 0.123456).objects[-1]
    assert (ball.center, ball.radius) == ((0.33, 285.71, 0.0), 0.12)


def test_a_model_is_added_within_its_size_and_shares_what_is_there(tmp_path: Path) -> None:
    file = tmp_path / "square.glb"
    file.write_bytes(textured_square().glb())
    once = with_model(load("cornell"), file, (0.1, 0.2, 0.3), 0.25)
    mesh = once.objects[-1]
    assert isinstance(mesh, Mesh)
    assert mesh.reach == pytest.approx(0.25, rel=0.1)
    assert np.abs(np.subtract(mesh.middle, (0.1, 0.2, 0.3))).max() < 0.03
    twice = with_model(once, file, (0.1, 0.2, 0.3), 0.25)
    assert [shape.name for shape in twice.objects[-2:]] == ["square", "square 2"]
    assert twice.materials == once.materials


def test_what_is_no_model_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "noise.ply"
    file.write_bytes(bytes(range(256)))
    with pytest.raises(GlrtError, match=r"noise\.ply"):
        with_model(load("cornell"), file, (0, 0, 0), 1.0)
