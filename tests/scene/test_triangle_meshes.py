"""Meshes as arrays: what is refused, whether they are closed, and their normals."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.core.errors import SceneError
from glrt.core.text import counted
from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from tests.support.meshes import blob, box, icosphere

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
NO_NUMBER = np.array([[0.0, 0, 0], [1, 0, 0], [0, np.nan, 0], [0, 0, 1]])

REFUSED: dict[str, tuple[Any, Any, Any]] = {
    "it has no triangles": (POINTS, np.zeros((0, 3), int), None),
    "it has no triangle with three corners": (POINTS, [[0, 0, 1]], None),
    "triangle 1 has the corners 0, 1, 4, and there are 4 vertices": (
        POINTS,
        [[0, 1, 2], [0, 1, 4]],
        None,
    ),
    "triangle 0 has the corners 0, -1, 2": (POINTS, [[0, -1, 2]], None),
    "vertex 2 has a coordinate that is no number": (NO_NUMBER, FACES, None),
    "vertex 1 has a coordinate that is no number from -1e15 to 1e15": (
        POINTS * [1e16, 1, 1],
        FACES,
        None,
    ),
    "it has 3 normals for 4 vertices": (POINTS, FACES, POINTS[:3]),
    "the normal of vertex 2 is not finite": (POINTS, FACES, NO_NUMBER),
    "vertices must be an array of numbers of shape (n, 3), got one of shape (4, 2)": (
        POINTS[:, :2],
        FACES,
        None,
    ),
    "vertices must be an array of shape (n, 3)": ([[0, 0, 0], [1, 0]], FACES, None),
    "faces must be whole numbers": (POINTS, FACES * 1.0, None),
    "faces must be an array of numbers": (POINTS, [["a", "b", "c"]], None),
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_wrong_is_reported_by_its_number(message: str) -> None:
    with pytest.raises(ValueError, match=r".") as caught:
        checked(MeshArrays(*REFUSED[message]))
    assert message in str(caught.value)
    vertices, faces, normals = REFUSED[message]
    with pytest.raises(ValueError, match=r".") as caught:
        glrt.Mesh(vertices, faces, normals, material="white")
    assert message in str(caught.value)


def test_too_many_triangles_are_refused() -> None:
    with pytest.raises(ValueError, match=r"it has 4,000,001 triangles, and a scene may have 4,000"):
        checked(MeshArrays(POINTS, np.tile(np.arange(3), (4_000_001, 1))))


def test_vertices_of_no_triangle_do_not_matter() -> None:
    mesh = checked(MeshArrays(np.concatenate([NO_NUMBER[2:3], POINTS]), FACES + 1, None))
    assert np.array_equal(mesh.vertices, POINTS)
    assert np.array_equal(mesh.faces, FACES)


@pytest.mark.parametrize("faces", [icosphere(2), blob(3), box([0, 0, 0], [1, 2, 3])])
def test_closed_meshes_are_known_and_turned_outwards(faces: Any) -> None:
    mesh = checked(MeshArrays(*faces))
    assert mesh.opening == ""
    assert mesh.outward is mesh
    inside_out = checked(MeshArrays(faces[0], faces[1][:, ::-1]))
    assert inside_out.opening == ""
    assert np.array_equal(inside_out.outward.faces, faces[1])


def test_why_a_mesh_is_open() -> None:
    points, faces = icosphere(1)
    assert checked(MeshArrays(points, faces[1:])).opening == "3 edges belong to one triangle"
    turned = faces.copy()
    turned[5] = turned[5, ::-1]
    assert checked(MeshArrays(points, turned)).opening.startswith(
        "at 3 edges neighbouring triangles face"
    )
    twice = np.concatenate([faces, faces[:1, ::-1]])  # an equal one would be left out
    assert "more than two meet" in checked(MeshArrays(points, twice)).opening


def test_a_mesh_of_loose_triangles_is_closed_where_they_meet() -> None:
    """STL files have such meshes: each triangle has vertices of its own."""
    points, faces = icosphere(2)
    loose = checked(MeshArrays(points[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)))
    assert loose.opening == ""
    assert_allclose(loose.shading_normals, loose.vertices, atol=0.02)


def test_normals_are_means_of_the_triangles_around_a_vertex() -> None:
    mesh = checked(MeshArrays(*icosphere(4)))
    assert_allclose(mesh.shading_normals, mesh.vertices, atol=3e-3)
    corner = checked(MeshArrays(*box([0, 0, 0], [1, 1, 1]))).shading_normals[0]
    assert_allclose(corner, -np.full(3, 3**-0.5), atol=1e-12)  # whatever the diagonals of the sides


def test_normals_that_are_given_are_taken() -> None:
    normals = np.add(POINTS, [1, 2, 3])
    mesh = checked(MeshArrays(POINTS, FACES, normals))
    assert_allclose(mesh.shading_normals, normals / np.linalg.norm(normals, axis=1, keepdims=True))


def scene(mesh: Any, material: str = "glass") -> Any:
    return glrt.Scene.build(
        {"position": [0, 0, 4], "look_at": [0, 0, 0]},
        [mesh],
        materials={
            "glass": glrt.Dielectric(ior=1.5),
            "white": glrt.Lambertian(color=(0.5, 0.5, 0.5)),
        },
        background={"color": (1, 1, 1)},
    )


def test_glass_must_be_closed() -> None:
    points, faces = icosphere(1)
    assert scene(glrt.Mesh(points, faces, material="glass")).objects
    with pytest.raises(SceneError, match=r"objects\[0\]\.file: mesh-\w+\.ply: 3 edges belong to"):
        scene(glrt.Mesh(points, faces[1:], material="glass"))
    assert scene(glrt.Mesh(points, faces[1:], material="white"), "white").objects


def test_a_mesh_is_given_by_arrays_or_by_a_file() -> None:
    with pytest.raises(ValueError, match=r"by arrays or by a file, not by both"):
        glrt.Mesh(POINTS, FACES, file="a.ply", material="white")
    with pytest.raises(ValueError, match=r"file"):
        glrt.Mesh(material="white")


@pytest.mark.parametrize("scale", [2.0, (1.0, 2.0, 0.5), (-1.0, 1.0, 1.0), (-2.0, -1.0, -1.0)])
def test_a_mesh_is_scaled_then_turned_then_moved(scale: Any) -> None:
    mesh = glrt.Mesh(
        POINTS,
        FACES,
        material="white",
        scale=scale,
        rotate=(90.0, 0.0, 90.0),
        translate=(5.0, 6.0, 7.0),
    )
    factors = np.broadcast_to(scale, 3)
    # About x: y to z. About z: x to y.
    x, y, z = (POINTS * factors).T
    turned = np.stack([x, -z, y], axis=1)
    turned = np.stack([-turned[:, 1], turned[:, 0], turned[:, 2]], axis=1)
    assert_allclose(mesh.world_vertices, np.add(turned, [5, 6, 7]), atol=1e-12)
    corners = np.abs(mesh.world_vertices - np.array(mesh.middle))
    assert np.linalg.norm(corners, axis=1).max() <= mesh.reach * (1 + 1e-9)


@pytest.mark.parametrize("scale", [(1.0, 3.0, 0.5), (-1.0, 3.0, 0.5), (-1.0, -1.0, -2.0)])
def test_normals_stay_across_and_outside_of_what_is_stretched_or_mirrored(scale: Any) -> None:
    ball = glrt.Mesh(*icosphere(4), material="white", scale=scale, rotate=(10.0, 20.0, 30.0))
    normals = ball.world_normals / np.linalg.norm(ball.world_normals, axis=1, keepdims=True)
    back = np.linalg.inv(ball.linear)
    local = ball.world_vertices @ back.T
    exact = (local / np.linalg.norm(local, axis=1, keepdims=True)) @ back
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    assert_allclose(normals, exact, atol=2e-2)
    assert ((normals * ball.world_vertices).sum(axis=1) > 0).all()


@pytest.mark.parametrize("scale", [0.0, (1.0, 0.0, 1.0), (1.0, 1.0), float("nan"), "2"])
def test_a_scale_that_leaves_nothing_is_refused(scale: Any) -> None:
    with pytest.raises(ValueError, match=r"scale"):
        glrt.Mesh(POINTS, FACES, material="white", scale=scale)


SHEARED = (
    (1.0, 0.5, 0.0, 3.0),
    (0.0, -2.0, 0.0, 0.0),
    (0.25, 0.0, 1.0, -1.0),
    (0.0, 0.0, 0.0, 1.0),
)


def test_a_matrix_comes_before_the_rest() -> None:
    more: dict[str, Any] = {
        "scale": (1.0, 2.0, 0.5),
        "rotate": (10.0, 20.0, 30.0),
        "translate": (5.0, 6.0, 7.0),
    }
    vertices, faces = icosphere(2)
    ball = glrt.Mesh(vertices, faces, material="white", matrix=SHEARED, **more)
    points = np.c_[vertices, np.ones(len(vertices))] @ np.array(SHEARED).T
    before = glrt.Mesh(points[:, :3], faces, material="white", **more)
    assert_allclose(ball.world_vertices, before.world_vertices, atol=1e-12)
    assert not ball.is_upright
    corners = np.abs(ball.world_vertices - np.array(ball.middle))
    assert np.linalg.norm(corners, axis=1).max() <= ball.reach * (1 + 1e-9)


@pytest.mark.parametrize(
    ("matrix", "message"),
    [
        (np.eye(4) * [1, 0, 1, 1], "must not make the mesh flat"),
        ([[1, 2, 0, 0], [2, 4, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "must not make the mesh flat"),
        (np.eye(4)[::-1], "must end with the row 0, 0, 0, 1"),
        (np.eye(3), "matrix"),
        (np.full((4, 4), np.nan), "matrix"),
    ],
)
def test_a_matrix_that_leaves_nothing_is_refused(matrix: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        glrt.Mesh(POINTS, FACES, material="white", matrix=matrix)


def test_a_ray_is_followed_to_the_nearest_triangle() -> None:
    """The window picks by this."""
    ball = glrt.Mesh(*icosphere(3), material="white", scale=(2.0, 1.0, 1.0), translate=(1, 2, 3))
    along = np.array([0.0, 0.0, -1.0])
    assert ball.distance(np.array([1.001, 2.002, 9.0]), along) == pytest.approx(5, rel=0.01)
    assert ball.distance(np.array([1.001, 2.002, 3.0]), along) == pytest.approx(1, rel=0.01)
    assert ball.distance(np.array([4.0, 2.0, 9.0]), along) == np.inf
    assert ball.distance(np.array([1.0, 2.0, 0.0]), along) == np.inf


def test_two_of_them_are_meshes() -> None:
    assert [counted(count, "mesh") for count in (0, 1, 2)] == ["no meshes", "1 mesh", "2 meshes"]
