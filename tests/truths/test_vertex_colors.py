"""Colours of vertices: the bits of a material of that colour, or float64 between the corners."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, glass, lamp, plane, scene_of, sphere
from tests.support.meshes import blob, icosphere, mesh
from tests.support.renders import METHODS, rendered, same

COLOR = [0.25, 0.5, 0.75]
MATERIALS: dict[str, dict[str, Any]] = {
    "floor": MATTE,
    "white": {"type": "lambertian", "color": [1.0] * 3},
    "dyed": {"type": "lambertian", "color": COLOR},
    "grey": {"type": "metal", "color": [0.5] * 3, "roughness": 0.5},
    "dyed metal": {"type": "metal", "color": [c / 2 for c in COLOR], "roughness": 0.5},
    "lamp": lamp(4.0),
    "glass": glass(),
}
CAMERA = {"position": [0, 1, 4], "look_at": [0, 0, 0], "fov": 40}
MODELS = ("phong", "blinn", "whitted", "cook")


def room(*things: dict[str, Any]) -> Scene:
    others = plane([0, -1, 0], [0, 1, 0], "floor"), sphere([0, 4, 1], 0.5, "lamp")
    return scene_of([*others, *things], MATERIALS, CAMERA, background={"color": [0.2] * 3})


def evenly(steps: int, material: str, color: Any, **more: Any) -> dict[str, Any]:
    points, faces = icosphere(steps)
    colors = np.tile(color, (len(points), 1))
    return mesh((points, faces), material, colors=colors, **more)


@pytest.mark.slow
@pytest.mark.parametrize("method", [*METHODS, *MODELS])
@pytest.mark.parametrize(("plain", "dyed"), [("white", "dyed"), ("grey", "dyed metal")])
def test_even_colours_are_the_material_of_that_colour_to_the_bit(
    context: Context, method: str, plain: str, dyed: str
) -> None:
    first = rendered(room(evenly(2, plain, COLOR)), context, 16, method=method)
    second = rendered(room(mesh(icosphere(2), dyed)), context, 16, method=method)
    assert same(first, second)


@pytest.mark.slow
def test_each_mesh_has_its_own_colours(context: Context) -> None:
    """This holds also next to a mesh that has none, and with one that is hidden."""
    left, right = {"scale": 0.5, "translate": [-1, 0, 0]}, {"scale": 0.5, "translate": [1, 0, 0]}
    hidden = evenly(1, "white", [1, 0, 0], hidden=True)
    coloured = room(hidden, mesh(blob(1), "grey", **left), evenly(2, "white", COLOR, **right))
    plain = room(mesh(blob(1), "grey", **left), mesh(icosphere(2), "dyed", **right))
    assert same(rendered(coloured, context, 16), rendered(plain, context, 16))


def test_between_the_corners_colours_are_linear(call_glsl: CallGlsl) -> None:
    corners = np.array([[-1.0, -1, -3], [2, -1, -4], [0, 2, -5]])
    colors = np.array([[1.0, 0, 0.25], [0, 1, 0.5], [0, 0, 1]])
    random = np.random.default_rng(1)
    shares = random.dirichlet([1, 1, 1], 1000)
    points = shares @ corners
    direction = (points / np.linalg.norm(points, axis=1, keepdims=True)).astype(np.float32)
    scene = scene_of(
        [mesh((corners, np.array([[0, 1, 2]])), "white", colors=colors)],
        MATERIALS,
        {"position": [0, 0, 0], "look_at": [0, 0, -1]},
    )
    found = call_glsl(
        "vertex_color(Ray(vec3(0.0), direction, NO_SHAPE, false), first_triangle())",
        "vec3",
        scene=scene,
        direction=direction,
    )
    assert_allclose(found, shares @ colors, atol=2e-6)


@pytest.mark.slow
def test_albedo_shows_them(context: Context) -> None:
    image = rendered(room(evenly(2, "white", COLOR)), context, 16, aov=("albedo",))
    other = rendered(room(mesh(icosphere(2), "dyed")), context, 16, aov=("albedo",))
    assert np.array_equal(image.aovs["albedo"].value, other.aovs["albedo"].value)


@pytest.mark.slow
def test_glass_has_none(context: Context) -> None:
    scene, plain = room(evenly(2, "glass", COLOR)), room(mesh(icosphere(2), "glass"))
    settings = settings_for(scene.render)
    assert needs_of(SceneFacts(scene), settings) == needs_of(SceneFacts(plain), settings)
    assert same(rendered(scene, context, 16), rendered(plain, context, 16))
