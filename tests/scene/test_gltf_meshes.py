"""Triangles of glTF files: every layout, where nodes put them; what is wrong is refused."""

import json
import time
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose

from glrt.errors import SceneError
from glrt.scene.mesh_formats import decode_mesh
from glrt.scene.triangle_meshes import TriangleMesh
from tests.scene.test_mesh_files import damaged
from tests.support.gltf_files import POINTS, SQUARE, UV, Builder, square, textured_square
from tests.support.meshes import icosphere


def decoded(builder: Builder, suffix: str = ".glb") -> TriangleMesh:
    content = builder.glb() if suffix == ".glb" else builder.gltf()
    return decode_mesh(content, f"thing{suffix}", "here")


def corners(mesh: TriangleMesh) -> Any:
    """(n, 3, 3), in an order that does not depend on the first corner or the first triangle."""
    found = mesh.vertices[mesh.faces]
    turned = [np.roll(face, -np.lexsort(face.T[::-1])[0], axis=0) for face in found]
    return np.array(sorted(turned, key=lambda face: face.tolist()))


PLAIN = corners(TriangleMesh(POINTS, SQUARE, None))


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_a_square_is_read(suffix: str) -> None:
    builder = Builder()
    builder.shown(square(builder))
    mesh = decoded(builder, suffix)
    assert np.array_equal(corners(mesh), PLAIN)
    assert mesh.names == ("without material",)
    assert_allclose(mesh.shading_normals, np.tile([0, 0, 1], (4, 1)))
    assert mesh.uv is not None
    assert np.array_equal(mesh.uv[:, :2], UV)


@pytest.mark.parametrize("code", ["u1", "u2", "u4", None])
@pytest.mark.parametrize("mode", [4, 5, 6])
def test_every_order_of_triangles(code: str | None, mode: int) -> None:
    order = {4: SQUARE.ravel(), 5: np.array([0, 1, 3, 2]), 6: np.arange(4)}[mode]
    builder = Builder()
    points = POINTS if code else POINTS[order]
    primitive: dict[str, Any] = {"attributes": {"POSITION": builder.accessor(points)}}
    if code:
        primitive["indices"] = builder.accessor(order, code)
    builder.shown({**primitive, "mode": mode})
    found = corners(decoded(builder))
    assert np.array_equal(found, PLAIN) or mode == 5  # a strip divides the square the other way
    across = np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0])
    assert np.array_equal(across, np.tile([0.0, 0, 1], (2, 1))), "both face forwards"


def test_without_normals_triangles_are_flat() -> None:
    points, faces = icosphere(1)
    builder = Builder()
    builder.shown(
        {
            "attributes": {"POSITION": builder.accessor(points)},
            "indices": builder.accessor(faces.ravel(), "u4"),
        }
    )
    mesh = decoded(builder)
    corner = mesh.vertices[mesh.faces]
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    assert_allclose(mesh.shading_normals[mesh.faces], across[:, None].repeat(3, axis=1), atol=1e-6)
    assert mesh.opening == "", "closed all the same"


def test_nodes_move_turn_scale_and_mirror() -> None:
    """As trimesh has them, with a matrix, with parts, nested."""
    builder = Builder()
    primitive = square(builder)
    turn = {"translation": [1, 2, 3], "rotation": [0.5, 0.5, 0.5, 0.5], "scale": [1, -2, 3]}
    inner = builder.shown(primitive, **turn)
    matrix = np.array([[0.0, -2, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]])
    outer = builder.add("nodes", {"matrix": matrix.T.ravel().tolist(), "children": [inner]})
    builder.add("scenes", {"nodes": [outer]})
    mesh = decoded(builder)
    oracle: Any = trimesh.load(trimesh.util.wrap_as_stream(builder.glb()), file_type="glb")
    points = oracle.to_geometry().vertices
    assert_allclose(sorted(mesh.vertices.tolist()), sorted(points.tolist()), atol=1e-12)
    corner = mesh.vertices[mesh.faces]
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    facing = (across * mesh.shading_normals[mesh.faces[:, 0]]).sum(axis=1)
    assert (facing > 0).all(), "normals stay on the side of their triangles"


