"""Animations of glTF files: nodes, skins and morph targets at a moment."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.image.sources import load
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.mesh_formats import decode_mesh
from glrt.scene.shapes.box import rotation
from tests.support.gltf_files import POINTS, Builder, square
from tests.support.processes import glrt as command

HALF = math.sqrt(0.5)


def animated(
    builder: Builder, node: int, path: str, times: Any, values: Any, **sampler: Any
) -> None:
    """Add an animation of one channel."""
    tables = {"input": builder.accessor(times), "output": builder.accessor(values), **sampler}
    channel = {"sampler": 0, "target": {"node": node, "path": path}}
    builder.add("animations", {"samplers": [tables], "channels": [channel]})


def shifted(*by: float) -> Any:
    return POINTS + np.array(by)


def mesh_of(builder: Builder) -> TriangleMesh:
    return decode_mesh(builder.glb(), "a.glb", "x")


def at(builder: Builder, moment: float, name: str | None = None) -> Any:
    """Vertices at a moment, in the order of the file."""
    poses = mesh_of(builder).poses
    assert poses
    return poses.at(name, moment).vertices


def moved(way: str, values: Any) -> Builder:
    builder = Builder()
    node = builder.shown(square(builder))
    animated(builder, node, "translation", [1.0, 2.0, 4.0], values, interpolation=way)
    return builder


def test_places_lie_between_their_keys() -> None:
    builder = moved("LINEAR", [[0, 0, 0], [4, 0, 0], [4, 8, 0]])
    for moment, place in ((0, (0, 0)), (1.25, (1, 0)), (2, (4, 0)), (3.5, (4, 6)), (9, (4, 8))):
        assert_allclose(at(builder, moment), shifted(*place, 0), atol=1e-12)


def test_steps_wait_for_their_key() -> None:
    builder = moved("STEP", [[0, 0, 0], [4, 0, 0], [4, 8, 0]])
    for moment, place in ((0, (0, 0)), (1.99, (0, 0)), (2, (4, 0)), (3.99, (4, 0)), (4, (4, 8))):
        assert_allclose(at(builder, moment), shifted(*place, 0), atol=1e-12)


def test_cubic_splines_follow_their_tangents() -> None:
    """Tangents are slopes in seconds: x = t^3 of the time since the first key is such a spline."""

    def key(t: float) -> list[list[float]]:
        slope = [3 * t * t, 0, 0]
        return [slope, [t**3, 0, 0], slope]

    builder = moved("CUBICSPLINE", [row for t in (0.0, 1.0, 3.0) for row in key(t)])
    for moment in (1.0, 1.3, 2.0, 2.7, 3.9, 4.0):
        t = moment - 1
        assert_allclose(at(builder, moment), shifted(t**3, 0, 0), atol=1e-12)
    assert_allclose(at(builder, 0.5), POINTS, atol=1e-12)
    assert_allclose(at(builder, 7), shifted(27, 0, 0), atol=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.9, 1.0])
def test_rotations_turn_evenly_and_children_follow(share: float) -> None:
    builder = Builder()
    child = builder.shown(square(builder), translation=[2, 0, 0])
    parent = builder.add("nodes", {"children": [child], "scale": [1, 1, 2]})
    turn = math.radians(120)
    end = [0, 0, math.sin(turn / 2), math.cos(turn / 2)]
    animated(builder, parent, "rotation", [0.0, 1.0], [[0, 0, 0, 1], end])
    expected = shifted(2, 0, 0) @ rotation((0, 0, 120 * share)).T
    assert_allclose(at(builder, share), expected, atol=1e-6)


def test_a_scale_replaces_that_of_the_node() -> None:
    builder = Builder()
    node = builder.shown(square(builder), scale=[5, 5, 5])
    animated(builder, node, "scale", [0.0, 1.0], [[1, 1, 1], [3, 1, 1]])
    assert_allclose(at(builder, 0.5), POINTS * [2, 1, 1], atol=1e-12)
    assert_allclose(mesh_of(builder).vertices, POINTS * 5)  # without animation


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_a_skin_bends_as_its_joint_turns(share: float) -> None:
    """Each vertex is the mean of where both joints take it, by its weights (float64 twin)."""
    builder = Builder()
    primitive = square(builder)
    weights = np.array([[1.0, 0, 0, 0], [0.25, 0.75, 0, 0], [0, 1, 0, 0], [0.5, 0.5, 0, 0]])
    joints = np.tile([0, 1, 0, 0], (4, 1))
    primitive["attributes"] |= {
        "JOINTS_0": builder.accessor(joints, "u1"),
        "WEIGHTS_0": builder.accessor(weights),
    }
    elbow = np.array([0.5, 0.25, 0])
    second = builder.add("nodes", {"translation": elbow.tolist()})
    first = builder.add("nodes", {"children": [second]})
    bound = np.tile(np.eye(4), (2, 1, 1))
    bound[1, :3, 3] = -elbow
    view = builder.view(bound.transpose(0, 2, 1).astype("<f4").tobytes())
    table = {"bufferView": view, "componentType": 5126, "type": "MAT4", "count": 2}
    builder.json["accessors"].append(table)
    rows = len(builder.json["accessors"]) - 1
    builder.add("skins", {"joints": [first, second], "inverseBindMatrices": rows})
    builder.shown(primitive, skin=0)
    animated(builder, second, "rotation", [0.0, 1.0], [[0, 0, 0, 1], [0, 0, HALF, HALF]])
    turned = (POINTS - elbow) @ rotation((0, 0, 90 * share)).T + elbow
    expected = weights[:, :1] * POINTS + weights[:, 1:2] * turned
    assert_allclose(at(builder, share), expected, atol=1e-6)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_weights_of_morph_targets_change(count: int) -> None:
    """Four weights are four numbers, not a rotation."""
    builder = Builder()
    primitive = square(builder)
    shifts = np.random.default_rng(count).uniform(-1, 1, (count, 4, 3)).astype(np.float32)
    primitive["targets"] = [{"POSITION": builder.accessor(shift)} for shift in shifts]
    node = builder.shown(primitive)
    ends = np.random.default_rng(9).uniform(0, 1, (2, count)).astype(np.float32).astype(float)
    animated(builder, node, "weights", [0.0, 1.0], ends.ravel())
    for share in (0.0, 0.25, 1.0):
        weights = (1 - share) * ends[0] + share * ends[1]
        expected = POINTS + np.tensordot(weights.astype(float), shifts.astype(float), 1)
        assert_allclose(at(builder, share), expected, atol=1e-12)


def two() -> Builder:
    """A file with a pose and two animations, the second without a name."""
    builder = moved("LINEAR", [[0, 0, 0], [4, 0, 0], [4, 8, 0]])
    animated(builder, 0, "translation", [0.0], [[9, 9, 9]])
    animated(builder, 0, "translation", [0.0, 2.0], [[0, 0, 0], [0, 0, 2]])
    builder.json["animations"].insert(0, builder.json["animations"].pop(1))
    builder.json["animations"][0]["name"] = "rest"
    builder.json["animations"][1]["name"] = "walk"
    return builder


def test_an_animation_is_chosen_by_its_name_or_number() -> None:
    poses = mesh_of(two()).poses
    assert poses
    assert poses.names == ("rest", "walk", "2")
    assert (poses.usual, poses.seconds("walk"), poses.seconds("2")) == ("walk", 4, 2)
    assert_allclose(at(two(), 1, "2"), shifted(0, 0, 1), atol=1e-12)
    assert_allclose(at(two(), 1, "rest"), POINTS + 9, atol=1e-12)
    with pytest.raises(ValueError, match="unknown animation 'wlak'; did you mean 'walk'"):
        at(two(), 1, "wlak")


def spoiled(change: Any) -> str:
    builder = moved("LINEAR", [[0, 0, 0], [4, 0, 0], [4, 8, 0]])
    change(builder.json["animations"][0], builder)
    with pytest.raises(SceneError) as refused:
        mesh_of(builder)
    return str(refused.value)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda a, b: a["samplers"][0].update(interpolation="CUBIC"), "LINEAR, STEP or CUBIC"),
        (lambda a, b: a["samplers"][0].update(interpolation="CUBICSPLINE"), "3 times and 3 values"),
        (lambda a, b: a["samplers"][0].update(input=b.accessor([0.0, 0, 1])), "times that grow"),
        (lambda a, b: a["samplers"][0].update(input=b.accessor([0.0, 1])), "2 times and 3 values"),
        (
            lambda a, b: a["samplers"][0].update(output=b.accessor([[0, 0, np.nan]] * 3)),
            "not finite",
        ),
        (lambda a, b: a["channels"][0].update(sampler=7), "names a sampler that there is not"),
        (lambda a, b: a["channels"][0]["target"].update(node=7), "nodes"),
        (lambda a, b: a.pop("samplers"), "samplers"),
    ],
)
def test_keys_that_do_not_fit_are_refused(change: Any, words: str) -> None:
    assert words in spoiled(change)


def test_channels_of_extensions_are_left_out() -> None:
    builder = moved("LINEAR", [[0, 0, 0], [4, 0, 0], [4, 8, 0]])
    target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/x"}}}
    builder.json["animations"][0]["channels"].append({"sampler": 0, "target": target})
    assert_allclose(at(builder, 2), shifted(4, 0, 0), atol=1e-12)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A file whose square moves for two seconds."""
    path = tmp_path / "square.glb"
    builder = Builder()
    node = builder.shown(square(builder))
    animated(builder, node, "translation", [0.0, 2.0], [[1, 0, 0], [3, 0, 0]])
    path.write_bytes(builder.glb())
    return path


