"""The balls that show the materials of a MaterialX document."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from glrt.scene.model_files.materialx.balls import ball
from tests.support.materialx_files import material, scene_of

pytest.importorskip("MaterialX", reason="materialx is not installed")


def test_a_ball_is_closed_faces_outwards_and_shows_its_image_upright() -> None:
    """Every edge has two triangles; the middle of the image faces the camera."""
    points, uv, triangles = ball()
    _, same = np.unique(points, axis=0, return_inverse=True)
    edges = Counter(
        (a, b) for t in same.reshape(-1)[triangles] for a, b in zip(t, np.roll(t, -1), strict=True)
    )
    assert all(count == 1 and edges[b, a] == 1 for (a, b), count in edges.items())
    first, second, third = points[triangles].swapaxes(0, 1)
    outwards = np.cross(second - first, third - first)
    assert (np.einsum("ij,ij->i", outwards, first + second + third) > 0).all()
    front = np.flatnonzero(np.abs(uv - 0.5).max(axis=1) < 1e-9)
    assert points[front] == pytest.approx(np.array([[0, 0, 1]]), abs=1e-12)
    right, up = points[np.argmin(np.abs(uv - (0.6, 0.5)).sum(axis=1))], points[0]
    assert right[0] > 0
    assert up[1] == 1


def test_materials_stand_side_by_side_and_in_the_picture(tmp_path: Path) -> None:
    """Five balls in two rows, apart from one another."""
    scene = scene_of(tmp_path, *(material(f"m{k}", "gltf_pbr") for k in range(5)))
    middles = np.array([it.triangles.vertices.mean(axis=0) for it in scene.meshes])
    gaps = np.linalg.norm(middles[:, None] - middles[None], axis=2) + 9 * np.eye(5)
    assert gaps.min() > 2
    camera = scene.camera
    forward = np.array(camera.look_at) - camera.position
    forward /= np.linalg.norm(forward)
    points = np.concatenate([it.triangles.vertices for it in scene.meshes]) - camera.position
    height = np.array(camera.up) - forward * np.dot(camera.up, forward)
    tangents = points @ (height / np.linalg.norm(height)) / (points @ forward)
    limit = np.tan(np.radians(camera.fov / 2))
    assert 0.7 * limit < np.abs(tangents).max() < limit
