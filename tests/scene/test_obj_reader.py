"""OBJ files as other programs write them, and polygons of any form."""

from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as some
from numpy.testing import assert_allclose

from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.polygons import triangulated
from tests.support.meshes import icosphere
from tests.support.model_contents import area, read, refusal

CONCAVE = [[0, 0], [2, 0], [2, 2], [1, 0.5], [0, 2]]  # 2.5 by the shoelace formula


def shoelace(points: Any) -> float:
    x, y = np.array(points, float).T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
ONE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
TEXTS = {  # texts that mean a triangle of area 0.5
    "plain": ONE + "f 1 2 3\n",
    "tabs": ONE.replace(" ", "\t") + "f\t1\t2\t3\n",
    "indented": "   " + ONE.replace("\n", "\n  ") + "f 1 2 3",
    "old Mac": (ONE + "f 1 2 3\n").replace("\n", "\r"),
    "Windows": (ONE + "f 1 2 3\n").replace("\n", "\r\n"),
    "byte order mark": "\ufeff" + ONE + "f 1 2 3\n",
    "comments": "# v 9\n" + ONE.replace("\n", " # here\n") + "f 1 2 3 # and here\n",
    "continued": ONE + "f 1 \\\n2 \\\n3\n",
    "one coordinate": ONE + "vt 0.5\nvt 0.5\nvt 0.5\nf 1/1 2/2 3/3\n",
    "weights": ONE.replace("0\n", "0 1.0\n") + "f 1 2 3\n",
    "faces first": "f 1 2 3\n" + ONE,
    "slashes": ONE + "vt 0 0\nf 1/1/ 2/1/ 3/1/\n",
    "capitals": ONE.replace("v", "V") + "F 1 2 3\n",
    "lines and points": ONE + "l 1 2\np 3\nf 1 2 3\n",
}


@pytest.mark.parametrize("case", TEXTS)
def test_an_obj_file_may_be_written_in_many_ways(case: str) -> None:
    mesh = read(TEXTS[case])
    assert len(mesh.faces) == 1
    assert area(mesh) == 0.5
    assert mesh.unread == ()


@pytest.mark.parametrize("encoding", ["latin-1", "utf-16-le", "utf-16-be", "utf-8"])
def test_names_may_be_in_any_encoding(encoding: str) -> None:
    mark = "" if encoding in ("latin-1", "utf-8") else "\ufeff"
    text = f"{mark}# caf\xe9\nusemtl gr\xfcn\n{ONE}f 1 2 3\n"
    mesh = read(text.encode(encoding))
    assert mesh.names == ("gr\xfcn",)
    assert area(mesh) == 0.5


def test_negative_numbers_count_from_the_face_that_has_them() -> None:
    """Two squares, each followed by its face: both name vertices -4 to -1."""
    square = "v {0} 0 0\nv {1} 0 0\nv {1} 1 0\nv {0} 1 0\nvt {0} 0\nf -4/-1 -3/-1 -2/-1 -1/-1\n"
    mesh = read(square.format(0, 1) + square.format(2, 3))
    assert area(mesh) == 2
    assert mesh.uv is not None
    assert_allclose(mesh.vertices[mesh.faces[2:], 0].min(), 2)
    assert_allclose(mesh.uv[mesh.faces[2:], 0], 2)


def test_corners_keep_their_own_normals_and_coordinates() -> None:
    """One part has normals, one has coordinates, and one has neither."""
    text = SQUARE + "vn 0 0 2\nvt 0.25 0.75\nf 1//1 2//1 3//1\nf 1/1 3/1 4/1\nf 1 2 4\n"
    mesh = read(text)
    assert mesh.normals is not None
    assert mesh.uv is not None
    assert_allclose(mesh.normals[mesh.faces[0]], [[0, 0, 2]] * 3)
    assert not mesh.normals[mesh.faces[1:]].any()
    assert_allclose(mesh.uv[mesh.faces[1], :2], [[0.25, 0.25]] * 3)
    assert_allclose(mesh.uv[mesh.faces[[0, 2]], :2], np.broadcast_to([0, 0], (2, 3, 2)))
    assert mesh.unread == ()


def test_numbers_of_coordinates_that_are_missing_are_left_out() -> None:
    mesh = read(ONE + "vt 0 0\nf 1/1/7 2/9/7 3/1/7\n")
    assert mesh.unread == (
        "texture coordinates of 1 corner",
        "normals of 3 corners",
    )
    assert mesh.normals is None


def test_materials_are_in_the_order_of_their_faces() -> None:
    text = (
        SQUARE + "f 1 2 3\nusemtl b\nusemtl a # one\nf 1 2 4\nusemtl b\nf 2 3 4\nusemtl\nf 1 3 4\n"
    )
    mesh = read(text)
    assert mesh.names == ("without material", "a", "b")
    assert mesh.labels is not None
    assert mesh.labels.tolist() == [0, 1, 2, 0]


