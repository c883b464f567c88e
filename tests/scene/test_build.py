"""Scenes from Python: values and arrays are taken and refused as a scene file's are."""

import json
import subprocess
import sys
import time
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glrt
from glrt.core.errors import RenderError, SceneError, UsageError
from glrt.scene.scenefile.toml import parse_scene
from glrt.scene.schema.fields import SceneFields
from tests.project.test_readme import blocks
from tests.scene.test_toml import assert_is_one_paragraph
from tests.support.bad_scenes import GOOD_SCENE

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "scenes-from-python.md"
CAMERA = glrt.Camera(position=(0, 0, 2.9), look_at=(0, 0, 0))
WHITE = glrt.Lambertian(color=(0.75, 0.75, 0.75))
LAMP = glrt.Light(emission=(8, 8, 8))
BALL: dict[str, Any] = {"shape": "sphere", "center": (0, 0, 0), "radius": 0.5, "material": "white"}


def room(**parts: Any) -> glrt.Scene:
    """A ball under a lamp, with other parts than these on request."""
    given: dict[str, Any] = {
        "camera": CAMERA,
        "objects": [
            glrt.Quad(corner=(-1, 1, -1), edge_u=(2, 0, 0), edge_v=(0, 0, 2), material="lamp"),
            glrt.Sphere(center=np.array([0.1, -0.2, 0.3]), radius=0.5, material="white"),
        ],
        "materials": {"white": WHITE, "lamp": LAMP},
    }
    return glrt.Scene.build(**{**given, **parts})


def refusal(**parts: Any) -> str:
    """The message that refuses a scene, without the words that it begins with."""
    with pytest.raises(SceneError) as caught:
        room(**parts)
    assert_is_one_paragraph(str(caught.value), "Scene.build")
    return str(caught.value).removeprefix("Scene.build: ")


# --- what is taken -----------------------------------------------------------------------


def test_a_scene_of_models_is_that_of_the_file() -> None:
    built = glrt.Scene.build(
        title="A matte and a glass ball in a box",
        camera=glrt.Camera(position=(0, 0, 2.9), look_at=[0, 0, 0], focus_distance=2.9),
        objects=[
            glrt.Sphere(
                center=(-0.4, -0.65, -0.3), radius=0.35, material="white", name="left ball"
            ),
            glrt.Plane(point=np.array([0, -1, 0]), normal=np.array([0, 1, 0]), material="steel"),
            glrt.Quad(
                corner=np.array([-0.4, 0.999, -0.4]),
                edge_u=(0.8, 0, 0),
                edge_v=(0, 0, np.float64(0.8)),
                material="lamp",
            ),
        ],
        materials={
            "white": WHITE,
            "steel": glrt.Metal(color=np.full(3, 0.9), roughness=np.float32(0)),
            "glass": glrt.Dielectric(),
            "lamp": glrt.Light(emission=np.full(3, 8), group="ceiling"),
        },
        background=glrt.Background(color=np.zeros(3)),
        lights={"ceiling": np.int64(1)},
        render={"samples": np.int32(256)},
    )
    assert built == parse_scene(tomllib.loads(GOOD_SCENE), "test")


def test_a_scene_of_dicts_is_that_of_the_file() -> None:
    tables = tomllib.loads(GOOD_SCENE)
    file = parse_scene(tables, "test")
    del tables["format"]
    assert glrt.Scene.build(**tables) == file


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.longdouble, np.int8])
def test_numbers_of_numpy_become_numbers_of_python(kind: type[np.floating[Any]]) -> None:
    one = kind(1)
    ball = glrt.Sphere(center=(one, 2, 3), radius=one, material="white")
    assert type(ball.radius) is float
    assert [type(x) for x in ball.center] == [float] * 3
    assert (ball.center, ball.radius) == ((1, 2, 3), 1)
    built = room(objects=[{**BALL, "center": np.array([1, 2, 3], kind), "radius": one}])
    assert built.objects == (glrt.Sphere(center=(1, 2, 3), radius=1, material="white"),)


