"""Triangles of glTF files: every layout, where nodes put them; what is wrong is refused."""

from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.mesh_formats import decode_mesh
from tests.support.gltf_files import POINTS, SQUARE, UV, Builder, square
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
    """The result is trimesh's: with a matrix, with parts, nested."""
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


def test_a_skin_has_the_pose_of_its_joints() -> None:
    """Two vertices follow a joint that is turned and moved, and two one that stays."""
    builder = Builder()
    primitive = square(builder)
    joints = np.array([[0, 1, 0, 0]] * 4)
    weights = np.array([[1.0, 0, 0, 0]] * 2 + [[0, 2.0, 0, 0]] * 2)
    primitive["attributes"] |= {
        "JOINTS_0": builder.accessor(joints, "u1"),
        "WEIGHTS_0": builder.accessor(weights),
    }
    moved = np.eye(4)
    moved[:3, 3] = [0, 0, -5]  # by column in files
    rows = np.concatenate([np.eye(4).T.reshape(1, 16), moved.T.reshape(1, 16)])
    view = builder.view(rows.astype("<f4").tobytes())
    table = {"bufferView": view, "componentType": 5126, "type": "MAT4", "count": 2}
    builder.json["accessors"].append(table)
    number = len(builder.json["accessors"]) - 1
    builder.shown(primitive, skin=0, translation=[100, 0, 0])
    still = builder.add("nodes", {"name": "still"})
    turned = builder.add("nodes", {"translation": [0, 0, 7], "rotation": [0, 0, 1, 0]})
    builder.add("skins", {"joints": [still, turned], "inverseBindMatrices": number})
    mesh = decoded(builder)
    expected = [[0, 0, 0], [1, 0, 0], [-1, -1, 2], [0, -1, 2]]
    assert_allclose(mesh.vertices, expected, atol=1e-7)


def test_points_and_lines_are_left_out() -> None:
    builder = Builder()
    builder.shown(square(builder))
    for mode in (0, 1, 2, 3):
        builder.shown({**square(builder), "mode": mode})
    assert len(decoded(builder).faces) == 2


def test_a_file_without_triangles_is_whole_and_shows_none() -> None:
    builder = Builder()
    builder.shown({**square(builder), "mode": 1})
    with pytest.raises(SceneError, match=r"^here: 'thing.glb' shows no triangles: ") as caught:
        decoded(builder)
    assert "damaged" not in str(caught.value)
