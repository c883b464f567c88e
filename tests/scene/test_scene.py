"""Scenes: what a file means, which values fit together, and the schema."""

import copy
import math
import time
import tomllib
from pathlib import Path
from typing import Any

import pytest

from glrt.core.errors import SceneError
from glrt.scene.camera import Camera
from glrt.scene.lights.background import Background
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import TYPES
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene, with_lights
from glrt.scene.scenefile.toml import parse_scene, read_scene, scene_to_dict
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import EFFECTS, RenderSettings
from tests.support.bad_scenes import GOOD_SCENE, changed

MINIMAL: dict[str, Any] = {
    "camera": {"position": [0, 0, 3], "look_at": [0, 0, 0]},
    "materials": {
        "white": {"type": "lambertian", "color": [1, 1, 1]},
        "steel": {"type": "metal", "color": [1, 1, 1]},
        "glass": {"type": "dielectric"},
        "lamp": {"type": "light", "emission": [1, 2, 3]},
    },
    "objects": [{"shape": "sphere", "center": [0, 0, 0], "radius": 1, "material": "white"}],
}


def minimal(**tables: Any) -> dict[str, Any]:
    return copy.deepcopy(MINIMAL) | tables


def parsed(text: str) -> Scene:
    return parse_scene(tomllib.loads(text), "test")