def test_objects_come_from_a_generator_and_names_from_an_array() -> None:
    names = np.array(["white", "lamp"])
    balls = (glrt.Sphere(center=(0, 0, i), radius=0.5, material=names[i]) for i in range(2))
    scene = room(objects=balls)
    assert [(ball.material, type(ball.material)) for ball in scene.objects] == [
        ("white", str),
        ("lamp", str),
    ]


def test_a_background_alone_is_a_scene() -> None:
    scene = glrt.Scene.build(CAMERA, background={"color": [1, 1, 1]})
    assert (scene.objects, scene.materials) == ((), {})


def test_of_settings_a_scene_takes_what_were_given() -> None:
    assert room(render=glrt.Settings(samples=4)).render.samples == 4
    assert refusal(render=glrt.Settings(seed=1)).startswith("render: unknown key 'seed'.")


@pytest.mark.slow
def test_ten_thousand_spheres_take_a_moment() -> None:
    """The least processor time of several runs: whatever else the machine does."""
    centers, radii = np.random.default_rng(0).random((10_000, 3)), np.full(10_000, 0.01)
    taken = []
    for _ in range(3):
        start = time.process_time()
        balls = [
            glrt.Sphere(center=center, radius=radius, material="white")
            for center, radius in zip(centers, radii, strict=True)
        ]
        assert len(room(objects=balls).objects) == 10_000
        taken.append(time.process_time() - start)
    assert min(taken) < 1, taken


def test_arguments_are_not_changed() -> None:
    center = np.zeros(3)
    materials: dict[str, glrt.Light | Mapping[str, Any]] = {"white": {"type": "dielectric"}}
    scene = room(objects=[{**BALL, "center": center}], materials=materials)
    center[:] = 7
    materials["other"] = LAMP
    assert scene.objects[0].middle == (0, 0, 0)
    assert list(scene.materials) == ["white"]


# --- what is refused ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ({"radius": -1}, ".radius must be greater than 0, got -1."),
        ({"radius": np.float32(np.nan)}, ".radius must be a finite number, got nan."),
        ({"radius": "1"}, '.radius must be a number, got "1".'),
        ({"radius": np.True_}, ".radius must be a number, got true."),
        ({"radius": np.ones(1)}, ".radius must be a number, got a list of 1."),
        ({"center": np.array([0, np.inf, 0])}, ".center[1] must be a finite number, got inf."),
        ({"center": np.zeros(4)}, ".center must be a list of three numbers, got a list of 4."),
        ({"center": np.zeros(2)}, ".center must be a list of three numbers, got a list of 2."),
        ({"center": np.zeros((3, 1))}, ".center[0] must be a number, got a list of 1."),
        ({"center": 1}, ".center must be a list of three numbers, got 1."),
        ({"centre": np.zeros(3)}, ": unknown key 'centre'; did you mean 'center'?"),
        ({"material": "wite"}, ".material: unknown material 'wite'; did you mean 'white'?"),
        ({"material": WHITE}, ".material must be text in quotes, got a Lambertian."),
        ({"shape": "ball"}, ".shape: unknown shape 'ball'"),
        ({1: 2}, " must have keys that are text, got 1."),
        ({"name": "left", "radius": 0}, ' ("left").radius must be greater than 0, got 0.'),
    ],
)
def test_a_wrong_object_is_named_by_its_place(keys: dict[str, Any], says: str) -> None:
    assert refusal(objects=[BALL, {**BALL, **keys}]).startswith(f"objects[1]{says}")


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"camera": None}, "camera is missing; add it: the camera."),
        ({"camera": [1, 2]}, "camera must be a table headed [camera], got a list of 2."),
        ({"camera": {"position": (0, 0, 1)}}, "camera.look_at is missing"),
        ({"objects": BALL}, "objects must be a list of tables"),
        ({"objects": glrt.Sphere(**BALL)}, "objects must be a list of tables"),
        ({"objects": 3}, "objects must be a list of tables"),
        ({"objects": [WHITE]}, "objects[0].shape is missing"),
        ({"objects": np.zeros((2, 3))}, "objects[0] must be a table, got a list of 3."),
        ({"objects": []}, "there is nothing to see"),
        ({"materials": [WHITE]}, "materials must be a table of tables"),
        ({"materials": {1: WHITE}}, "materials.1: its name must be text in quotes, got 1."),
        ({"materials": {"a\ud800": WHITE}}, "materials."),
        ({"background": (1, 1, 1)}, "background must be a table headed [background]"),
        ({"lights": {"lam": 1}}, "lights.lam: unknown light group 'lam'; did you mean 'lamp'?"),
        ({"lights": {"lamp": -1}}, "lights.lamp must be at least 0, got -1."),
        ({"render": {"samples": 1.5}}, "render.samples must be a whole number, got 1.5."),
        ({"title": "a\nb"}, "title must be one line"),
        ({"title": "\ud800"}, "title must be text that UTF-8 can hold"),
    ],
)
def test_a_wrong_part_is_named(parts: dict[str, Any], says: str) -> None:
    assert refusal(**parts).startswith(says)


