"""Normals as formats mean them: facets, smoothing groups, and edges sharp by their angle."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import glrt
from glrt.scene.files.named_meshes import mesh_of_arrays
from glrt.scene.meshes import creases
from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.mesh_formats import decode_mesh
from tests.support.meshes import box, icosphere

POINTS, FACES = box([-1, -1, -1], [1, 1, 1])


def facets(mesh: TriangleMesh) -> Any:
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    return across / np.linalg.norm(across, axis=1, keepdims=True)


def at_corners(mesh: TriangleMesh) -> Any:
    return mesh.shading_normals[mesh.faces]


def obj(groups: list[str], normals: str = "") -> TriangleMesh:
    lines = [f"v {x} {y} {z}" for x, y, z in POINTS]
    corner = "{0}//1" if normals else "{0}"
    for row, face in enumerate(FACES + 1):
        lines += [groups[row]] if groups[row] else []
        lines += ["f " + " ".join(corner.format(k) for k in face)]
    return decode_mesh("\n".join([*lines, normals]).encode(), "a.obj", "x")


@pytest.mark.parametrize("word", ["", "s off", "s 0"])
def test_an_obj_file_without_smoothing_groups_is_flat(word: str) -> None:
    mesh = obj([word] * 12).creased(40)
    assert_allclose(
        at_corners(mesh), np.broadcast_to(facets(mesh)[:, None], (12, 3, 3)), atol=1e-15
    )
    assert len(mesh.vertices) == 24
    assert mesh.opening == ""


def test_smoothing_groups_share_normals_within_themselves() -> None:
    """Two faces of the box are one group: their corners have means, the others are flat."""
    sides = facets(obj([""] * 12))
    chosen = [k for k in range(12) if sides[k] @ [1, 0, 0] > 0.5 or sides[k] @ [0, 1, 0] > 0.5]
    mesh = obj(["s 7" if k in chosen else "s off" for k in range(12)]).creased(40)
    found = at_corners(mesh)
    for row in range(12):
        for corner in range(3):
            place = mesh.vertices[mesh.faces[row, corner]]
            is_shared = row in chosen and place[0] == 1 and place[1] == 1
            expected = np.array([1, 1, 0]) / np.sqrt(2) if is_shared else facets(mesh)[row]
            assert_allclose(found[row, corner], expected, atol=1e-15)


def test_given_normals_are_kept() -> None:
    mesh = obj([""] * 12, "vn 0 0 1")
    assert mesh.creased(40) is mesh


def test_an_stl_file_is_flat_and_not_in_a_scene_of_before() -> None:
    rows = np.zeros(12, [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("more", "<u2")])
    rows["c"] = POINTS[FACES]
    mesh = decode_mesh(b" " * 80 + np.uint32(12).tobytes() + rows.tobytes(), "a.stl", "x")
    flat = mesh.creased(40)
    assert_allclose(
        at_corners(flat), np.broadcast_to(facets(flat)[:, None], (12, 3, 3)), atol=1e-15
    )
    assert np.abs(mesh.shading_normals) == pytest.approx(np.sqrt(1 / 3))


def prism(sides: int) -> TriangleMesh:
    """A closed prism of equal sides, without normals."""
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(sides)], axis=1)
    points = np.concatenate([ring, ring + np.array([0, 0, 1]), [[0, 0, 0], [0, 0, 1]]])
    k = np.arange(sides)
    after = (k + 1) % sides
    faces = [
        np.stack([k, after, after + sides], 1),
        np.stack([k, after + sides, k + sides], 1),
        np.stack([after, k, np.full(sides, 2 * sides)], 1),
        np.stack([k + sides, after + sides, np.full(sides, 2 * sides + 1)], 1),
    ]
    return checked(MeshArrays(points, np.concatenate(faces)))


@pytest.mark.parametrize(("sides", "is_round"), [(12, True), (8, False)])
def test_an_edge_is_sharp_by_its_angle(sides: int, is_round: bool) -> None:
    """30 degrees between the sides of a prism of 12, 45 between those of 8; 90 to its ends."""
    mesh = prism(sides).creased(40)
    found = at_corners(mesh)
    on_sides, ends = found[: 2 * sides], found[2 * sides :]
    assert_allclose(np.abs(ends), np.broadcast_to([0, 0, 1], ends.shape), atol=1e-12)
    if is_round:
        places = mesh.vertices[mesh.faces[: 2 * sides]]
        assert_allclose(on_sides[..., :2], places[..., :2], atol=1e-12)
    else:
        flat = np.broadcast_to(facets(mesh)[: 2 * sides, None], on_sides.shape)
        assert_allclose(on_sides, flat, atol=1e-12)


def test_all_is_smooth_below_180_degrees_and_flat_from_0() -> None:
    mesh = checked(MeshArrays(*icosphere(2)))
    assert_allclose(at_corners(mesh.creased(180)), at_corners(mesh), atol=1e-12)
    flat = mesh.creased(0)
    assert_allclose(
        at_corners(flat), np.broadcast_to(facets(flat)[:, None], (320, 3, 3)), atol=1e-12
    )


def test_a_crowded_vertex_is_smooth(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(creases, "MOST_AT_A_VERTEX", 5)
    mesh = prism(8).creased(10)
    tips = at_corners(mesh)[16:, 2]
    assert_allclose(np.abs(tips), np.broadcast_to([0, 0, 1], tips.shape), atol=1e-12)
    monkeypatch.setattr(creases, "_PAIRS", 7)
    assert_allclose(at_corners(prism(8).creased(10)), at_corners(mesh), atol=0)


def test_colours_and_coordinates_go_with_their_vertices() -> None:
    colors = np.random.default_rng(1).uniform(0, 1, (8, 3))
    uv = np.random.default_rng(2).uniform(0, 1, (8, 4))
    mesh = checked(MeshArrays(POINTS, FACES, colors=colors, uv=uv))
    cut = mesh.creased(40)
    assert cut.colors is not None
    assert cut.uv is not None
    assert mesh.uv is not None
    assert_allclose(cut.colors[cut.faces], colors[mesh.faces])
    assert_allclose(cut.uv[cut.faces], mesh.uv[mesh.faces])


def scene(smooth: Any, crease: float = 40.0) -> glrt.Scene:
    ball = icosphere(2)
    mesh = glrt.Mesh(file=mesh_of_arrays(*ball), material="red", smooth=smooth, crease=crease)
    return glrt.Scene.build(
        {"position": (0, 0, 4), "look_at": (0, 0, 0)},
        [mesh],
        materials={"red": {"type": "lambertian", "color": (0.8, 0.2, 0.2)}},
        background={"bottom": (0.1, 0.1, 0.1), "top": (1, 1, 1)},
    )


def test_pictures_are_those_of_smooth_or_flat_meshes() -> None:
    """All corners of a ball have one mean at 180 degrees, and facets at 0."""
    options: Any = {"width": 24, "height": 24, "samples": 16}
    for crease, smooth in ((180.0, True), (0.0, False)):
        found = glrt.render(scene("auto", crease), **options).radiance
        expected = glrt.render(scene(smooth), **options).radiance
        assert_allclose(found, expected, rtol=2e-5, atol=1e-6)
    assert not np.allclose(found, glrt.render(scene("auto", 180.0), **options).radiance, rtol=1e-3)


@pytest.mark.parametrize(("word", "got"), [('"soft"', "unknown smooth 'soft'"), ("3", "got 3")])
def test_a_wrong_word_is_refused(tmp_path: Path, word: str, got: str) -> None:
    path = tmp_path / "a.toml"
    scene("auto").save(path)
    path.write_text(path.read_text().replace('smooth = "auto"', f"smooth = {word}"))
    with pytest.raises(glrt.SceneError) as refused:
        glrt.load(path)
    assert got in str(refused.value)
    assert "one of: true, false, auto" in str(refused.value)
