"""Posed meshes take their history along: each point of a triangle keeps its share of the corners.

The sheet of these tests is a grid of triangles in z = 0 with coordinates (s, t). At the moment w of
its animation, the point (s, t) lies at (s + SHEAR w t, t, w h), where h is random at each corner.
So s = x - SHEAR w y and t = y wherever the sheet is seen.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history.deformed import deformed_objects
from glrt.rendering.history.reprojection import Reprojection, between
from glrt.scene.scene import Scene
from tests.support.gltf_files import Builder
from tests.support.moving import FOV, UNLIMITED, samples_shown, view

Array = NDArray[Any]

SIDE = 8  # quads along an edge
SHEAR, BUMP = 0.3, 0.12
SIZE = (64, 48)
SCENE = """
camera = {{ position = [{x}, 0.0, 1.0], look_at = [{x}, 0.0, 0.0], fov = {fov} }}
background = {{ color = [1.0, 1.0, 1.0] }}
materials.matte = {{ type = "lambertian", color = [0.5, 0.5, 0.5] }}
[[objects]]
shape = "plane"
point = [0.0, 0.0, -0.5]
normal = [0.0, 0.0, 1.0]
material = "matte"
[[objects]]
shape = "mesh"
file = "sheet.glb"
material = "matte"
translate = [0.02, 0.0, 0.0]
smooth = false
{time}
"""


def sheet() -> bytes:
    """The glTF file: one morph target, whose weight is the time in seconds."""
    steps = np.linspace(-0.4, 0.4, SIDE + 1)
    s, t = (grid.ravel() for grid in np.meshgrid(steps, steps))
    bumps = np.random.default_rng(1).uniform(-BUMP, BUMP, len(s))
    first = (np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)).ravel()
    right, below, across = first + 1, first + SIDE + 1, first + SIDE + 2
    faces = np.concatenate([[first, right, across], [first, across, below]], axis=1).T
    builder = Builder()
    primitive = {
        "attributes": {"POSITION": builder.accessor(np.stack([s, t, 0 * s], axis=1))},
        "indices": builder.accessor(faces.ravel(), "u2"),
        "targets": [{"POSITION": builder.accessor(np.stack([SHEAR * t, 0 * s, bumps], axis=1))}],
    }
    node = builder.shown(primitive)
    tables = {"input": builder.accessor([0.0, 1.0]), "output": builder.accessor([0.0, 1.0])}
    channel = {"sampler": 0, "target": {"node": node, "path": "weights"}}
    builder.add("animations", {"samplers": [tables], "channels": [channel]})
    return builder.glb()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the file of the sheet."""
    found = tmp_path_factory.mktemp("sheet")
    (found / "sheet.glb").write_bytes(sheet())
    return found


def at(folder: Path, w: float | None, x: float = 0.0) -> Scene:
    """The scene at a moment, seen from a place x."""
    time = "" if w is None else f"time = {w}"
    (folder / "scene.toml").write_text(SCENE.format(x=x, fov=FOV, time=time))
    return load(folder / "scene.toml")


def own(scene: Scene, position: Array, w: float) -> Array:
    """Coordinates (s, t) of the sheet, (H, W, 2), of surfaces relative to the eye."""
    places = position[..., :3].astype(np.float64) + np.array(scene.camera.position)
    x, y = places[..., 0] - 0.02, places[..., 1]
    return np.stack([x - SHEAR * w * y, y], axis=-1)


def places_before(now: Scene, before: Scene, context: Context) -> tuple[Array, ...]:
    """Surfaces of the pixels of `now`, the same before, and their normals; (H, W, 4) each."""
    with view(before, context, SIZE) as old, view(now, context, SIZE) as here, context.gl:
        textures, _ = between(here, old)
        names = "position", "deformed", "deformed_normal"
        return tuple(read_texture(textures[name]).copy() for name in names)