def test_a_model_that_was_changed_past_its_checks_is_checked() -> None:
    ball = glrt.Sphere(center=(0, 0, 0), radius=1, material="white")
    assert "radius must be" in refusal(objects=[ball.model_copy(update={"radius": -1})])


@pytest.mark.parametrize(
    "wrong", [{"radius": -1}, {"radius": "1"}, {"center": np.zeros(4)}, {"raduis": 1}]
)
def test_a_wrong_model_is_a_value_error(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        glrt.Sphere(**{**BALL, **wrong})


# --- files -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["white", "a b", 'ü "quoted" \\ \u0085.x = [1]', "#", "'", "日本"])
def test_what_is_saved_is_loaded(name: str, tmp_path: Path) -> None:
    ball = glrt.Sphere(center=(1e-7, -1e15, 0.1), radius=1e-15, material=name, name=name)
    scene = room(objects=[ball], materials={name: LAMP}, lights={name: 1 / 3}, title=name)
    scene.save(tmp_path / "scene.toml")
    assert glrt.load(tmp_path / "scene.toml") == scene


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    for name in ("scene.json", "scene"):
        with pytest.raises(UsageError, match=r"the name of a scene file must end in \.toml\.$"):
            room().save(str(tmp_path / name))
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_cannot_be_written_is_reported() -> None:
    with pytest.raises(RenderError, match="/nowhere"):
        room().save("/nowhere/scene.toml")


def test_a_built_scene_renders_to_the_bits_of_its_file(tmp_path: Path) -> None:
    room().save(tmp_path / "room.toml")
    images = [
        glrt.render(scene, samples=4, width=16, height=16)
        for scene in (room(), glrt.load(tmp_path / "room.toml"))
    ]
    assert images[0].radiance.max() > 0
    assert images[0].radiance.tobytes() == images[1].radiance.tobytes()


# --- the page, the schema ----------------------------------------------------------------


@pytest.mark.slow
def test_the_example_of_the_page_runs(tmp_path: Path) -> None:
    code = "\n".join(blocks(PAGE, "python"))
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "different"
    assert len(glrt.load(tmp_path / "balls.toml").objects) == 27


def test_the_mistake_of_the_page_is_reported_so() -> None:
    (text,) = blocks(PAGE, "text")
    assert refusal(objects=[BALL] * 3 + [{**BALL, "radius": -1}]) in text


def test_the_schema_of_scene_files_knows_nothing_of_python() -> None:
    schema = glrt.Scene.model_json_schema()
    assert (schema["title"], schema["description"]) == ("Scene", glrt.Scene.__doc__)
    assert list(schema["properties"]) == list(SceneFields.model_fields)
    radiance = {"maximum": 1e15, "minimum": 0, "type": "number"}
    assert schema["$defs"]["Light"]["properties"]["emission"]["prefixItems"] == [radiance] * 3
    assert "numpy" not in json.dumps(schema)
