"""Particles that reach a pixel: all are found, with the way that they took."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.packing import particles
from glrt.rendering.paths.values import PixelPaths
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.shapes.quad import Quad
from tests.support.first_hits import axes_of
from tests.support.path_checks import NEAR, off_surface, outward, vector
from tests.support.pixel_paths import assert_same_bits, replayed

PIXEL = (11, 14)  # of the floor, under the glass ball
ON: dict[str, Any] = {"caustics": "on", "linked": 0.0, "samples": 20}


def films(scene: Scene, context: Context, **settings: Any) -> Any:
    """The two films of a render at PIXEL."""
    renderer = Renderer(scene, context=context, tier="complete", width=16, height=16, **settings)
    image = renderer.render().image()
    renderer.release()
    assert image.particles
    return image.particles.camera[PIXEL[1], PIXEL[0]], image.particles.mean[PIXEL[1], PIXEL[0]]


@pytest.fixture(scope="module")
def found(context: Context) -> PixelPaths:
    return replayed(load("cornell"), PIXEL, context, **ON)


@pytest.mark.parametrize(
    "more",
    [{"linked": 0.5}, pytest.param({"sampler": "independent"}, marks=pytest.mark.slow)],
    ids=str,
)
def test_both_films_add_up(context: Context, more: dict[str, Any]) -> None:
    """The film of particles agrees except for the fixed point in which it sums."""
    told = replayed(load("cornell"), PIXEL, context, **{**ON, **more})
    camera, particles = films(load("cornell"), context, **{**ON, **more})
    assert told.particles
    assert told.particles.mean == pytest.approx(particles, rel=1e-5)
    assert len(told.particles.numbers) > 50
    if context.is_software:
        assert_same_bits(told, camera, str(more))


def test_the_brightest_are_reported_with_what_they_bring(found: PixelPaths) -> None:
    assert found.particles
    names = found.particles.brightest(5)
    paths = found.particles.paths[:5]
    assert [(path.sample, path.particle) for path in paths] == names
    for name, path in zip(names, paths, strict=True):
        radiance = found.particles.radiances[found.particles.numbers.index(name)]
        assert np.array(path.radiance, np.float32) == pytest.approx(radiance)
        summed = np.sum([light.added for light in path.contributions], axis=0)
        assert summed == pytest.approx(radiance, rel=1e-5)


def test_their_ways_lead_from_the_lamp_to_the_pixel(found: PixelPaths) -> None:
    assert found.particles
    scene = found.recipe.scene
    right, up, forward = axes_of(scene.camera)
    tangent = math.tan(math.radians(scene.camera.fov) / 2)
    for path in found.particles.paths:
        assert (path.vertices[0].event, path.vertices[0].name) == ("lamp", "lamp")
        for vertex in path.vertices:
            shape = scene.objects[vertex.object or 0]
            assert off_surface(shape, vector(vertex.position)) < NEAR
            assert vertex.normal == pytest.approx(
                tuple(outward(shape, vector(vertex.position))), abs=NEAR
            )
        for before, here in pairwise(path.vertices):
            led = vector(before.position) + here.distance * vector(before.direction)
            assert vector(here.position) == pytest.approx(led, abs=NEAR)
        for light in path.contributions:
            assert path.vertices[light.vertex].event == "matte"
            seen = vector(path.vertices[light.vertex].position) - scene.camera.position
            x = np.dot(seen, right) / np.dot(seen, forward) / tangent
            y = np.dot(seen, up) / np.dot(seen, forward) / tangent
            assert (int(8 * (1 + x)), int(8 * (1 - y))) == PIXEL


def test_their_weight_is_against_both_ways_of_the_camera(
    found: PixelPaths, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Densities of the film in closed form: 1 / (4 tan^2 cos^3), by cosine over square distance."""
    monkeypatch.setattr(particles, "front_shares", lambda _, lamps: [0.5] * len(lamps))
    matte = replayed(load("cornell"), (3, 9), context, **ON)  # of a wall
    assert found.particles
    assert matte.particles
    scene, checked = found.recipe.scene, set()
    forward = axes_of(scene.camera)[2]
    tangent = math.tan(math.radians(scene.camera.fov) / 2)
    for path in found.particles.paths + matte.particles.paths:
        first, lamp = path.vertices[1], scene.objects[path.vertices[0].object or 0]
        assert isinstance(lamp, Quad)
        kappa, towards = 0.0, vector(path.vertices[0].direction)
        if first.event == "matte":
            normal = np.cross(lamp.edge_u, lamp.edge_v)
            sampled = first.distance**2 / abs(float(np.dot(towards, normal)))
            kappa = sampled * math.pi / abs(float(np.dot(towards, vector(first.normal))))
        for light in path.contributions:
            at = path.vertices[light.vertex]
            ray = vector(at.position) - scene.camera.position
            distance = np.linalg.norm(ray)
            ray /= distance
            film = 1 / (4 * tangent**2 * np.dot(ray, forward) ** 3)
            film *= abs(np.dot(ray, vector(at.normal))) / distance**2
            assert light.other_pdf == pytest.approx(film, rel=1e-4)
            over = film / light.pdf
            weight = 1 / (1 + over**2 + (over * kappa) ** 2)
            assert light.weight == pytest.approx(weight, rel=1e-3)
            checked.add(kappa == 0)
    assert checked == {True, False}


def test_without_them_none_are_reported(context: Context) -> None:
    assert replayed(load("cornell"), PIXEL, context, samples=1).particles is None
