"""First surfaces by rasterisation are those of rays, to the bit: their numbers and distances."""

import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT
from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.image.sources import load
from glrt.packing.drawn_triangles import drawn_triangles
from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.rendering.pipelines import PLAIN, Tier, Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.scene.shapes.kinds import KINDS
from tests.support.builders import MATTE, box, cylinder, disk, plane, quad, scene_of, sphere
from tests.support.every_feature import crowd, mapped
from tests.support.images import same_bits
from tests.support.meshes import blob, icosphere, mesh

SIZE: dict[str, Any] = {"width": 64, "height": 48, "bounces": 1, "method": "hybrid"}
# Shading without rays depends on the number and on the bits of the distance of a first surface.
BARE: dict[str, Any] = {**SIZE, "effects": ("ambient_occlusion",)}
TRACED = Variant({"RASTERS": False})
SKY = {"bottom": [0.2, 0.3, 0.9], "top": [0.9, 0.5, 0.1]}


def picture(scene: Scene, context: Context, variant: Variant = PLAIN, **more: Any) -> Any:
    renderer = Renderer(scene, context=context, variant=variant, **{**BARE, **more})
    found = renderer.render(more.get("samples", 4)).image().radiance
    renderer.release()
    return found


def assert_rastered(scene: Scene, context: Context, **more: Any) -> None:
    """The picture has the bits of one whose first rays are traced, and shows something."""
    found = picture(scene, context, **more)
    assert same_bits(found, picture(scene, context, TRACED, **more))
    assert len(np.unique(found)) > 10


def things(random: np.random.Generator) -> list[dict[str, Any]]:
    """Shapes of all kinds, around the origin and around each other."""

    def place(reach: float = 2.0) -> list[float]:
        found: list[float] = random.uniform(-reach, reach, 3).tolist()
        return found

    made = [sphere(place(), float(random.uniform(0.05, 0.8)), "m") for _ in range(3)]
    made += [quad(place(), place(1.5), place(1.5), "m") for _ in range(2)]
    made += [disk(place(), place(1.0), float(random.uniform(0.1, 0.9)), "m") for _ in range(2)]
    for capped in (True, False):
        made.append(cylinder(place(), place(), float(random.uniform(0.05, 0.5)), "m", capped))
    low = np.array(place())
    high = low + random.uniform(0.1, 1.0, 3)
    made.append(box(low.tolist(), high.tolist(), "m", place(90.0)))
    made.append(plane([0, -2.5, 0], place(1.0), "m"))
    some: dict[str, Any] = {"smooth": False, "rotate": place(90.0)}
    made.append(mesh(icosphere(1), "m", translate=place(), scale=0.5, **some))
    made.append(mesh(blob(2), "m", translate=place(), scale=float(random.uniform(0.3, 3)), **some))
    return made


def view(random: np.random.Generator) -> dict[str, Any]:
    """A camera near, among or within the shapes."""
    eye, target = random.uniform(-2.5, 2.5, (2, 3))
    fov = float(random.choice([0.5, 20, 60, 120, 170]))
    return {"position": eye.tolist(), "look_at": target.tolist(), "fov": fov}


@pytest.mark.slow
def test_all_kinds_of_shapes_are_rastered_from_anywhere(context: Context) -> None:
    """Through, behind and next to the camera, and at any angle of view."""
    random = np.random.default_rng(7)
    objects = things(random)
    renderers = [
        Renderer(scene_of(objects, {"m": MATTE}, background=SKY), None, context, **case)
        for case in (BARE, {**BARE, "variant": TRACED})
    ]
    seen = set()
    for _ in range(40):
        scene = scene_of(things(random), {"m": MATTE}, view(random), background=SKY)
        found = []
        for renderer in renderers:
            renderer.update(scene)
            found.append(renderer.render(2).image().radiance)
        assert same_bits(*found)
        seen.add(len(np.unique(found[0])) > 100)
    for renderer in renderers:
        renderer.release()
    assert seen == {True, False} or seen == {True}


