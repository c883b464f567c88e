"""Colours of vertices: read from files, decoded, checked, kept by arrays."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.scene.files.named_meshes import mesh_of_arrays
from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from glrt.scene.model_files.mesh_formats import decode_mesh

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
FACE = np.array([[0, 1, 2]])
LINEAR = np.array([[1.0, 0.5, 0.0], [0.25, 0.125, 1.0], [0.0, 0.75, 0.0625]])


def encoded(linear: Any) -> Any:
    """IEC 61966-2-1."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def ply(kind: str, codes: Any, names: str = "red green blue") -> bytes:
    lines = [
        "ply",
        "format ascii 1.0",
        "element vertex 3",
        *(f"property float {axis}" for axis in "xyz"),
        *(f"property {kind} {name}" for name in names.split()),
        "element face 1",
        "property list uchar int vertex_indices",
        "end_header",
        *(" ".join(map(str, row)) for row in np.concatenate([POINTS, codes], axis=1).tolist()),
        "3 0 1 2",
    ]
    text = "\n".join(lines) + "\n"
    return (text if "float" in kind else text.replace(".0 ", " ").replace(".0\n", "\n")).encode()


def obj(codes: Any) -> bytes:
    rows = np.concatenate([POINTS, codes], axis=1).tolist()
    return ("".join(f"v {' '.join(map(str, row))}\n" for row in rows) + "f 1 2 3\n").encode()


FILES: dict[str, tuple[str, bytes, float]] = {  # with what a code is rounded to
    "bytes": (".ply", ply("uchar", np.rint(encoded(LINEAR) * 255)), 1 / 255),
    "words": (".ply", ply("ushort", np.rint(encoded(LINEAR) * 65535)), 1 / 65535),
    "floats": (".ply", ply("float", LINEAR), 1e-7),
    "OBJ": (".obj", obj(encoded(LINEAR)), 1e-12),
}


@pytest.mark.parametrize("name", FILES)
def test_colours_are_read_as_linear_light(name: str) -> None:
    suffix, content, within = FILES[name]
    mesh = decode_mesh(content, f"thing{suffix}", "here")
    assert mesh.colors is not None
    assert_allclose(mesh.colors, LINEAR, atol=within)


def test_opacity_is_left_out() -> None:
    codes = np.concatenate([LINEAR * 0 + 255, [[7]] * 3], axis=1)
    mesh = decode_mesh(ply("uchar", codes, "red green blue alpha"), "thing.ply", "here")
    assert mesh.colors is not None
    assert (mesh.colors == 1).all()


def test_colours_of_arrays_are_kept_to_the_last_digit() -> None:
    colors = LINEAR / 3
    named = mesh_of_arrays(POINTS, FACE, colors=colors)
    assert named.content
    mesh = decode_mesh(named.content, named.file, "here")
    assert mesh.colors is not None
    assert np.array_equal(mesh.colors, colors)


def test_colours_go_with_their_vertices() -> None:
    """Where one that no triangle uses is left out."""
    mesh = checked(
        MeshArrays(
            np.concatenate([[[9.0, 9, 9]], POINTS]), FACE + 1, colors=[[2.0] * 3, *LINEAR.tolist()]
        )
    )
    assert mesh.colors is not None
    assert np.array_equal(mesh.colors, LINEAR)


@pytest.mark.parametrize(
    ("colors", "message"),
    [
        (LINEAR[:2], "it has 2 colors for 3 vertices"),
        (LINEAR * [1, 2, 1], "the color of vertex 2 is not three numbers from 0 to 1"),
        (LINEAR * [1, 1, np.nan], "the color of vertex 0 is not three numbers from 0 to 1"),
        (LINEAR[:, :2], "colors must be an array of numbers of shape (n, 3)"),
    ],
)
def test_what_is_no_colour_is_refused(colors: Any, message: str) -> None:
    with pytest.raises(ValueError, match=r".") as caught:
        glrt.Mesh(POINTS, FACE, colors=colors, material="white")
    assert message in str(caught.value)