def test_colors_are_numbers_from_0_to_1_or_whole_ones_to_255() -> None:
    for colors in (("1 0 0", "0 1 0", "0 0 1"), ("255 0 0", "0 255 0", "0 0 255")):
        lines = [line + f" {c}" for line, c in zip(ONE.split("\n"), colors, strict=False)]
        mesh = read("\n".join(lines) + "\nf 1 2 3\n")
        assert mesh.colors is not None
        assert_allclose(mesh.colors, np.eye(3))
    some_lack = read(ONE.replace("0 1 0", "0 1 0 0.5 0.5 0.5") + "f 1 2 3\n")
    assert some_lack.unread == ("the color of 2 vertices",)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (ONE + "f 1 2 9\n", "line 4 names vertex 9, and the file has 3 vertices"),
        (ONE + "f 1 2 0\n", "line 4 names vertex 0"),
        (ONE + "f 1 2 -4\n", "line 4 names vertex -4"),
        (ONE + "f 1 2 x\n", "line 4 has a corner that is not numbers: 'x'"),
        (ONE + "f 1/2/3/4 2/2/2/2 3/3/3/3\n", "line 4 has a corner that is not numbers"),
        ("v 0 0\n" + ONE + "f 1 2 3\n", "line 1 has fewer than 3 numbers: '0 0'"),
        ("v 0 0 1,5\n" + ONE + "f 1 2 3\n", "line 1 has other words than numbers: '0 0 1,5'"),
        (ONE, "it has no faces"),
        (ONE + "f 1 2\n", "it has no faces"),
        ("", "it has no faces"),
    ],
)
def test_an_obj_file_that_is_wrong_names_its_line(text: str, words: str) -> None:
    assert words in refusal(text)


def test_what_is_no_polygon_is_reported() -> None:
    mesh = read(ONE + "f 1 2\nf 1 2 3\ncurv 0 1 1 2\n")
    assert mesh.unread == (
        "1 face of fewer than three corners",
        "1 line of curves and surfaces",
    )


def polygon(points: Any) -> TriangleMesh:
    rows = [f"v {x!r} {y!r} 0" for x, y in np.array(points, float).tolist()]
    return read("\n".join(rows) + "\nf " + " ".join(str(k + 1) for k in range(len(rows))))


@pytest.mark.parametrize("shift", range(5))
def test_a_concave_polygon_keeps_its_area_whichever_corner_is_first(shift: int) -> None:
    turned = np.roll(np.array(CONCAVE), shift, axis=0)
    for points in (turned, turned[::-1]):
        mesh = polygon(points)
        assert area(mesh) == pytest.approx(shoelace(CONCAVE), rel=1e-12)
        a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
        sides = np.cross(b - a, c - a)[:, 2]
        assert (sides * (1 if points is turned else -1) >= 0).all(), "all face one way"


@given(some.lists(some.floats(0.2, 1), min_size=4, max_size=12))
def test_stars_keep_their_area_and_their_edges(radii: list[float]) -> None:
    """A polygon around its middle, and its edges: each belongs to one triangle, once."""
    angles = 2 * np.pi * np.arange(len(radii)) / len(radii)
    points = np.array(radii)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    flat = np.column_stack([points, np.zeros(len(points))])
    counts = np.array([len(points)])
    triangles, owner = triangulated(flat, np.arange(len(points)), counts)
    a, b, c = (flat[triangles[:, k]] for k in range(3))
    assert np.cross(b - a, c - a)[:, 2].sum() / 2 == pytest.approx(shoelace(points), rel=1e-9)
    assert not owner.any()
    edges = {(int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3)}
    assert {(k, (k + 1) % len(points)) for k in range(len(points))} <= edges


@pytest.mark.parametrize(
    "points",
    [
        [[0, 0], [1, 0], [2, 0], [2, 2], [1, 0.5], [0, 2]],  # a corner on an edge
        [[1, 1], [-1, 1], [-2, -1], [-3, -1], [0, -1]],  # a spike without area
    ],
)
def test_corners_without_an_angle_are_kept(points: list[list[float]]) -> None:
    """Their neighbours have these corners: without them the solid would be open."""
    assert area(polygon(points)) == shoelace(points)
    outline = np.array([[x, y, 0.0] for x, y in points])
    count = len(points)
    sides = [[k, (k + 1) % count, (k + 1) % count + count, k + count] for k in range(count)]
    vertices = np.concatenate([outline, outline + np.array([0, 0, 1])])
    faces = [list(range(count))[::-1], [k + count for k in range(count)], *sides]
    lines = [f"v {x} {y} {z}" for x, y, z in vertices]
    lines += ["f " + " ".join(str(k + 1) for k in face) for face in faces]
    mesh = read("\n".join(lines))
    assert mesh.outward.opening == ""


def test_meshes_are_those_that_trimesh_reads() -> None:
    """An independent reader of plain files agrees to the last digit."""
    vertices, faces = icosphere(2)
    solid = trimesh.Trimesh(vertices, faces, process=False)
    for suffix in ("obj", "ply", "stl"):
        exported: Any = trimesh.exchange.export.export_mesh
        data = exported(solid, None, suffix, **({"digits": 17} if suffix == "obj" else {}))
        mesh = read(data, f".{suffix}")
        expected = vertices[faces].astype(np.float32) if suffix != "obj" else vertices[faces]
        assert_allclose(mesh.vertices[mesh.faces], expected, rtol=0, atol=0)
