"""PLY and STL files as other programs write them."""

import struct
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose

from tests.support.meshes import icosphere
from tests.support.model_contents import area, read, refusal

HEADER = "ply\nformat {} 1.0\ncomment caf\xe9\nelement vertex 5\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"
PLACES = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 2, 0)]
MIXED = [(0, 1, 2, 3), (3, 2, 4)]


def ply(order: str, faces: Any = MIXED, behind: bytes = b"") -> bytes:
    name = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}[order]
    head = HEADER.format(name) + XYZ + f"element face {len(faces)}\n"
    head += "property uchar flags\nproperty list uchar int vertex_indices\nproperty short tag\n"
    head += "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    if not order:
        rows = [" ".join(map(str, place)) for place in PLACES]
        rows += [" ".join(map(str, [7, len(face), *face, -2])) for face in faces]
        return (head + "\n".join(rows) + "\n0 1\n").encode("latin-1") + behind
    body = b"".join(struct.pack(f"{order}3f", *place) for place in PLACES)
    for face in faces:
        body += struct.pack(f"{order}BB{len(face)}ih", 7, len(face), *face, -2)
    return head.encode("latin-1") + body + struct.pack(f"{order}2i", 0, 1) + behind


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("faces", [MIXED, [(0, 1, 2), (0, 2, 3), (3, 2, 4)]])
def test_a_ply_file_may_have_polygons_of_several_sizes(order: str, faces: Any) -> None:
    mesh = read(ply(order, faces, b"\n"), ".ply")
    assert (area(mesh), len(mesh.faces), mesh.unread) == (1.5, 3, ())
    assert area(read(ply(order, [*faces, (0, 1)]), ".ply")) == 1.5


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_a_ply_file_that_is_cut_off_is_refused(order: str) -> None:
    whole = ply(order)
    for length in range(len(whole) - 20, len(whole) - 9):
        cut = whole[:length]
        assert "is damaged" in refusal(cut, ".ply")


def test_a_ply_file_may_have_coordinates_of_corners() -> None:
    head = HEADER.format("ascii") + XYZ + "element face 2\nproperty list uchar int vertex_index\n"
    head += "property list uchar float texcoord\nend_header\n"
    rows = [" ".join(map(str, place)) for place in PLACES]
    rows += ["3 0 1 2 6 0 0 1 0 1 1", "3 0 2 3 6 0.5 0.5 1 1 0 1"]
    mesh = read((head + "\n".join(rows)).encode("latin-1"), ".ply")
    assert mesh.uv is not None
    found = mesh.uv[mesh.faces][..., :2]
    assert_allclose(found[0], [[0, 1], [1, 1], [1, 0]])
    assert_allclose(found[1], [[0.5, 0.5], [1.0, 0.0], [0.0, 0.0]])
    assert len(mesh.vertices) == 5  # vertex 0 twice, vertex 2 once


def test_strips_turn_every_second_triangle() -> None:
    head = HEADER.format("ascii") + XYZ + "element tristrips 1\n"
    head += "property list int int vertex_indices\nend_header\n"
    rows = [" ".join(map(str, place)) for place in PLACES]
    mesh = read((head + "\n".join(rows) + "\n8 0 1 3 2 -1 3 2 4\n").encode("latin-1"), ".ply")
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    assert np.cross(b - a, c - a)[:, 2].tolist() == [1, 1, 1]


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("plx\nend_header\n", "does not begin with a header"),
        ("ply\nformat ascii 1.0\n", "does not begin with a header"),
        ("ply\nformat foo 1.0\nend_header\n", "names no format"),
        ("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "the element 'vertex -1'"),
        ("ply\nformat ascii 1.0\nproperty float x\nend_header\n", "before the first element"),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n1",
            "the property 'real x'",
        ),
        ("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", "no vertices with x, y and z"),
        (HEADER.format("ascii") + XYZ + "end_header\n" + "0 0 0\n" * 5, "no faces with a list"),
        (HEADER.format("ascii") + XYZ + "end_header\n" + "0 0 a\n" * 5, "other words than numbers"),
    ],
)
def test_a_ply_file_that_is_wrong_says_why(header: str, words: str) -> None:
    assert words in refusal(header.encode("latin-1"), ".ply")


FACET = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet"


@pytest.mark.parametrize(
    "text",
    [
        f"solid caf\xe9\n{FACET}\nendsolid",
        f"solid\n{FACET}",
        f"solid {FACET} endsolid",
        f"SOLID\n{FACET.upper()}\nENDSOLID",
    ],
)
def test_an_stl_file_in_text_needs_no_lines_and_no_end(text: str) -> None:
    assert area(read(text.encode("latin-1"), ".stl")) == 0.5


def test_an_stl_file_may_begin_with_solid_and_have_bytes_behind() -> None:
    vertices, faces = icosphere(1)
    rows = np.zeros(len(faces), [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("more", "<u2")])
    rows["c"] = vertices[faces]
    for header in (b"solid facet endsolid", b"binary"):
        data = header.ljust(80) + np.uint32(len(faces)).tobytes() + rows.tobytes()
        assert area(read(data, ".stl")) == pytest.approx(
            trimesh.Trimesh(vertices, faces).area, 1e-6
        )
        assert "is damaged" in refusal(data[:-1], ".stl")
    assert len(read(data + b"\0" * 92, ".stl").faces) == len(faces)


def test_a_bad_number_in_an_stl_file_names_its_line() -> None:
    text = f"solid\n{FACET}\n".replace("vertex 1 0 0", "\nvertex 1 0 x\n")
    assert "line 3 has other words than numbers" in refusal(text, ".stl")
