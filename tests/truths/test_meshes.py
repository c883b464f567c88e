"""Triangle meshes against closed forms, and against shapes that have the same surface."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context, open_context
from glrt.scene.scene import Scene
from tests.support.builders import glass, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.meshes import Faces, blob, box, icosphere, mesh, quads
from tests.support.renders import METHODS, assert_agree, rendered, rendering, same, whole
from tests.support.system_packages import needs_osmesa

WHITE_SKY = {"color": [1.0, 1.0, 1.0]}
WHITE = {"type": "lambertian", "color": [1.0, 1.0, 1.0]}
MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [0.75, 0.75, 0.75]},
    "red": {"type": "lambertian", "color": [0.75, 0.25, 0.125]},
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.4},
    "glass": glass(),
    "lamp": lamp(4.0),
}
SMALL = {"width": 24, "height": 24}
AHEAD = {"position": [0, 0, 3.5], "look_at": [0, 0, 0], "fov": 40}


def furnace(faces: Faces, material: dict[str, Any], **more: Any) -> Scene:
    """A mesh before a sky of radiance 1."""
    return scene_of([mesh(faces, "ball", **more)], {"ball": material}, AHEAD, background=WHITE_SKY)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("faces", [icosphere(2), box([-1, -1, -1], [1, 1, 1])])
def test_white_facets_vanish_before_a_white_sky(
    context: Context, faces: Faces, method: str
) -> None:
    """A path leaves a convex mesh after one bounce, at every pixel and sample."""
    scene = furnace(faces, WHITE, smooth=False)
    image = rendered(scene, context, 64, method=method, roulette=False, bounces=2)
    assert (image.radiance == 1).all()


@pytest.mark.slow
def test_a_white_mesh_that_is_not_convex_vanishes_too(context: Context) -> None:
    scene = furnace(blob(4), WHITE, smooth=False)
    image = rendered(scene, context, 64, roulette=False, bounces=400)
    assert (image.radiance == 1).all()


@pytest.mark.parametrize("method", METHODS)
def test_smooth_normals_lose_little_of_a_white_sky(context: Context, method: str) -> None:
    """Tilts up to 5 degrees: at most 1 % is lost, and nothing gained."""
    scene = furnace(icosphere(3), WHITE)
    image = rendered(scene, context, 256, method=method, roulette=False, bounces=8, **SMALL)
    assert image.radiance.max() <= 1
    assert image.radiance.mean() > 0.99


@pytest.mark.slow
@pytest.mark.parametrize("smooth", [True, False])
def test_clear_glass_of_index_1_is_not_seen(context: Context, smooth: bool) -> None:
    scene = furnace(icosphere(3), glass(1.0), smooth=smooth)
    image = rendered(scene, context, 16, roulette=False, bounces=8, **SMALL)
    assert (image.radiance == 1).all()


@pytest.mark.slow
def test_a_glass_box_of_triangles_looks_as_one_of_glass(context: Context) -> None:
    low, high = [-0.5, -0.625, -0.5], [0.5, 0.5, 0.5]
    world = [plane([0, -1, 0], [0, 1, 0], "red"), plane([0, 0, -3], [0, 0, 1], "white")]
    solid = {"shape": "box", "min": low, "max": high, "material": "glass"}
    pictures = [
        rendered(
            scene_of([thing, *world], MATERIALS, AHEAD, background={"color": [0.8, 0.9, 1.0]}),
            context,
            4096,
            bounces=12,
            seed=seed,
        )
        for seed, thing in enumerate((solid, mesh(box(low, high), "glass", smooth=False)))
    ]
    assert_agree(pictures[0], pictures[1], 0.02)


def room(of_triangles: bool) -> Scene:
    """A room of coloured walls with a block in it, under a quad lamp."""
    walls: dict[str, list[list[list[float]]]] = {
        "white": [
            [[-1, -1, -1], [2, 0, 0], [0, 0, 2]],
            [[-1, 1, -1], [2, 0, 0], [0, 0, 2]],
            [[-1, -1, -1], [2, 0, 0], [0, 2, 0]],
        ],
        "red": [[[-1, -1, -1], [0, 0, 2], [0, 2, 0]], [[1, -1, -1], [0, 0, 2], [0, 2, 0]]],
        "brass": [[[-0.5, -0.5, -0.5], [0.75, 0, 0], [0, 0, 0.5]]],
    }
    objects = [quad([-0.25, 0.96875, -0.25], [0.5, 0, 0], [0, 0, 0.5], "lamp")]
    for material, sides in walls.items():
        if of_triangles:
            objects.append(mesh(quads(*sides), material, smooth=False))
        else:
            objects += [quad(corner, u, v, material) for corner, u, v in sides]
    return scene_of(objects, MATERIALS, {"position": [0, 0, 3], "look_at": [0, 0, 0], "fov": 45})


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_room_of_triangles_has_the_picture_of_one_of_quads(context: Context, method: str) -> None:
    """Both use the same random numbers: only rounding is left, which changes few paths."""
    settings: dict[str, Any] = {"method": method, "bounces": 6, **SMALL}
    ours, theirs = (
        rendered(room(of_triangles), context, 64, **settings).radiance
        for of_triangles in (True, False)
    )
    other = rendered(room(False), context, 64, seed=1, **settings).radiance
    apart = np.sqrt(np.mean((ours - theirs) ** 2))
    assert apart < 0.05 * np.sqrt(np.mean((other - theirs) ** 2))


@pytest.mark.slow
def test_a_finer_ball_of_triangles_comes_nearer_to_the_ball(context: Context) -> None:
    """Light of a ball with n times the triangles along each edge is 1 / n^2 as far off."""

    def glow(thing: dict[str, Any]) -> float:
        scene = scene_of([thing], {"glow": lamp(1.0)}, {**AHEAD, "fov": 35})
        image = rendered(scene, context, 1024, width=32, height=32, bounces=0, sampler="sobol")
        return float(image.radiance.mean())

    exact = glow(sphere([0, 0, 0], 1, "glow"))
    off = [exact - glow(mesh(icosphere(steps), "glow")) for steps in (1, 2, 3)]
    assert_allclose([off[0] / off[1], off[1] / off[2]], 4, rtol=0.15)


def things(scale: float = 1.0, offset: tuple[float, float, float] = (0, 0, 0)) -> Scene:
    """Meshes of every material with a lamp among them, with coordinates that float64 holds."""
    points, faces = blob(2)
    ball = np.rint(points * 2**20) / 2**20, faces  # so many digits that an offset takes none

    def at(*point: float) -> list[float]:
        return [scale * (c + o) for c, o in zip(point, offset, strict=True)]

    def place(material: str, where: tuple[float, ...], size: float, **more: Any) -> dict[str, Any]:
        return mesh(ball, material, translate=at(*where), scale=scale * size, **more)

    objects = [
        plane(at(0, -1, 0), [0, 1, 0], "white"),
        place("glass", (-0.625, -0.375, 0), 0.5),
        place("brass", (0.75, -0.5, 0.25), 0.25, smooth=False),
        place("red", (0.125, -0.25, -1), 0.5),
        place("lamp", (0.25, 0.875, 0.25), 0.125, smooth=False),
    ]
    camera = {"position": at(0.125, 0.25, 3.0), "look_at": at(0, 0, 0.125)}
    return scene_of(objects, MATERIALS, camera, background={"color": [0.3, 0.4, 0.5]})


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_meshes_scaled_by_a_power_of_two_keep_their_bits(context: Context, method: str) -> None:
    expected = rendered(things(), context, 4, method=method, **SMALL)
    for power in (-30, -10, -1, 1, 3, 10, 30):
        image = rendered(things(2.0**power), context, 4, method=method, **SMALL)
        assert same(image, expected), power


@pytest.mark.parametrize("offset", [(2.0**20, 0, 0), (-(2.0**20), 2.0**19, 2.0**20)])
def test_meshes_far_from_the_origin_keep_their_bits(
    context: Context, offset: tuple[float, float, float]
) -> None:
    expected = rendered(things(), context, 4, **SMALL)
    assert same(rendered(things(1.0, offset), context, 4, **SMALL), expected)


@pytest.mark.slow
def test_meshes_have_the_same_bits_everywhere(context: Context) -> None:
    """This holds in both pipelines and tiers, and by EGL and OSMesa."""
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    expected = rendered(things(), context, 4, **SMALL)
    fragment = rendered(things(), context, 4, pipeline="fragment", tier="complete", **SMALL)
    assert same(fragment, expected)
    assert same(rendered(things(), context, 4, tier="complete", **SMALL), expected)
    if context.route == "egl":
        needs_osmesa()
    other = open_context("osmesa" if context.route == "egl" else "egl")
    with other.gl:
        assert same_bits(rendered(things(), other, 4, **SMALL).radiance, expected.radiance)
    other.gl.release()


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_lamp_of_triangles_lights_as_one_of_a_quad(context: Context, method: str) -> None:
    corner, u, v = [-0.5, 1, -0.5], [1, 0, 0], [0, 0, 1]
    floor = plane([0, -1, 0], [0, 1, 0], "white")
    flat = mesh(quads([corner, u, v]), "lamp")
    pictures = [
        rendered(
            scene_of([thing, floor], MATERIALS, AHEAD), context, 4096, method=method, seed=seed
        )
        for seed, thing in enumerate((quad(corner, u, v, "lamp"), flat))
    ]
    assert_agree(pictures[0], pictures[1], 0.02)


@pytest.mark.slow
@pytest.mark.parametrize("steps", [0, 2])
def test_many_triangles_that_emit_light_alike_by_all_methods(context: Context, steps: int) -> None:
    """20 triangles are weighed one by one, 320 by clusters."""
    ball = mesh(blob(steps), "lamp", scale=0.25, translate=[0.25, 0.5, 0])
    floor = plane([0, -1, 0], [0, 1, 0], "white")
    wall = mesh(quads([[-2, -1, -1], [4, 0, 0], [0, 2, 0]]), "red", smooth=False)
    scene = scene_of([ball, floor, wall], MATERIALS, AHEAD)
    pictures = [
        rendered(scene, context, 4096, method=method, bounces=2, seed=seed)
        for seed, method in enumerate(METHODS)
    ]
    assert_agree(pictures[0], pictures[1], 0.05)
    assert_agree(pictures[0], pictures[2], 0.05)


@pytest.mark.slow
def test_each_triangle_that_emits_has_its_own_density(context: Context) -> None:
    """A large one, and a small one that stands across."""
    large = [[-1.5, 1, -1.5], [1.5, 1, -1.5], [0, 1, 1.5]]
    small = [[0.9, -0.6, -0.5], [1.0, -0.6, -0.5], [0.9, -0.5, -0.4]]
    lamps = np.array([*large, *small]), np.arange(6).reshape(2, 3)
    floor = plane([0, -1, 0], [0, 1, 0], "white")
    scene = scene_of([mesh(lamps, "lamp"), floor], MATERIALS, AHEAD)
    pictures = [
        rendered(scene, context, 4096, method=method, bounces=1, seed=seed)
        for seed, method in enumerate(METHODS)
    ]
    assert_agree(pictures[0], pictures[1], 0.02)
    assert_agree(pictures[0], pictures[2], 0.02)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_light_from_behind_a_triangle_does_not_light_it(context: Context, method: str) -> None:
    """Though the normals at its corners lean over its edge, towards a lamp below it."""
    floor = quads([[-3, -1, -3], [0, 0, 6], [6, 0, 0]])
    leaning = np.tile([0.95, 0.3, 0.0], (4, 1))
    lamp_below = quad([3.5, -3, -1], [0, 1.5, 0], [0, 0, 2], "lamp")
    scene = scene_of([mesh(floor, "white", normals=leaning), lamp_below], MATERIALS, AHEAD)
    eye = {"position": [0, 1, 0.01], "look_at": [0, -1, 0]}
    above = scene.model_copy(update={"camera": scene.camera.model_copy(update=eye)})
    image = rendered(above, context, 64, method=method, bounces=1)
    assert (image.radiance == 0).all()


@pytest.mark.slow
def test_no_light_leaks_out_of_a_closed_room_of_triangles(context: Context) -> None:
    """A room that reflects all, seen from inside, under a sky that would show."""
    points, faces = box([-1, -1, -1], [1, 1, 1])
    black = {"type": "lambertian", "color": [1.0, 1.0, 1.0]}
    eye = {"position": [0.3, -0.2, 0.1], "look_at": [-1, 0.5, -0.7], "fov": 90}
    for shape in ((points, faces), (blob(3)[0] * 2, blob(3)[1])):
        scene = scene_of([mesh(shape, "wall")], {"wall": black}, eye, background=WHITE_SKY)
        with rendering(scene, context, roulette=False, bounces=40, **SMALL) as renderer:
            image = renderer.render(64).image()
        assert whole(image).mean.max() == 0
