"""Reports of the light on paths agree with float64, and reports explain fireflies."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.rendering.paths.values import PixelPaths
from glrt.scene.scene import Scene
from glrt.scene.shapes.quad import Quad
from tests.support.builders import glass, lamp, plane, quad, scene_of, sphere
from tests.support.path_checks import (
    NEAR,
    crossed_between,
    lights,
    off_surface,
    traced_cornell,
    traced_mixed,
    vector,
)
from tests.support.pixel_paths import replayed


@pytest.fixture(scope="module")
def cornell(context: Context) -> list[PixelPaths]:
    return traced_cornell(context)


@pytest.fixture(scope="module")
def mixed(context: Context) -> list[PixelPaths]:
    return traced_mixed(context)


# --- the light on them -----------------------------------------------------------------------


def lamp_density(shape: Quad, direction: Any, distance: float) -> float:
    """Per solid angle, of points even in area."""
    normal = np.cross(shape.edge_u, shape.edge_v)
    return distance**2 / abs(float(np.dot(direction, normal)))


def heuristic(pdf: float, other: float) -> float:
    return pdf**2 / (pdf**2 + other**2)


def test_densities_and_weights_of_both_strategies(cornell: list[PixelPaths]) -> None:
    """Densities are by area on the one lamp, by cosine at matte surfaces; weights add up to 1."""
    found = set()
    for scene, path, light in lights(cornell):
        at, shape = path.vertices[light.vertex], scene.objects[light.object or 0]
        assert isinstance(shape, Quad)
        if light.strategy == "light sampling":
            towards, distance = vector(light.direction), light.distance or 0.0
            assert off_surface(shape, vector(at.position) + distance * towards) < NEAR
            chosen = lamp_density(shape, towards, distance)
            cosine = float(np.dot(towards, vector(at.normal)))
            assert light.pdf == pytest.approx(chosen, rel=1e-4)
            if cosine > 0 and not light.hidden:
                assert light.other_pdf == pytest.approx(cosine / math.pi, rel=1e-4)
                assert light.weight == pytest.approx(heuristic(chosen, cosine / math.pi), rel=1e-4)
        elif light.strategy == "scattering":
            before = path.vertices[light.vertex - 1]
            assert light.pdf == before.pdf
            if before.pdf:
                other = lamp_density(shape, vector(before.direction), at.distance)
                assert light.other_pdf == pytest.approx(other, rel=1e-4)
                assert light.weight == pytest.approx(heuristic(before.pdf, other), rel=1e-4)
                mirrored = heuristic(other, before.pdf)
                assert light.weight + mirrored == pytest.approx(1, rel=1e-4)
            else:
                assert (light.other_pdf, light.weight) == (0, 1)
        found.add((light.strategy, bool(light.pdf), light.hidden))
    assert {("light sampling", True, False), ("light sampling", True, True)} <= found
    assert {("scattering", True, False), ("scattering", False, False)} <= found


def test_what_is_added_is_weighted_radiance_over_density(cornell: list[PixelPaths]) -> None:
    for scene, path, light in lights(cornell):
        at, radiance = path.vertices[light.vertex], vector(light.radiance)
        carried = vector(at.throughput) * radiance * light.weight
        if light.strategy == "light sampling":
            cosine = float(np.dot(vector(light.direction), vector(at.normal)))
            material: Any = scene.materials[at.material or ""]
            carried = carried * vector(material.color) * max(cosine, 0.0) / (math.pi * light.pdf)
        wanted = [0, 0, 0] if light.hidden else carried
        assert vector(light.added) == pytest.approx(wanted, rel=1e-4, abs=1e-12)
        if not light.hidden:
            assert vector(light.unweighted) * light.weight == pytest.approx(light.added)


def test_hidden_lamps_are_reported(cornell: list[PixelPaths]) -> None:
    """A lamp is hidden if shapes stand between the vertex and the point that was sampled."""
    hidden = {True: 0, False: 0}
    for scene, path, light in lights(cornell):
        if light.strategy != "light sampling" or (not any(light.added) and not light.hidden):
            continue
        start = vector(path.vertices[light.vertex].position)
        end = start + (light.distance or 0.0) * vector(light.direction)
        others = [thing for n, thing in enumerate(scene.objects) if n != light.object]
        between = any(crossed_between(thing, start, end) for thing in others)
        assert between <= light.hidden
        hidden[light.hidden] += 1
    assert min(hidden.values()) > 10


def test_the_sky_is_met_where_nothing_is(mixed: list[PixelPaths]) -> None:
    skies = [(path, light) for _, path, light in lights(mixed) if light.source == "background"]
    assert skies
    for path, light in skies:
        assert (path.end, light.vertex) == ("left the scene", len(path.vertices) - 1)
        assert light.weight == 1


# --- fireflies -------------------------------------------------------------------------------


def firefly_scene() -> Scene:
    """A small lamp above a ball of glass, which no sample on the lamp reaches from below."""
    materials = {
        "white": {"type": "lambertian", "color": [0.7, 0.7, 0.7]},
        "glass": glass(1.5),
        "lamp": lamp(400.0),
    }
    objects = [
        {**plane([0, -1, 0], [0, 1, 0], "white"), "name": "floor"},
        {**sphere([0, 0, 0], 0.6, "glass"), "name": "ball"},
        {**quad([-0.15, 2, -0.15], [0.3, 0, 0], [0, 0, 0.3], "lamp"), "name": "bulb"},
    ]
    return scene_of(objects, materials, {"position": [0, 0.5, 3], "look_at": [0, -1, 0]})


@pytest.mark.slow
def test_a_firefly_is_explained_by_its_way_through_glass(context: Context) -> None:
    settings: Any = {"samples": 64, "bounces": 3, "sampler": "independent", "seed": 2}
    found = replayed(firefly_scene(), (9, 8), context, **settings)
    (number,) = found.brightest(1)
    assert found.shares[number] > 0.9
    path = found.paths[number]
    light = max(path.contributions, key=lambda each: sum(each.added))
    names = [vertex.name for vertex in path.vertices[: light.vertex + 1]]
    assert names == ["camera", "floor", "ball", "ball", "bulb"]
    assert (light.strategy, light.pdf, light.weight) == ("scattering", 0, 1)
    sampled = path.contributions[0]
    assert (sampled.strategy, sampled.vertex, sampled.hidden) == ("light sampling", 1, True)
    assert found.shares.sum() == pytest.approx(1)