def test_a_model_plays_its_animation(model: Path, tmp_path: Path) -> None:
    scene = load(model)
    assert scene.frames == 49
    assert_allclose(scene.meshes[0].world_vertices, POINTS, atol=1e-12)  # without animation
    assert_allclose(scene.at_frame(12).meshes[0].world_vertices, shifted(1.5, 0, 0), atol=1e-12)
    scene.save(tmp_path / "square.toml")
    saved = load(tmp_path / "square.toml")
    assert_allclose(saved.at_frame(48).meshes[0].world_vertices, shifted(3, 0, 0), atol=1e-12)
    output = tmp_path / "%d.exr"
    small = ("--width", "16", "--height", "16", "--samples", "1", "--frames", "0-1")
    assert command("film", model, "-o", output, *small).returncode == 0
    done = command("film", model, "-o", output, *small, "--json")
    assert [json.loads(line).get("kept") for line in done.stdout.splitlines()] == [True, True, None]


def test_a_model_is_rendered_in_its_pose_unless_a_frame_is_named(
    model: Path, tmp_path: Path
) -> None:
    small = ("--width", "16", "--height", "16", "--samples", "1")
    found = {}
    for name, more in (("pose", ()), ("start", ("--frame", "0"))):
        path = tmp_path / f"{name}.exr"
        assert command("render", model, "-o", path, *small, *more).returncode == 0
        found[name] = glrt.Image.load(path).radiance.mean()
    assert found["pose"] != found["start"]


@pytest.mark.parametrize("material", ["", 'material = "m",'])
def test_a_moment_that_a_file_lacks_is_refused(model: Path, tmp_path: Path, material: str) -> None:
    builder = Builder()
    builder.shown(square(builder))
    (tmp_path / "still.glb").write_bytes(builder.glb())
    text = """
    camera = { position = [0, 0, 5], look_at = [0, 0, 0] }
    background = { color = [1, 1, 1] }
    materials.m = { type = "lambertian", color = [1, 1, 1] }
    objects = [{ shape = "mesh", file = "FILE", MATERIAL time = 1.0, animation = "NAME" }]
    """
    for name, words in (("still.glb", "has no animation: leave `time` out"), (model.name, "NAME")):
        path = tmp_path / "scene.toml"
        path.write_text(text.replace("FILE", name).replace("MATERIAL", material))
        with pytest.raises(glrt.SceneError, match=words) as refused:
            load(path)
        assert "objects[0].file" in str(refused.value)
