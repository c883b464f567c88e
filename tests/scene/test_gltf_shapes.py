"""glTF files whose vertices are compressed, moved by morph targets, or have tangents."""

import sys
from typing import Any

import DracoPy
import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.mesh_formats import decode_mesh
from tests.support.gltf_files import POINTS, SQUARE, UV, Builder, square
from tests.support.meshes import icosphere

DRACO = "KHR_draco_mesh_compression"


def decoded(builder: Builder) -> TriangleMesh:
    return decode_mesh(builder.glb(), "thing.glb", "here")


def morphed(of_mesh: Any, **node: Any) -> Builder:
    """A square with two targets: one lifts a corner, the other turns normals."""
    builder = Builder()
    lift = {"POSITION": builder.accessor([[0, 0, 0], [0, 0, 0], [0, 0, 2], [0, 0, 0]])}
    turn = {
        "NORMAL": builder.accessor(np.tile([1.0, 0, 0], (4, 1))),
        "TEXCOORD_0": builder.accessor(np.tile([0.25, 0.5], (4, 1))),
    }
    builder.shown({**square(builder), "targets": [lift, turn]}, **node)
    if of_mesh is not None:
        builder.json["meshes"][0]["weights"] = of_mesh
    return builder


def test_morph_targets_have_the_weights_of_the_file() -> None:
    assert np.array_equal(decoded(morphed(None)).vertices, POINTS)
    mesh = decoded(morphed([0.5, 1.0]))
    assert_allclose(mesh.vertices, [[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]])
    assert_allclose(mesh.shading_normals, np.tile([1, 0, 1], (4, 1)) / 2**0.5)
    assert mesh.uv is not None
    assert_allclose(mesh.uv[:, :2], UV + np.array([0.25, 0.5]))
    own = decoded(morphed([0.5, 1.0], weights=[-0.5], translation=[0, 0, 3]))
    assert_allclose(own.vertices[:, 2], [3, 3, 2, 3])
    assert_allclose(own.shading_normals, np.tile([0, 0, 1], (4, 1)))


WRONG: dict[str, tuple[Any, Any, str]] = {
    "no list": ({}, [], "weights of morph targets must be a list"),
    "no number": (["a"], [], "a weight of a morph target must be a number"),
    "no table": ([1], [3], "meshes[0].primitives[0].targets[0] must be a table"),
    "other rows": ([1], [{"POSITION": 0}], "targets[0].POSITION has 3 rows"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_targets_are_refused(name: str) -> None:
    weights, targets, message = WRONG[name]
    builder = Builder()
    builder.accessor(POINTS[:3])
    builder.shown({**square(builder), "targets": targets}, weights=weights)
    with pytest.raises(SceneError) as caught:
        decoded(builder)
    assert message in str(caught.value)


def test_tangents_of_the_file_turn_with_its_node() -> None:
    builder = Builder()
    primitive = square(builder)
    primitive["attributes"]["TANGENT"] = builder.accessor(np.tile([0.0, 1, 0, -1], (4, 1)))
    builder.shown(primitive, rotation=[0, 0, 0.5**0.5, 0.5**0.5], scale=[2, 2, 2])
    builder.shown(square(builder), translation=[5, 0, 0])
    parts = decoded(builder)
    assert parts.tangents is not None
    assert_allclose(parts.tangents[:4], np.tile([-2, 0, 0], (4, 1)), atol=1e-6)
    assert_allclose(parts.shading_tangents[4:], np.tile([1, 0, 0], (4, 1)), atol=1e-6)
    (part,) = parts.parts.values()
    assert np.array_equal(part.shading_tangents, parts.shading_tangents)


def test_tangents_that_are_no_numbers_are_refused() -> None:
    builder = Builder()
    primitive = square(builder)
    primitive["attributes"]["TANGENT"] = builder.accessor([[0, 1, 0, 1.0]] * 3 + [[np.nan] * 4])
    builder.shown(primitive)
    with pytest.raises(SceneError, match="the tangent of vertex 3 is not finite"):
        decoded(builder)


def compressed(points: Any, faces: Any, uv: Any, length: int | None = None) -> Builder:
    """A file with a mesh that is compressed, cut to a length."""
    content = DracoPy.encode(points.astype(np.float32), faces, tex_coord=uv)
    parts = DracoPy.decode(content).attributes
    numbers = {len(part["data"][0]): part["unique_id"] for part in parts}
    builder = Builder()
    view = builder.view(content[:length])
    rows: dict[str, Any] = {}
    for name, kind in (("POSITION", "VEC3"), ("TEXCOORD_0", "VEC2")):
        table = {"componentType": 5126, "type": kind, "count": len(points)}
        builder.json["accessors"].append(table)
        rows[name] = len(rows)
    own = {
        "bufferView": view,
        "attributes": {"POSITION": numbers[3], "TEXCOORD_0": numbers[2]},
    }
    builder.shown({"attributes": rows, "extensions": {DRACO: own}})
    builder.json["extensionsRequired"] = [DRACO]
    return builder


def test_what_is_compressed_is_the_mesh_that_it_was() -> None:
    points, faces = icosphere(2)
    uv = points[:, :2]
    mesh = decoded(compressed(points, faces, uv))
    assert mesh.uv is not None
    corner, expected = mesh.vertices[mesh.faces].mean(axis=1), points[faces].mean(axis=1)
    nearest = np.linalg.norm(corner[:, None] - expected, axis=2).min(axis=0)
    assert len(mesh.faces) == len(faces)
    assert nearest.max() < 1e-3, "its numbers are rounded to 14 bits"
    assert_allclose(mesh.uv[:, :2], mesh.vertices[:, :2], atol=2e-3)


def test_what_is_damaged_or_lacks_the_library_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for length in (1, 5, 60):
        with pytest.raises(SceneError, match=f"extensions.{DRACO} is damaged"):
            decoded(compressed(POINTS, SQUARE, UV, length))
    broken = compressed(POINTS, SQUARE, UV)
    primitive = broken.json["meshes"][0]["primitives"][0]
    primitive["extensions"][DRACO]["attributes"]["POSITION"] = 9
    with pytest.raises(SceneError, match="POSITION names a part that there is not"):
        decoded(broken)
    sound = compressed(POINTS, SQUARE, UV)
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    with pytest.raises(
        SceneError, match=r"^here: 'thing.glb' is compressed .*pip install .*\[draco\]'$"
    ):
        decoded(sound)
