"""Tangents of vertices as means over triangles, against those of a surface."""

import numpy as np
from numpy.testing import assert_allclose

from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from glrt.scene.meshes.vertex_means import mean_tangents
from tests.support.meshes import Array, Faces

STEPS = 32


def tube(steps: int, turns: float = 1.0) -> tuple[Faces, Array, Array]:
    """A wall around y, its normals and its coordinates, whose seam has vertices twice."""
    angle = np.linspace(0, 2 * np.pi, steps + 1)
    ring = np.stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)], axis=1)
    points = np.concatenate([ring, ring + np.array([0, 0.5, 0])])
    uv = np.stack([np.tile(turns * angle, 2), np.repeat([1.0, 0.0], steps + 1)], axis=1)
    low = np.arange(steps)
    high = low + steps + 1
    quads = np.stack([low, high, high + 1, low, high + 1, low + 1], axis=1)
    return (points, quads.reshape(-1, 3)), np.tile(ring, (2, 1)), uv


def test_tangents_of_a_tube_lead_around_it() -> None:
    (points, faces), normals, uv = tube(STEPS)
    found = mean_tangents(points, faces, normals, uv)
    around = np.stack([-normals[:, 2], np.zeros(len(points)), normals[:, 0]], axis=1)
    assert_allclose(found, around, atol=1.1 * np.pi / STEPS)  # at the seam, half a step
    inner = slice(1, STEPS)
    assert_allclose(found[inner], around[inner], atol=1e-12)
    backwards = mean_tangents(points, faces, normals, uv * [-1, 1])
    assert_allclose(backwards, -found, atol=1e-12)


def test_equal_corners_share_theirs_and_no_others() -> None:
    """Without shared vertices, as in files that list corners, means are the same to rounding."""
    (points, faces), normals, uv = tube(STEPS)
    expected = mean_tangents(points, faces, normals, uv)[faces].reshape(-1, 3)
    rows = (each[faces].reshape(-1, each.shape[1]) for each in (points, normals, uv))
    apart, turned, own = rows
    found = mean_tangents(apart, np.arange(len(apart)).reshape(-1, 3), turned, own)
    assert_allclose(found, expected, atol=1e-12)


def test_mirrored_coordinates_share_nothing() -> None:
    """Along a line where u turns around there is no mean: each triangle has its own there."""
    points = np.array([[-1.0, 0, 0], [0, 0, 0], [1, 0, 0], [0, 1, 0]])
    faces = np.array([[0, 1, 3], [1, 2, 3]])
    across = np.abs(points[:, 0])
    uv = np.stack([across, 0.75 * across - points[:, 1]], axis=1)
    found = mean_tangents(points, faces, np.tile([0.0, 0, 1], (4, 1)), uv)
    expected = np.array([[-0.8, 0.6, 0], [0, 0, 0], [0.8, 0.6, 0], [0, 0, 0]])
    assert_allclose(found, expected, atol=1e-12)


def test_coordinates_that_do_not_grow_give_none() -> None:
    (points, faces), normals, uv = tube(8)
    assert not mean_tangents(points, faces, normals, 0 * uv).any()


def test_what_a_file_gives_is_kept_and_the_rest_are_means() -> None:
    (points, faces), normals, uv = tube(8)
    given = np.zeros_like(points)
    given[3] = [0, 1, 0]
    mesh = checked(MeshArrays(points, faces, normals, uv=np.tile(uv, 2), tangents=given))
    expected = mean_tangents(points, faces, mesh.shading_normals, uv)
    expected[3] = given[3]
    assert np.array_equal(mesh.shading_tangents, expected)
    bare = checked(MeshArrays(points, faces, normals))
    assert not bare.shading_tangents.any()