def refusal(data: dict[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        parse_scene(data, "test")
    return str(caught.value)


def test_full_example_is_read_as_written(tmp_path: Path) -> None:
    path = tmp_path / "box.toml"
    path.write_text(GOOD_SCENE)
    assert read_scene(path) == Scene(
        title="A matte and a glass ball in a box",
        camera=Camera(position=(0, 0, 2.9), look_at=(0, 0, 0), focus_distance=2.9),
        render=RenderSettings(),
        background=Background(color=(0, 0, 0)),
        materials={
            "white": Lambertian(color=(0.75, 0.75, 0.75)),
            "steel": Metal(color=(0.9, 0.9, 0.9)),
            "glass": Dielectric(ior=1.5),
            "lamp": Light(emission=(8, 8, 8), group="ceiling"),
        },
        lights={"ceiling": 1.0},
        objects=(
            Sphere(name="left ball", center=(-0.4, -0.65, -0.3), radius=0.35, material="white"),
            Plane(point=(0, -1, 0), normal=(0, 1, 0), material="steel"),
            Quad(
                corner=(-0.4, 0.999, -0.4),
                edge_u=(0.8, 0, 0),
                edge_v=(0, 0, 0.8),
                material="lamp",
            ),
        ),
    )


def test_what_a_file_leaves_out_has_the_documented_defaults() -> None:
    scene = parse_scene(MINIMAL, "test")
    assert (scene.title, scene.format, scene.lights) == (None, 1, {})
    assert scene.render.model_dump() == {
        "width": 512,
        "height": 512,
        "samples": 256,
        "bounces": 10,
        "method": "mis",
        "effects": EFFECTS,
        "adaptive": "off",
        "phong": None,
    }
    assert (scene.camera.up, scene.camera.fov, scene.camera.defocus_angle) == ((0, 1, 0), 45, 0)
    assert scene.materials["steel"] == Metal(color=(1, 1, 1), roughness=0)
    assert scene.materials["glass"] == Dielectric(ior=1.5)
    assert scene.materials["lamp"] == Light(emission=(1, 2, 3), color=(0, 0, 0), group=None)
    assert scene.background.gradient == ((0, 0, 0), (0, 0, 0))


def test_focus_lies_at_the_point_looked_at_unless_given() -> None:
    camera = Camera(position=(1, 2, 3), look_at=(1, -2, 6))
    assert camera.resolved_focus_distance == 5
    assert camera.model_copy(update={"focus_distance": 2.0}).resolved_focus_distance == 2


def test_background_is_a_colour_or_a_gradient() -> None:
    assert Background(color=(1, 2, 3)).gradient == ((1, 2, 3), (1, 2, 3))
    assert Background(bottom=(0, 0, 0), top=(1, 2, 3)).gradient == ((0, 0, 0), (1, 2, 3))


def test_integers_are_numbers_and_become_floats() -> None:
    scene = parse_scene(MINIMAL, "test")
    assert all(type(x) is float for x in scene.camera.position)
    assert type(scene.emission(Finish("lamp", "lamp"))[0]) is float


def test_a_background_alone_is_a_scene() -> None:
    camera = MINIMAL["camera"]
    scene = parse_scene({"camera": camera, "background": {"color": [0, 0, 1e-9]}}, "test")
    assert scene.objects == ()


def test_light_groups_are_those_of_the_lamps_and_the_sky() -> None:
    assert parsed(GOOD_SCENE).light_groups == {"ceiling": 1.0, "background": 1.0}
    dimmed = parse_scene(minimal(lights={"lamp": 0.5, "background": 3}), "test")
    assert dimmed.light_groups == {"lamp": 0.5, "background": 3.0}


def test_intensities_multiply_emission_and_background() -> None:
    lights, sky = {"lamp": 0.5, "background": 3}, {"bottom": [1, 0, 0], "top": [0, 1, 2]}
    scene = parse_scene(minimal(lights=lights, background=sky), "test")
    assert scene.emission(Finish("lamp", "lamp")) == (0.5, 1.0, 1.5)
    assert scene.emission(Finish("white")) == (0, 0, 0)
    assert scene.background_colors == ((3, 0, 0), (0, 3, 6))


def test_lights_from_the_command_line_override_those_of_the_file() -> None:
    scene = parse_scene(minimal(lights={"lamp": 0.5, "background": 3}), "test")
    relit = with_lights(scene, {"lamp": 2})
    assert relit.light_groups == {"lamp": 2.0, "background": 3.0}
    assert relit == parse_scene(minimal(lights={"lamp": 2, "background": 3}), "test")
    assert scene.light_groups["lamp"] == 0.5


@pytest.mark.parametrize(
    ("intensities", "says"),
    [
        ({"celing": 2.0}, ("'celing'", "did you mean 'ceiling'?", "background, ceiling.")),
        ({"sun": 2.0}, ("'sun'", "background, ceiling.")),
        ({"ceiling": -1.0}, ("'ceiling'", "0 to 1e15", "got -1")),
        ({"ceiling": math.nan}, ("'ceiling'", "0 to 1e15", "got nan")),
        ({"ceiling": math.inf}, ("'ceiling'", "0 to 1e15", "got inf")),
        ({"ceiling": 1e15}, ("'ceiling'", "emission", "at most 1e15")),
        ({"a\nb": 1.0}, (r"'a\nb'",)),
    ],
)
def test_wrong_lights_are_refused_with_advice(
    intensities: dict[str, float], says: tuple[str, ...]
) -> None:
    with pytest.raises(SceneError) as caught:
        with_lights(parsed(GOOD_SCENE), intensities)
    assert [words for words in says if words not in str(caught.value)] == []
    assert str(caught.value).isprintable()


def test_an_unknown_material_is_named_once_for_all_its_objects() -> None:
    message = refusal(minimal(objects=[MINIMAL["objects"][0] | {"material": "wite"}] * 9))
    assert message.count("wite") == 1
    assert "other problem" not in message


def test_a_misspelt_key_is_not_reported_as_missing_too() -> None:
    data = minimal()
    data["camera"]["positon"] = data["camera"].pop("position")
    assert "missing" not in refusal(data)


@pytest.mark.slow
def test_sixty_five_thousand_objects_are_the_limit() -> None:
    ball = MINIMAL["objects"][0]
    assert len(parse_scene(minimal(objects=[ball] * 65_536), "test").objects) == 65_536
    message = refusal(minimal(objects=[ball] * 65_537))
    assert message == "test: objects must be at most 65,536 shapes, got 65,537."


@pytest.mark.parametrize("exponent", [-40, -10, 10, 40])
def test_shape_tests_do_not_depend_on_the_scale_of_the_scene(exponent: int) -> None:
    scale = 2.0**exponent
    sliver = {"shape": "quad", "corner": [0, 0, 0], "material": "white"}
    thin = sliver | {"edge_u": [scale, 0, 0], "edge_v": [scale, 1e-5 * scale, 0]}
    flat = sliver | {"edge_u": [scale, 0, 0], "edge_v": [scale, 1e-7 * scale, 0]}
    assert parse_scene(minimal(objects=[thin]), "test")
    assert "parallel" in refusal(minimal(objects=[flat]))


def test_the_extremes_of_every_range_are_accepted() -> None:
    text = changed("radius = 0.35", "radius = 1e-15").replace("fov = 45.0", "fov = 179.999")
    scene = parsed(text.replace("[-0.4, -0.65, -0.3]", "[1e15, -1e15, 0]"))
    assert isinstance(scene.objects[0], Sphere)
    assert scene.objects[0].radius == 1e-15


@pytest.mark.parametrize(
    "data",
    [
        tomllib.loads(GOOD_SCENE),
        MINIMAL,
        minimal(background={"bottom": [1, 1, 1], "top": [0, 0, 1]}, title="Сцена", lights={}),
    ],
)
def test_a_scene_survives_the_way_through_plain_tables(data: dict[str, Any]) -> None:
    scene = parse_scene(data, "test")
    plain = scene_to_dict(scene)
    assert parse_scene(plain, "test") == scene
    assert scene_to_dict(parse_scene(plain, "test")) == plain
    assert "None" not in repr(plain)
    assert "(" not in repr(plain)


def test_defaults_are_written_out_for_recipes() -> None:
    plain = scene_to_dict(parse_scene(MINIMAL, "test"))
    assert plain["render"]["samples"] == 256
    glass = {"type": "dielectric", "ior": 1.5, "roughness": 0.0, "dispersion": 0.0, "thin": False}
    assert plain["materials"]["glass"] == glass


def test_reading_hundreds_of_objects_takes_milliseconds() -> None:
    """The least processor time of several runs: whatever else the machine does."""
    objects = [MINIMAL["objects"][0]] * 480
    taken = []
    for _ in range(5):
        start = time.process_time()
        parse_scene(minimal(objects=objects), "test")
        taken.append(time.process_time() - start)
    assert min(taken) < 0.1, taken


def test_every_key_is_described_in_the_schema() -> None:
    schema = Scene.model_json_schema()
    models = [schema, *(m for m in schema["$defs"].values() if m["type"] == "object")]
    named = {model["title"] for model in models}
    assert {model.__name__ for model in (Camera, *KINDS.values(), *TYPES.values())} <= named
    silent = [
        f"{model['title']}.{key}"
        for model in models
        for key, value in model["properties"].items()
        if not value.get("description")
    ]
    assert silent == []
    assert [model["title"] for model in models if not model.get("description")] == []


def test_schema_asks_for_the_tags_that_files_need() -> None:
    definitions = Scene.model_json_schema()["$defs"]
    for kind in ("Lambertian", "Metal", "Dielectric", "Light"):
        assert "type" in definitions[kind]["required"]
    for kind in ("Sphere", "Plane", "Quad"):
        assert {"shape", "material"} <= set(definitions[kind]["required"])


def test_scenes_cannot_be_changed_in_place() -> None:
    scene = parse_scene(MINIMAL, "test")
    with pytest.raises(ValueError, match="frozen"):
        scene.title = "another"  # type: ignore[misc]
