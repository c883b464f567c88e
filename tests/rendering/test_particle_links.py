"""Particles that are linked to the camera through single spheres: the same light, less noise."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import Schedule, rounds_for_particles
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.support.builders import (
    box,
    box_of_quads,
    cylinder,
    disk,
    glass,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.images import same_bits
from tests.support.meshes import icosphere, mesh
from tests.support.particle_rooms import BALL, CAMERA, GOLD, LAMP, MATERIALS, ROOMS, room
from tests.support.renders import assert_agree, rendered, rendering, same

ON: dict[str, Any] = {"caustics": "on", "linked": 1.0}
CLOSED = room(
    quad([-0.15, 0.98, -0.45], [0.3, 0, 0], [0, 0, 0.3], "lamp"),
    sphere([0.4, -0.6, -0.2], 0.4, "glass"),
    sphere([-0.45, -0.65, -0.4], 0.35, "mirror"),
    sphere([-0.1, -0.8, 0.25], 0.2, "tinted"),
)
HANGING = quad([-0.15, 0.8, -0.45], [0.3, 0, 0], [0, 0, 0.3], "lamp")
CLOSE: dict[str, Any] = {"position": [0, 0, 0.95], "look_at": [0, -0.2, -0.2], "fov": 52}
FILLING = sphere([0, -0.2, -0.2], 0.5, "glass")
BEFORE = sphere([0.13, 0, 0.45], 0.15, "dark")
GLASS_ALONE = room(HANGING, FILLING, **CLOSE)
DARK = {**MATERIALS, "dark": {"type": "lambertian", "color": [0.02, 0.02, 0.02]}}


def behind_a_ball() -> Scene:
    """Tinted glass, partly hidden by a dark ball, in a room with a dark wall on the left."""
    left, *faces = box_of_quads("matte")
    things = [{**left, "material": "dark"}, *faces, HANGING, BEFORE]
    return scene_of([*things, {**FILLING, "material": "tinted"}], DARK, CLOSE)


def in_the_dark() -> Scene:
    """A ball that mirrors, on both of its sides, a bright wall behind the camera."""
    faces = box_of_quads("dark")
    faces[-1] = {**faces[-1], "material": "matte"}
    shining = quad([-0.2, -0.2, 0.7], [0.4, 0, 0], [0, 0.4, 0], "lamp")
    things = [*faces, {**shining, "emission_side": "front"}, FILLING]
    return scene_of(things, DARK, {**CLOSE, "position": [0.3, 0, 0.65]})


def in_satin() -> Scene:
    """Glass and a mirror, in which rough walls and a ball of gold are seen."""
    balls = [sphere([0.4, -0.6, -0.2], 0.4, "glass"), sphere([-0.1, -0.75, 0.25], 0.25, "mirror")]
    return scene_of([*box_of_quads("satin"), HANGING, GOLD, *balls], MATERIALS, CAMERA)


PLACES = {
    "glass and a mirror in a closed room": CLOSED,
    "a lens": ROOMS["a lens"],
    "tinted glass behind a ball": behind_a_ball(),
    "a ball in the dark": in_the_dark(),
    "glossy surfaces": in_satin(),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PLACES)
def test_links_change_the_noise_alone(context: Context, name: str) -> None:
    size: dict[str, Any] = {"width": 24, "height": 24, "bounces": 6}
    without = rendered(PLACES[name], context, 4096, seed=1, **size)
    image = rendered(PLACES[name], context, 1024, **size, **ON, particles=0.5)
    assert_agree(image, without, within=0.12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bounces", "linked"),
    [
        *((2, 1.0), (3, 0.1), (4, 1.0)),
        *(pytest.param(*it, marks=pytest.mark.slow) for it in ((2, 0.1), (3, 1.0), (4, 0.1))),
    ],
)
def test_however_few_there_are(context: Context, bounces: int, linked: float) -> None:
    """Few particles, and few bounces: a link takes one, two or three."""
    size: dict[str, Any] = {"width": 16, "height": 16, "bounces": bounces}
    without = rendered(GLASS_ALONE, context, 16384, seed=1, **size)
    more = {"caustics": "on", "linked": linked, "particles": 1.0}
    image = rendered(GLASS_ALONE, context, 4096, **size, **more)
    assert_agree(image, without, within=0.1)


@pytest.mark.slow
def test_the_error_falls_of_what_is_seen_in_a_mirror(context: Context) -> None:
    """The relative error over the mirror ball falls by a factor of 5 against particles alone."""
    size: dict[str, Any] = {"width": 32, "height": 32, "sampler": "sobol", "particles": 1.0}
    errors = []
    for way in ({**ON, "linked": 0.0}, ON):
        image = rendered(CLOSED, context, 128, **size, **way)
        relative = (image.stderr / image.radiance)[16:24, 4:12]
        errors.append(float(np.square(relative).mean()) ** 0.5)
    assert errors[1] < errors[0] / 3


# --- bits ------------------------------------------------------------------------------------


def picture(context: Context, **more: Any) -> Image:
    options: dict[str, Any] = {"sampler": "sobol", "bounces": 5, **ON, **more}
    return rendered(ROOMS["a lens"], context, 40, **options)


def test_a_crop_is_that_part_of_the_frame(context: Context) -> None:
    part = picture(context, crop=(3, 5, 9, 7))
    assert same_bits(part.radiance, picture(context).radiance[5:12, 3:12])


@pytest.mark.slow
def test_dispatches_may_be_of_any_size(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = picture(context, width=48, height=48, linked=0.5)
    plain = Schedule.next_dispatch

    def small(self: Any, remaining: int, *rest: Any) -> Any:
        return plain(self, min(remaining, 3), *rest)._replace(tiles=1)

    monkeypatch.setattr(Schedule, "next_dispatch", small)
    assert same(picture(context, width=48, height=48, linked=0.5), expected)


def test_shapes_written_into_the_kernel_change_nothing(context: Context) -> None:
    images = []
    for tier in ("generic", "complete"):
        renderer = Renderer(CLOSED, None, context, tier, width=16, height=16, samples=32, **ON)
        images.append(renderer.render().image())
        renderer.release()
    assert same(*images)


@pytest.mark.slow
def test_a_scene_without_such_spheres_has_no_links(context: Context) -> None:
    scene = room(LAMP, {**BALL, "material": "pane"})
    plain = rendered(scene, context, 32, caustics="on", linked=0.0)
    assert same(plain, rendered(scene, context, 32, **ON))


@pytest.mark.usefixtures("exact_kernels")
@pytest.mark.parametrize("bounces", [3, 7])
def test_the_rounds_of_links_count_towards_the_limit_of_loops(bounces: int) -> None:
    """A link's rounds: a search, the choice of a sphere, and shadow tests to and from it.

    Lamps are linked as well, where their particles leave.
    """
    settings = Settings(bounces=bounces)
    found = {
        linked: rounds_for_particles(
            prepare(CLOSED, settings_for(settings, caustics="on", linked=linked))
        )
        for linked in (0.0, 1.0)
    }
    shapes = 3 + 7  # balls, and quads
    search = shapes + 2
    assert found[0] == (bounces + 1) * 2 * 4 + (4 + 2 * 4 + search)
    assert found[1] - found[0] == (bounces + 2) * (2 + 12 + 4 + 2 * search)
    assert rounds_for_particles(prepare(CLOSED, settings)) == 0


# --- which spheres ---------------------------------------------------------------------------

FLOOR = plane([0, 0, 0], [0, 1, 0], "matte")
ROUND = sphere([0, 1, 0], 1, "glass")
FAR_LAMP = sphere([0, 9, 0], 0.5, "lamp")
ALONE: dict[str, list[dict[str, Any]]] = {
    "on a floor": [FLOOR],
    "beside another": [sphere([1.5, 0.5, 0], 0.5, "matte"), sphere([0, -1000, 0], 1000, "matte")],
    "between tilted walls": [quad([-2, 0, 1.5], [4, 0, 0], [0, 2, 0.2], "matte")],
    "beside a box": [box([1, 0, -1], [2, 2, 1], "matte")],
    "beside a mesh": [mesh(icosphere(1), "matte", translate=[3, 0, 0])],
}
FULL: dict[str, list[dict[str, Any]]] = {
    "sunk into a floor": [plane([0, 0.01, 0], [0, 3, 0], "matte")],
    "with a lamp in it": [sphere([0.1, 1, 0], 0.2, "lamp")],
    "in a larger ball": [sphere([0, 1, 0], 3, "glass")],
    "cut by a quad": [quad([0.5, 0.5, -1], [0, 1, 0], [0, 0, 1], "matte")],
    "with a disk in it": [disk([0, 1, 0], [0, 1, 0], 0.3, "matte")],
    "pierced by a cylinder": [cylinder([0, 0, 0], [0, 3, 0], 0.1, "matte")],
    "with a mesh in it": [mesh(icosphere(1), "matte", scale=0.1, translate=[0, 1, 0])],
}


def links_of(things: list[dict[str, Any]], **material: Any) -> int:
    kind = material if "type" in material else glass(**material)
    scene = scene_of([*things, ROUND, FAR_LAMP], {**MATERIALS, "glass": kind})
    spheres = [thing for thing in scene.visible if thing.shape == "sphere"]
    number = next(n for n, it in enumerate(spheres) if it.material == "glass" and it.radius == 1)
    return SceneFacts(scene).particles.links >> number & 1


@pytest.mark.parametrize("name", ALONE)
def test_a_sphere_that_nothing_lies_in_has_links(name: str) -> None:
    assert links_of(ALONE[name]) == 1


@pytest.mark.parametrize("name", FULL)
def test_one_that_something_lies_in_has_none(name: str) -> None:
    assert links_of(FULL[name]) == 0


def test_balls_of_dispersing_glass_are_not_linked() -> None:
    assert links_of([FLOOR], dispersion=1.0) == 0


def test_a_hidden_thing_lies_nowhere() -> None:
    assert links_of([{**FULL["with a lamp in it"][0], "hidden": True}]) == 1


ROUGH_METAL: dict[str, Any] = {"type": "metal", "preset": "gold", "roughness": 0.2}


@pytest.mark.parametrize(
    "material", [{"thin": True}, {"ior": 0.7}, {"roughness": 0.2}, ROUGH_METAL]
)
def test_what_sends_light_otherwise_has_none(material: dict[str, Any]) -> None:
    assert links_of([FLOOR], **material) == 0


@pytest.mark.slow
def test_a_picture_has_links_only_where_it_asks_for_them(context: Context) -> None:
    scene: Scene = ROOMS["a ball of glass"]
    with rendering(scene, context, caustics="on", linked=0.0) as renderer:
        plain = renderer.render(32).image()
        renderer.update(linked=0.5)
        assert not same(renderer.render(32).image(), plain)
        renderer.update(linked=0.0)
        assert same(renderer.render(32).image(), plain)
