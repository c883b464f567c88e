"""Layers of particles' light: a picture is relit, or has fewer bounces, without a restart."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.tonemap import expose_and_encode
from glrt.plan.plan import NONE, ONE, Weights
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import with_lights
from glrt.settings import Cost
from tests.support.particle_rooms import BALL, LAMP, ROOMS, room
from tests.support.renders import assert_agree, rendered

ROOM = ROOMS["lamps of several kinds"]  # two groups: of a spot, and of a disk and a ball
ON: dict[str, Any] = {"caustics": "on", "particles": 1.0, "bounces": 4}
SMALL: dict[str, Any] = {"width": 16, "height": 16, "sampler": "independent"}


@pytest.fixture(scope="module")
def by_group(context: Context) -> Any:
    renderer = Renderer(ROOM, context=context, layering="groups", **SMALL, **ON)
    yield renderer.render(1024)
    renderer.release()


@pytest.fixture(scope="module")
def by_length(context: Context) -> Any:
    renderer = Renderer(ROOM, context=context, layering="lengths", **SMALL, **ON)
    yield renderer.render(1024)
    renderer.release()


def particles_of(image: Image) -> np.ndarray[Any, Any]:
    assert image.particles
    return image.particles.mean.astype(float)


def alone(layers: int, shown: int) -> Weights:
    return tuple(ONE if layer == shown else NONE for layer in range(layers))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["by_group", "by_length"])
def test_layers_add_up_to_all(name: str, request: pytest.FixtureRequest) -> None:
    renderer: Renderer = request.getfixturevalue(name)
    count = renderer.plan.layers
    whole = particles_of(renderer.image((ONE,)))
    parts = [particles_of(renderer.image(alone(count, layer))) for layer in range(count)]
    assert count == (2 if name == "by_group" else 5)
    np.testing.assert_allclose(np.sum(parts, axis=0), whole, rtol=1e-4, atol=1e-7)
    assert sum(part.mean() > 0.002 * whole.mean() for part in parts) >= count - 2


@pytest.mark.slow
def test_layers_change_nothing_of_the_whole(context: Context, by_group: Renderer) -> None:
    plain = rendered(ROOM, context, 1024, **SMALL, **ON)
    image = by_group.image()
    np.testing.assert_allclose(image.radiance, plain.radiance, rtol=1e-4)
    np.testing.assert_allclose(image.stderr, plain.stderr, rtol=1e-3)


@pytest.mark.slow
def test_weights_are_factors(by_group: Renderer) -> None:
    weights = ((2.0, 1.0, 0.5), (0.25, 3.0, 0.0))
    one, other = (particles_of(by_group.image(alone(2, layer))) for layer in (0, 1))
    expected = weights[0] * one + weights[1] * other
    np.testing.assert_allclose(particles_of(by_group.image(weights)), expected, rtol=1e-5)


@pytest.mark.slow
def test_a_group_alone_is_the_scene_with_the_other_one_dark(
    context: Context, by_group: Renderer
) -> None:
    dark = with_lights(ROOM, {"lamp": 0.0})
    assert by_group.update(dark, "groups") is Cost.RELIGHT
    image = by_group.image()
    by_group.update(ROOM, "groups")
    assert_agree(image, rendered(dark, context, 4096, seed=1, bounces=4, **SMALL), within=0.1)


@pytest.mark.slow
def test_fewer_bounces_are_the_picture_of_so_many(context: Context, by_length: Renderer) -> None:
    assert by_length.update(bounces=2) is Cost.RELIGHT
    image = by_length.image()
    by_length.update(bounces=4)
    assert_agree(image, rendered(ROOM, context, 4096, seed=1, bounces=2, **SMALL), within=0.1)


@pytest.mark.slow
def test_a_link_through_a_ball_is_as_long_as_its_path(context: Context) -> None:
    """The floor behind a ball of glass is dark where paths end after two bounces."""
    near = {"position": [0.35, -0.5, 0.5], "look_at": BALL["center"], "fov": 40}
    scene = room(LAMP, BALL, **near)
    renderer = Renderer(scene, context=context, layering="lengths", **SMALL, **ON, linked=1.0)
    lit = renderer.render(2048).image().radiance.mean()
    assert renderer.update(bounces=2) is Cost.RELIGHT
    image = renderer.image()
    renderer.release()
    assert image.radiance.mean() < 0.8 * lit
    assert_agree(image, rendered(scene, context, 8192, seed=1, bounces=2), within=0.2)


@pytest.mark.parametrize("group", ["dim", "spot"])
def test_what_is_shown_is_the_picture(by_group: Renderer, group: str) -> None:
    """This holds also where a group without a lamp is dimmed, and all weights are 1."""
    by_group.update(with_lights(ROOM, {group: 0.5}), "groups")
    shown, image = by_group.display(), by_group.image()
    with by_group.context.gl:
        found = by_group.reading(by_group.plan.weights, 5, 11)
    by_group.update(ROOM, "groups")
    expected = expose_and_encode(image.radiance, 0.0, "neutral")
    assert np.abs(shown.astype(int) - expected.astype(int)).max() <= 1
    np.testing.assert_allclose(found.radiance, image.radiance[11, 5], rtol=1e-6)
    np.testing.assert_allclose(found.stderr, image.stderr[11, 5], rtol=1e-6)


@pytest.mark.slow
def test_a_moved_camera_compiles_no_particles(context: Context) -> None:
    camera = ROOM.camera.model_copy(update={"position": (0.1, 0.0, 0.8)})
    moved = ROOM.model_copy(update={"camera": camera})
    renderer = Renderer(ROOM, context=context, **SMALL, **ON)
    before = renderer.render(8)._tracer.particles
    assert before
    assert renderer.update(moved) is Cost.RESTART
    after = renderer._tracer.particles
    assert after
    assert after._kernel is before._kernel
    image = renderer.render(32).image()
    renderer.release()
    expected = rendered(moved, context, 32, **SMALL, **ON)
    assert np.array_equal(image.radiance, expected.radiance)


@pytest.mark.slow
def test_a_moved_camera_compiles_nothing_once_particles_are_off(context: Context) -> None:
    camera = ROOM.camera.model_copy(update={"position": (0.1, 0.0, 0.8)})
    moved = ROOM.model_copy(update={"camera": camera})
    renderer = Renderer(ROOM, context=context, **SMALL, **ON)
    assert renderer.update(caustics="off") is Cost.RECOMPILE
    assert renderer.update(moved) is Cost.RESTART
    renderer.release()


@pytest.mark.slow
def test_the_error_of_a_relit_picture_is_its_spread(context: Context) -> None:
    """The test takes the root mean variance of pixels over 64 renders, within 12 %."""
    dim = with_lights(ROOM, {"spot": 0.3})
    images = []
    for seed in range(64):
        renderer = Renderer(
            ROOM, context=context, layering="groups", seed=seed, **{**SMALL, "samples": 256}, **ON
        )
        renderer.render(256).update(dim, "groups")
        images.append(renderer.image())
        renderer.release()
    spread = np.var([image.radiance for image in images], axis=0, ddof=1).mean()
    told = np.mean([np.square(image.stderr) for image in images])
    assert 0.88 < (told / spread) ** 0.5 < 1.12
