"""Large meshes that are moved: their trees stay, and pictures can be made again."""

from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.cli.request import open_renderer
from glrt.gpu.context import Context
from glrt.gpu.program import Resource
from glrt.gpu.struct_arrays import Arrays
from glrt.packing import instances
from glrt.rendering.pipelines import Tier, upload
from glrt.rendering.renderer import Renderer
from glrt.scene import instancing
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Cost
from glrt.view.edits.scene_edits import with_object
from glrt.view.viewport.transform import shifted
from tests.support.builders import MATTE, lamp, plane, scene_of
from tests.support.meshes import blob, icosphere, mesh

SMALL: dict[str, Any] = {"width": 16, "height": 16}
AHEAD = {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 40}


@pytest.fixture(autouse=True)
def _large(monkeypatch: pytest.MonkeyPatch) -> None:
    """Meshes are large from 1,000 triangles on."""
    monkeypatch.setattr(instancing, "LEAST_LARGE", 1000)


def things() -> Scene:
    """Two large meshes, a small one that emits, and a floor."""
    return scene_of(
        [
            mesh(blob(3), "white", translate=[-0.8, 0, 0], scale=0.6),
            mesh(icosphere(3), "white", translate=[0.8, 0, 0], scale=[0.5, 0.7, 0.4]),
            mesh(icosphere(1), "lamp", translate=[0, 1.2, 0], scale=0.3),
            plane([0, -1, 0], [0, 1, 0], "white"),
        ],
        {"white": MATTE, "lamp": lamp(8.0)},
        AHEAD,
        background={"color": [0.2, 0.3, 0.4]},
    )


def moved(scene: Scene, number: int, *by: float) -> Scene:
    return with_object(scene, number, shifted(scene.objects[number], np.array(by)))


def fresh(scene: Scene, context: Context, **more: Any) -> Any:
    renderer = Renderer(scene, context=context, **SMALL, **more)
    image = renderer.render(4).image()
    renderer.release()
    return image


@pytest.mark.slow
def test_a_large_mesh_that_is_moved_again_builds_and_uploads_no_tree(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = things()
    renderer = Renderer(scene, context=context, apart="moved", **SMALL)
    plain = renderer.render(4).image()
    assert plain.recipe is not None
    assert plain.recipe.apart == "repeated"
    assert np.array_equal(plain.radiance, fresh(scene, context).radiance)
    scene = moved(scene, 0, 0.25, 0.125, 0)
    assert renderer.update(scene) == Cost.RECOMPILE, "once"
    expected = [
        fresh(step, context, apart="large").radiance
        for step in (scene, moved(scene, 0, 0, 0.5, 0), moved(scene, 1, 0, 0.25, 0.5))
    ]
    assert np.array_equal(renderer.render(4).image().radiance, expected[0])
    monkeypatch.setattr(instances, "build", None)
    uploads: list[str] = []

    def watched(gl: moderngl.Context, arrays: Arrays, tier: Tier) -> dict[str, Resource]:
        uploads.extend(name for name, rows in arrays.items() if len(rows))
        return upload(gl, arrays, tier)

    monkeypatch.setattr("glrt.rendering.device_scene.upload", watched)
    assert renderer.update(moved(scene, 0, 0, 0.5, 0)) == Cost.RESTART
    assert np.array_equal(renderer.render(4).image().radiance, expected[1])
    assert renderer.update(moved(scene, 1, 0, 0.25, 0.5)) == Cost.RESTART
    assert np.array_equal(renderer.render(4).image().radiance, expected[2])
    assert "Instance" in uploads
    assert "Slot" not in uploads
    assert renderer.update(scene) == Cost.RESTART
    assert np.array_equal(renderer.render(4).image().radiance, expected[0])
    renderer.release()


def test_a_small_mesh_or_another_edit_leaves_trees_joined(context: Context) -> None:
    scene = things()
    renderer = Renderer(scene, context=context, apart="moved", **SMALL)
    assert renderer.update(moved(scene, 2, 0.1, 0, 0)) == Cost.RESTART
    bright = scene.model_copy(update={"materials": {**scene.materials, "lamp": lamp_of(scene)}})
    renderer.update(bright)
    assert renderer.plan.apart == "moved"
    renderer.release()


def lamp_of(scene: Scene) -> Any:
    return scene.materials["lamp"].model_copy(update={"emission": (1.0, 2.0, 3.0)})


def test_a_picture_with_moved_meshes_is_made_again_from_its_recipe(context: Context) -> None:
    scene = things()
    renderer = Renderer(scene, context=context, apart="moved", **SMALL)
    after = moved(scene, 0, 0.25, 0.125, 0)
    renderer.update(after)
    image = renderer.render(4).image()
    renderer.release()
    recipe = image.recipe
    assert recipe is not None
    assert recipe.apart == "large"
    again = open_renderer(after, recipe.taken, recipe, context)
    assert np.array_equal(again.render().image().radiance, image.radiance)
    again.release()


def test_a_mesh_in_the_same_place_is_not_moved() -> None:
    before = things().meshes
    same = [mesh.model_copy(update={"material": "lamp"}) for mesh in before]
    assert instancing.after_moves("moved", before, same) == "moved"
    turned = before[0].model_copy(update={"rotate": (0.0, 1.0, 0.0)})
    assert isinstance(turned, Mesh)
    assert instancing.after_moves("moved", before, (turned, *before[1:])) == "large"
    assert instancing.after_moves("repeated", before, (turned, *before[1:])) == "repeated"
