"""The first surface behind the middle of each pixel: what float64 says, its flags, its edges."""

import numpy as np
import pytest

from glrt.gpu.context import Context, Pipeline
from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.rendering.history.gbuffer import SurfacePass, Surfaces
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, box, glass, lamp, plane, scene_of, sphere
from tests.support.first_hits import axes_of, hits_of_centers
from tests.support.media import filled
from tests.support.mixed_scene import everything
from tests.support.moving import textures_of
from tests.truths.test_grids import smoke, with_smoke

SIZE = (24, 16)
FLAGS = read_constants(read("passes/surface_flags.glsl"))
EYE = {"position": [0.0, 0.0, 3.0], "look_at": [0.0, 0.0, 0.0]}


def surfaces_of(
    scene: Scene, context: Context, pipeline: Pipeline = "auto"
) -> tuple[np.ndarray, np.ndarray]:
    """Positions with objects, and normals with flags."""
    renderer = Renderer(scene, None, context, pipeline=pipeline, width=SIZE[0], height=SIZE[1])
    found, fill = Surfaces(context.gl), SurfacePass(context.gl)
    fill.fill(renderer, found)
    position, normal = textures_of(context, found.position, found.normal)
    for part in (found, fill, renderer):
        part.release()
    return position, normal


@pytest.mark.parametrize("pipeline", ["compute", "fragment"])
def test_they_are_those_behind_the_middles_of_pixels(context: Context, pipeline: Pipeline) -> None:
    scene = everything()
    truth = hits_of_centers(scene, SIZE)
    position, normal = surfaces_of(scene, context, pipeline)
    is_met = truth.object > 0
    assert np.array_equal(position[..., 3] > 0, is_met)
    there = position[..., :3] + np.array(scene.camera.position)
    np.testing.assert_allclose(there[is_met], truth.position[is_met], atol=2e-5)
    np.testing.assert_allclose(normal[..., :3][is_met], truth.normal[is_met], atol=2e-5)
    forward = axes_of(scene.camera)[2]
    assert (position[..., :3] @ forward > 0).all()
    lengths = np.linalg.norm(position[..., :3][~is_met], axis=-1)
    np.testing.assert_allclose(lengths, 1.0, atol=1e-6)  # directions


def test_both_pipelines_find_the_same_bits(context: Context) -> None:
    one, other = (surfaces_of(everything(), context, p) for p in ("compute", "fragment"))
    assert np.array_equal(one, other)


@pytest.mark.parametrize(
    ("material", "flags"),
    [
        (MATTE, 0),
        (glass(1.5), FLAGS["SPECULAR"]),
        ({"type": "metal", "color": [0.9] * 3}, FLAGS["SPECULAR"]),
        ({"type": "metal", "color": [0.9] * 3, "roughness": 0.8}, 0),
        (lamp(2.0), FLAGS["LAMP"]),
    ],
)
def test_a_surface_has_the_flags_of_its_material(
    context: Context, material: dict[str, object], flags: int
) -> None:
    scene = scene_of([sphere([0, 0, 0], 50.0, "one")], {"one": material}, {**EYE, "fov": 20.0})
    _, normal = surfaces_of(scene, context)
    assert (normal[..., 3] == flags).all()


@pytest.mark.parametrize(
    ("density", "is_thick"), [(1.0, True), (0.02, False)], ids=["thick", "thin"]
)
def test_smoke_is_where_a_tenth_of_the_light_is_taken(
    context: Context, density: float, is_thick: bool
) -> None:
    """Smoke of even density in a large box, with a wall behind it. Thin smoke shows the wall."""
    grid = np.full((9, 4, 4), density, np.float32)
    around = filled(box([-9, -9, -1], [9, 9, 1], ""))
    wall = plane([0, 0, -2], [0, 0, 1], "white")
    rates = np.array([0.25, 0.5, 1.5])  # 0.75 in the mean
    scene = with_smoke(smoke(grid, absorption=rates), [wall, around], {**EYE, "fov": 20.0})
    position, normal = surfaces_of(scene, context)
    along = position[..., :3] / np.linalg.norm(position[..., :3], axis=-1, keepdims=True)
    depth = 2 - along[..., 2] * -np.log(0.9) / 0.75 if is_thick else np.full(SIZE[::-1], 5.0)
    np.testing.assert_allclose(-position[..., 2], depth, rtol=1e-3)
    assert (position[..., 3] == (2 if is_thick else 1)).all()
    if is_thick:
        np.testing.assert_allclose(normal[..., :3], -along, atol=1e-6)
    assert (normal[..., 3] == (FLAGS["CLOUD"] if is_thick else 0)).all()