@pytest.mark.parametrize("eye", [0.0, 0.05], ids=["a still camera", "a camera that moves"])
def test_each_pixel_finds_the_place_of_its_triangle_before(
    folder: Path, context: Context, eye: float
) -> None:
    before, now = at(folder, 0.25), at(folder, 1.0, eye)
    surfaces, places, normals = places_before(now, before, context)
    is_sheet = surfaces[..., 3] == surfaces[..., 3][SIZE[1] // 2, SIZE[0] // 2]
    assert np.array_equal(places[..., 3] > 0, is_sheet)
    assert 1000 < is_sheet.sum() < 2500
    wanted, found = own(now, surfaces, 1.0)[is_sheet], own(before, places, 0.25)[is_sheet]
    assert np.abs(wanted - found).max() < 2e-5  # a pixel is 0.02 wide there
    heights = [
        it[..., 2][is_sheet].astype(np.float64) + scene.camera.position[2]
        for it, scene in ((surfaces, now), (places, before))
    ]
    assert np.abs(heights[1] - 0.25 * heights[0]).max() < 2e-5
    assert np.abs(heights[0]).max() > BUMP / 2
    lengths = np.linalg.norm(normals[..., :3][is_sheet], axis=-1)
    assert np.abs(lengths - 1).max() < 1e-5


def test_normals_turn_with_their_triangles(folder: Path, context: Context) -> None:
    """Before, at the moment 0, the sheet was flat and faced the camera."""
    surfaces, places, normals = places_before(at(folder, 0.5), at(folder, 0.0), context)
    is_sheet = places[..., 3] > 0
    assert is_sheet.sum() > 1000
    assert surfaces.shape == normals.shape
    off = np.abs(normals[is_sheet][:, :3] - [0, 0, 1]).max(axis=-1)
    assert np.quantile(off, 0.97) < 1e-4  # at edges, the triangle next to it may have been drawn


def test_history_lies_on_a_sheet_that_bends(folder: Path, context: Context) -> None:
    """The history is linear in the coordinates of the sheet, so that all of it is known."""
    before, now = at(folder, 0.1), at(folder, 0.3)
    with view(before, context, SIZE) as old, view(now, context, SIZE) as here, context.gl:
        reprojection = Reprojection(context.gl, UNLIMITED)
        surfaces, others = read_texture(here.position).copy(), read_texture(old.position).copy()
        known = np.ones((SIZE[1], SIZE[0], 4), np.float32)
        known[..., :2] = own(before, others, 0.1)
        texture = context.gl.texture(SIZE, 4, known.tobytes(), dtype="f4")
        found = read_texture(reprojection.bring(here, old, texture)).copy()
        texture.release()
        reprojection.release()
    coordinates = own(now, surfaces, 0.3)
    is_inner = (np.abs(coordinates) < 0.36).all(axis=-1) & (found[..., 3] > 0)
    assert is_inner.sum() > 1000
    off = np.abs(found[..., :2] - coordinates)[is_inner]
    moved = 0.2 * SHEAR * 0.36
    assert np.quantile(off, 0.97) < moved / 100  # more where a triangle hid a part of another


def test_only_triangles_in_another_pose_are_drawn(folder: Path) -> None:
    still, bent = at(folder, 0.0), at(folder, 0.5)
    assert deformed_objects(still, still) == []
    assert deformed_objects(at(folder, 0.0), still) == []
    assert deformed_objects(at(folder, None), still) == [], "the pose of the file is that at 0"
    ((number, now, before),) = deformed_objects(bent, still)
    assert now.shape == before.shape == (2 * SIDE**2, 3, 3)
    assert np.abs(before[..., 2]).max() == 0
    assert number >= 0


@pytest.mark.parametrize("mode", ["reproject", "taa", "ataa", "wrls"])
def test_a_sheet_that_bends_keeps_its_samples(folder: Path, context: Context, mode: Any) -> None:
    """Four frames of one sample: the picture stands for more than the last one."""
    scenes = [at(folder, w) for w in (0.1, 0.4, 0.7, 1.0)]
    counts = samples_shown(scenes, mode, SIZE, context)
    middle = counts[16:32, 22:42]
    assert (middle > 1.5).mean() > 0.98