@pytest.mark.slow
@pytest.mark.parametrize("name", scene_names())
def test_scenes_that_come_with_glrt_are_rastered(context: Context, name: str) -> None:
    scene = load(name)
    if scene.media:
        pytest.skip("rays cross media before first surfaces")
    assert_rastered(scene, context, samples=2)


@pytest.mark.slow
@pytest.mark.parametrize("tier", ["generic", "complete"])
@pytest.mark.parametrize("scene", [crowd(), mapped()], ids=["crowd", "mapped"])
def test_trees_repeated_meshes_holes_and_hidden_backs_are_rastered(
    context: Context, scene: Scene, tier: Tier
) -> None:
    assert_rastered(scene, context, tier=tier, sampler="independent")


@pytest.mark.slow
@pytest.mark.parametrize(
    "more",
    [{"pipeline": "fragment"}, {"crop": (11, 7, 23, 31)}, {"sampler": "independent", "seed": 5}],
    ids=["fragment", "crop", "independent"],
)
def test_other_ways_are_rastered(context: Context, more: dict[str, Any]) -> None:
    assert_rastered(load("spot"), context, **more)


@pytest.mark.slow
def test_a_crop_is_a_part_of_the_raster(context: Context) -> None:
    x, y, width, height = crop = (9, 5, 30, 20)
    whole = picture(load("spot"), context)
    part = picture(load("spot"), context, crop=crop)
    assert same_bits(part, whole[y : y + height, x : x + width])


@pytest.mark.slow
def test_of_surfaces_at_one_distance_the_first_is_seen(context: Context) -> None:
    """Two quads in one plane: rays see the one with the lower number, and so does the raster."""
    colors = {"red": [0.9, 0, 0], "green": [0, 0.9, 0]}
    materials = {name: {"type": "lambertian", "color": color} for name, color in colors.items()}
    for names in (("red", "green"), ("green", "red")):
        pair = [
            quad([-half, -half, -2], [2 * half, 0, 0], [0, 2 * half, 0], name)
            for half, name in zip((1.0, 1.5), names, strict=True)
        ]
        scene = scene_of(pair, materials, {"fov": 20}, background={"color": [1] * 3})
        red, green, _ = picture(scene, context).mean(axis=(0, 1))
        seen = {"red": red, "green": green}
        assert seen[names[0]] > 0.1 + seen[names[1]]


@pytest.mark.slow
def test_the_distance_of_the_raster_is_used(context: Context) -> None:
    """Surfaces come from the raster: one without shapes shows the background alone."""
    scene = scene_of([sphere([0, 0, -3], 1, "m")], {"m": MATTE}, background=SKY)
    full = Renderer(scene, None, context, **BARE)
    full._tracer._raster._draws = full._tracer._raster._draws[:1]
    empty = full.render(4).image().radiance
    full.release()
    sky = scene_of([sphere([0, 0, 3], 1, "m")], {"m": MATTE}, background=SKY)
    assert same_bits(empty, picture(sky, context))


def test_every_kind_of_shape_is_solved_for_each_pixel() -> None:
    solved = re.findall(r"up_to_(\w+)\(shape\)", read("raster.frag"))
    assert solved == [kind for kind in KINDS if kind != "mesh"]


def test_triangles_are_drawn_in_the_order_of_their_numbers() -> None:
    slots = np.zeros((6, SLOT), np.uint32)
    triangles = LEAF | CONSTANTS["TRIANGLES"] << LINK_BITS
    instance = LEAF | CONSTANTS["INSTANCE"] << LINK_BITS
    slots[1, 12:] = 3, 1, 0, triangles
    slots[2, 12:] = 4, 0, 0, instance | 1  # an instance of the tree that begins at slot 4
    slots[3, 12:] = 2, 2, 0, triangles  # a single triangle
    slots[4, 12:] = 0, 0, 0, 5
    slots[5, 12:] = 1, 0, 0, triangles
    rows: NDArray[np.void] = slots.view(STRUCTS["Slot"]).ravel()
    expected = [(3, 0), (6, 0), (2, 0), (11, 1), (10, 1)]
    assert drawn_triangles(rows, 4).tolist() == [list(row) for row in expected]