def test_smoke_has_no_edges(context: Context) -> None:
    """Not where its depth jumps, nor before a wall; surfaces around it have theirs."""
    grid = np.zeros((9, 4, 4), np.float32)
    grid[5:, :, :2], grid[:3, :, 2:] = 9.0, 9.0
    around = filled(box([-0.5, -0.5, -1], [0.5, 0.5, 1], ""))
    scene = with_smoke(
        smoke(grid, absorption=1), [plane([0, 0, -2], [0, 0, 1], "white"), around], EYE
    )
    position, normal = surfaces_of(scene, context)
    is_cloud, found = position[..., 3] == 2, normal[..., 3].astype(int)
    assert np.ptp(position[..., 2][is_cloud]) > 0.5
    assert (found[is_cloud] == FLAGS["CLOUD"]).all()
    assert set(found[~is_cloud]) == {0, FLAGS["EDGE"]}


def test_pixels_next_to_another_object_are_at_an_edge(context: Context) -> None:
    """A pixel next to the outline of a ball is at an edge; a flag marks the edge of a lamp."""
    for material, flag in ((MATTE, 0), (lamp(2.0), FLAGS["LAMP_EDGE"])):
        objects = [plane([0, 0, -1], [0, 0, 1], "matte"), sphere([0, 0, 0], 0.7, "ball")]
        scene = scene_of(objects, {"matte": MATTE, "ball": material}, EYE)
        position, normal = surfaces_of(scene, context)
        number = np.pad(position[..., 3], 1, mode="edge")
        rows, columns = SIZE[1], SIZE[0]
        around = [number[j : j + rows, i : i + columns] for j in range(3) for i in range(3)]
        is_edge = np.any([part != position[..., 3] for part in around], axis=0)
        found = normal[..., 3].astype(int)
        assert 0 < is_edge.sum() < is_edge.size / 2
        assert (found[is_edge] & FLAGS["EDGE"] != 0).all()
        assert ((found[is_edge] & FLAGS["LAMP_EDGE"] != 0) == (flag > 0)).all()
        is_plain = ~is_edge & (position[..., 3] == position[0, 0, 3])
        assert (found[is_plain] == 0).all()  # the ball bends away at its limb: that is an edge, too


def test_a_plane_that_recedes_has_no_edge(context: Context) -> None:
    """Depths of neighbours differ by more than any step; the plane is one surface."""
    scene = scene_of([plane([0, -0.2, 0], [0, 1, 0], "matte")], {"matte": MATTE}, EYE)
    position, normal = surfaces_of(scene, context)
    is_met = position[..., 3] > 0
    inside = is_met & np.roll(is_met, 1, axis=0)  # not along the horizon
    assert inside.any()
    assert (normal[..., 3][inside] == 0).all()


def test_what_is_out_of_focus_is_reported(context: Context) -> None:
    """Circles of confusion of more than a pixel, in closed form."""
    objects = [plane([0, -1, 0], [0, 1, 0], "matte")]
    camera = {**EYE, "defocus_angle": 20.0, "focus_distance": 3.0}
    position, normal = surfaces_of(scene_of(objects, {"matte": MATTE}, camera), context)
    is_met = position[..., 3] > 0
    depth = -position[..., 2][is_met]
    lens = np.tan(np.radians(10.0)) * 3.0
    radius = lens * np.abs(1 / depth - 1 / 3.0) * SIZE[1] / (2 * np.tan(np.radians(22.5)))
    found = normal[..., 3][is_met].astype(int) & FLAGS["BLURRED"] != 0
    assert 0 < found.sum() < found.size
    assert np.array_equal(found, radius > 1)
