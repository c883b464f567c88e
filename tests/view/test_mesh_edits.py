"""Meshes in the window: picked where they are seen, moved and scaled by the handles."""

from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.gpu.program import Resource
from glrt.gpu.struct_arrays import Arrays
from glrt.rendering.pipelines import Tier, upload
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import rotation
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Cost
from glrt.view.edits.scene_edits import with_object
from glrt.view.viewport.pick import pick
from glrt.view.viewport.transform import moved_to, object_matrix, scaled, shifted, turned
from tests.support.builders import lamp, plane, scene_of, sphere
from tests.support.meshes import blob, icosphere, mesh

LAMPS = {"a": lamp(1.0), "b": lamp(10.0), "c": lamp(100.0), "d": lamp(1000.0)}
SIZE = 32


def things() -> Scene:
    """Two meshes, one before the other, a ball and a floor, each of another brightness."""
    turned: dict[str, Any] = {
        "rotate": [20, 30, 40],
        "scale": [1, 0.5, -0.75],
        "translate": [0.3, 0.2, -3],
    }
    return scene_of(
        [
            mesh(blob(2), "a", **turned, smooth=False),
            mesh(icosphere(1), "b", scale=0.4, translate=[-0.6, 0.1, -2], smooth=False),
            sphere([1.2, -0.2, -3.5], 0.5, "c"),
            plane([0, -1, 0], [0, 1, 0], "d"),
        ],
        LAMPS,
    )


@pytest.mark.slow
def test_every_pixel_shows_what_is_picked_there(context: Context) -> None:
    """Pixels at the rim of something are excepted: a sample there may see another part."""
    scene = things()
    renderer = Renderer(
        scene, context=context, width=SIZE, height=SIZE, bounces=0, sampler="independent"
    )
    image = renderer.render(16).image()
    renderer.release()
    brightness = image.radiance[..., 0]
    is_pure = image.stderr[..., 0] == 0
    assert is_pure.mean() > 0.5
    seen = set()
    for row, column in zip(*np.nonzero(is_pure), strict=True):
        picked = pick(scene, 1.0, (column + 0.5) / SIZE, (row + 0.5) / SIZE)
        found = scene.emission_of(scene.objects[picked.number])[0] if picked else 0.0
        assert brightness[row, column] == found
        seen.add(picked.number if picked else None)
    assert seen == {None, 0, 1, 2, 3}


def test_a_mesh_is_moved_and_grows_about_its_middle() -> None:
    thing = things().objects[0]
    assert isinstance(thing, Mesh)
    moved = shifted(thing, np.array([1.0, 2.0, 3.0]))
    assert np.allclose(np.subtract(moved.middle, thing.middle), [1, 2, 3], atol=1e-6)
    larger = scaled(thing, 2.0)
    assert isinstance(larger, Mesh)
    assert np.allclose(larger.middle, thing.middle, atol=1e-6)
    assert larger.reach == pytest.approx(2 * thing.reach)
    assert larger.file == thing.file
    matrix = np.array(object_matrix(thing), np.float32).reshape(4, 4)
    matrix[3, :3] += (0.5, 0, 0)
    assert np.allclose(np.subtract(moved_to(thing, matrix).middle, thing.middle), [0.5, 0, 0])


def test_a_mesh_turns_about_its_middle() -> None:
    """Its vertices are where the turn brings them, also from a place with turns of its own."""
    thing, turn = things().objects[0], rotation((10.0, 70.0, -40.0))
    assert isinstance(thing, Mesh)
    first = turned(thing, turn)
    for before in (thing, first):
        after = turned(before, turn)
        assert isinstance(before, Mesh)
        assert isinstance(after, Mesh)
        middle = np.array(before.middle)
        expected = (before.world_vertices - middle) @ turn.T + middle
        assert np.allclose(after.world_vertices, expected, atol=1e-5)


@pytest.mark.slow
def test_a_mesh_that_is_moved_shows_as_one_that_stood_there(context: Context) -> None:
    scene = things()
    moved = with_object(scene, 1, shifted(scene.objects[1], np.array([0.5, 0.25, 0.0])))
    small: dict[str, Any] = {"width": 16, "height": 16}
    fresh = Renderer(moved, context=context, **small)
    expected = fresh.render(4).image().radiance
    fresh.release()
    renderer = Renderer(scene, context=context, tier="generic", **small)
    renderer.render(4)
    assert renderer.update(moved) == Cost.RESTART
    assert np.array_equal(renderer.render(4).image().radiance, expected)
    renderer.release()


@pytest.mark.slow
def test_a_camera_that_moves_packs_no_triangles(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = things()
    away = scene.camera.model_copy(update={"position": (0.5, 0.25, 1.0)})
    moved = scene.model_copy(update={"camera": away})
    small: dict[str, Any] = {"width": 16, "height": 16}
    fresh = Renderer(moved, context=context, **small)
    expected = fresh.render(4).image().radiance
    fresh.release()
    renderer = Renderer(scene, context=context, tier="generic", **small)
    renderer.render(4)
    monkeypatch.setattr("glrt.packing.scene_tree.triangles_of", None)
    monkeypatch.setattr("glrt.packing.scene_tree.build", None)
    uploads: list[str] = []

    def watched(gl: moderngl.Context, arrays: Arrays, tier: Tier) -> dict[str, Resource]:
        uploads.extend(name for name, rows in arrays.items() if len(rows))
        return upload(gl, arrays, tier)

    monkeypatch.setattr("glrt.rendering.device_scene.upload", watched)
    assert renderer.update(moved) == Cost.RESTART
    assert np.array_equal(renderer.render(4).image().radiance, expected)
    assert uploads
    assert not {"Slot", "Corner", "Triangle"} & {*uploads}
    renderer.release()