def test_each_node_shows_its_mesh() -> None:
    builder = Builder()
    first = builder.shown(square(builder))
    builder.add("nodes", {"mesh": builder.json["nodes"][first]["mesh"], "translation": [5, 0, 0]})
    mesh = decoded(builder)
    assert len(mesh.faces) == 4
    assert mesh.box[1][0] == 6


def test_the_scene_of_the_file_is_shown_alone() -> None:
    builder = Builder()
    for move in ([0, 0, 0], [9, 0, 0]):
        builder.shown(square(builder), translation=move)
    builder.json |= {"scenes": [{"nodes": [0]}, {"nodes": [1]}], "scene": 1}
    assert decoded(builder).box[0][0] == 9


def test_sparse_interleaved_and_quantized_rows() -> None:
    builder = Builder()
    rows = np.zeros(4, [("place", "<f4", 3), ("other", "<f4", 2)])
    rows["place"] = POINTS
    view = builder.view(rows.tobytes(), byteStride=20)
    float3 = {"componentType": 5126, "type": "VEC3", "count": 4}
    builder.json["accessors"].append({"bufferView": view, **float3})
    sparse = {
        "count": 1,
        "indices": {
            "bufferView": builder.view(np.array([2], np.uint16).tobytes()),
            "componentType": 5123,
        },
        "values": {"bufferView": builder.view(np.full(3, 4, np.float32).tobytes())},
    }
    builder.json["accessors"].append({"bufferView": view, **float3, "sparse": sparse})
    builder.json["accessors"].append({**float3, "sparse": {**sparse}})
    small = builder.accessor(POINTS * 127, "i1", normalized=True)
    whole = builder.accessor(POINTS * 3, "u2")
    order = builder.accessor(SQUARE.ravel(), "u1")
    expected = [POINTS, POINTS.copy(), POINTS * 0, POINTS, POINTS * 3]
    expected[1][2] = expected[2][2] = 4
    for number, points in zip((0, 1, 2, small, whole), expected, strict=True):
        builder.json["nodes"], builder.json["meshes"] = [], []
        builder.shown({"attributes": {"POSITION": number}, "indices": order})
        known = corners(TriangleMesh(points, SQUARE, None))
        assert np.array_equal(corners(decoded(builder)), known)


def test_colors_and_the_second_set_of_coordinates() -> None:
    builder = Builder()
    primitive = square(builder)
    colors = np.array([[255, 0, 0, 255]] * 2 + [[0, 51, 0, 0]] * 2)
    primitive["attributes"]["COLOR_0"] = builder.accessor(colors, "u1", normalized=True)
    primitive["attributes"]["TEXCOORD_1"] = builder.accessor(UV * 2)
    builder.shown(primitive)
    mesh = decoded(builder)
    assert mesh.colors is not None
    assert mesh.uv is not None
    assert_allclose(mesh.colors, [[1, 0, 0]] * 2 + [[0, 0.2, 0]] * 2)
    assert np.array_equal(mesh.uv, np.concatenate([UV, UV * 2], axis=1))


def test_materials_are_parts() -> None:
    builder = Builder()
    for name in ("red", "red", ""):
        builder.shown(square(builder, material=builder.add("materials", {"name": name})))
    builder.shown(square(builder))
    mesh = decoded(builder)
    names = ["red", "red 1", "material 2", "without material"]
    assert list(mesh.parts) == names
    assert [len(part.faces) for part in mesh.parts.values()] == [2] * 4


def test_points_and_lines_are_left_out() -> None:
    builder = Builder()
    builder.shown(square(builder))
    for mode in (0, 1, 2, 3):
        builder.shown({**square(builder), "mode": mode})
    assert len(decoded(builder).faces) == 2


def broken(change: str, value: Any) -> bytes:
    """A sound file with one value replaced, at a path as `accessors.0.count`."""
    builder = textured_square()
    builder.json["scenes"] = [{"nodes": [0]}]
    *path, last = change.split(".")
    place: Any = builder.json
    for step in path:
        place = place[int(step)] if step.isdigit() else place[step]
    place[int(last) if last.isdigit() else last] = value
    return builder.glb()


WRONG: dict[str, tuple[str, Any, str]] = {
    "another version": ("asset.version", "1.0", "asset.version must be 2.0, got '1.0'"),
    "a needed extension": ("extensionsRequired", ["EXT_x"], "requires the extension 'EXT_x'"),
    "compressed": ("extensionsRequired", ["KHR_draco_mesh_compression"], "draco"),
    "a view that is not there": ("accessors.0.bufferView", 99, "names bufferViews[99]"),
    "an accessor that is not there": ("meshes.0.primitives.0.indices", 99, "accessors[99]"),
    "a mesh that is not there": ("nodes.0.mesh", -1, "names meshes[-1]"),
    "a long view": ("bufferViews.1.byteLength", 1 << 30, "ends after its buffer"),
    "a negative count": ("accessors.0.count", -4, "count must be a whole number"),
    "a huge count": ("accessors.0.count", 1 << 36, "count must be at most"),
    "a wrong type": ("accessors.0.componentType", 7, "componentType is none of"),
    "too many rows": ("accessors.0.count", 4000, "ends after its view"),
    "a circle": ("nodes.0.children", [0], "stands below itself"),
    "a wrong mode": ("meshes.0.primitives.0.mode", 9, "mode must be"),
    "no list": ("meshes.0.primitives", {}, "primitives must be a list"),
    "no number": ("nodes.0.translation", ["a", 0, 0], "translation[0] must be a number"),
    "no turn": ("nodes.0.rotation", [0, 0, 0, 0], "rotation must not be zero"),
    "a huge matrix": ("nodes.0.scale", [1e300, 1, 1], "scale[0] must be a number from"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_refused_by_its_place(name: str) -> None:
    change, value, message = WRONG[name]
    with pytest.raises(SceneError, match=r"^here: 'thing.glb' is damaged") as caught:
        decode_mesh(broken(change, value), "thing.glb", "here")
    assert message in str(caught.value)


ENDS: dict[str, tuple[bytes, str]] = {
    "nothing": (b"", "JSON is wrong"),
    "a header alone": (b"glTF\x02\0\0\0", "ends within its header"),
    "half a file": (textured_square().glb()[:200], "and states"),
    "nested lists": (b"[" * 100_000, "nested too deeply"),
    "a list": (b"[]", "no table"),
    "no number": (b'{"asset": {"version": NaN}}', "NaN"),
    "no base64": (
        textured_square().gltf("data:application/octet-stream;base64,???"),
        "damaged base64",
    ),
    "a data URI without data": (textured_square().gltf("data:x"), "without ';base64,'"),
    "a web address": (textured_square().gltf("https://example.org/a.bin"), "web address"),
    "no triangles": (Builder().glb(), "it shows no triangles"),
}


@pytest.mark.parametrize("name", ENDS)
def test_files_that_are_none_are_refused(name: str) -> None:
    content, message = ENDS[name]
    with pytest.raises(SceneError) as caught:
        decode_mesh(content, "thing.gltf", "here")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def survives(content: bytes, seed: int) -> None:
    start, told = time.process_time(), ""
    try:
        decode_mesh(damaged(content, seed), "thing.gltf", "here")
    except SceneError as error:
        told = str(error)
    assert not told or told.startswith("here: 'thing.gltf'")
    assert time.process_time() - start < 10


def indented(builder: Builder) -> bytes:
    """With a line for each value: damage meets few at once."""
    return json.dumps(json.loads(builder.gltf()), indent=0).encode()


SOUND = {"glb": textured_square().glb(), "gltf": indented(textured_square())}


@pytest.mark.parametrize("kind", SOUND)
def test_damaged_files_are_read_or_refused(kind: str) -> None:
    for seed in range(150):
        survives(SOUND[kind], seed)


@pytest.mark.slow
@pytest.mark.parametrize("kind", SOUND)
def test_thousands_of_damaged_files_are_read_or_refused(kind: str) -> None:
    for seed in range(1000, 3000):
        survives(SOUND[kind], seed)


def test_a_buffer_beside_the_file_is_read() -> None:
    builder = textured_square()
    read = decode_mesh(
        builder.gltf("a%20b.bin"), "x.gltf", "here", {"a b.bin": builder.binary}.__getitem__
    )
    assert len(read.faces) == 2
    with pytest.raises(SceneError, match="its own content is at hand"):
        decode_mesh(builder.gltf("a.bin"), "x.gltf", "here")
