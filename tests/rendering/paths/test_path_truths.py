"""Reports of where paths go and what happens on them are correct: checked in float64."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.paths.values import PathVertex, PixelPaths
from tests.support.path_checks import (
    NEAR,
    crossed_between,
    off_surface,
    outward,
    paths,
    traced_cornell,
    traced_mixed,
    traced_with_roulette,
    vector,
)
from tests.support.pixel_paths import replayed


@pytest.fixture(scope="module")
def cornell(context: Context) -> list[PixelPaths]:
    return traced_cornell(context)


@pytest.fixture(scope="module")
def ended(context: Context) -> list[PixelPaths]:
    return traced_with_roulette(context)


@pytest.fixture(scope="module")
def mixed(context: Context) -> list[PixelPaths]:
    return traced_mixed(context)


# --- where paths go --------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["cornell", "mixed"])
def test_vertices_lie_on_their_objects_where_the_path_leads(
    name: str, request: pytest.FixtureRequest
) -> None:
    for scene, path in paths(request.getfixturevalue(name)):
        for before, here in zip(path.vertices, path.vertices[1:], strict=False):
            assert here.object is not None
            shape, place = scene.objects[here.object], vector(here.position)
            assert off_surface(shape, place) < NEAR
            assert here.normal == pytest.approx(tuple(outward(shape, place)), abs=NEAR)
            led = vector(before.position) + here.distance * vector(before.direction)
            assert place == pytest.approx(led, abs=NEAR)
            for other in scene.objects:
                assert not crossed_between(other, vector(before.position), place)
            assert (here.name, here.material) == (
                shape.name or f"objects[{here.object}] ({shape.shape})",
                shape.material,
            )


def test_the_first_vertex_is_on_the_lens(mixed: list[PixelPaths]) -> None:
    starts = [vector(path.vertices[0].position) for _, path in paths(mixed)]
    camera = mixed[0].recipe.scene.camera
    radius = math.tan(math.radians(camera.defocus_angle) / 2) * camera.resolved_focus_distance
    away = [np.linalg.norm(start - camera.position) for start in starts]
    assert max(away) <= radius * (1 + NEAR)
    assert len(set(away)) > len(away) / 2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "pixel", "event"),
    [("painted", (0, 2), "passes a hole"), ("water", (4, 2), "passes inside glass")],
)
def test_paths_go_straight_on_where_nothing_happens(
    context: Context, scene: str, pixel: tuple[int, int], event: str
) -> None:
    """They go through the hole of a surface, and through a surface that lies in another glass."""
    found = replayed(load(scene), pixel, context)
    passed = 0
    for _, path in paths([found]):
        for before, here in pairwise(path.vertices):
            led = vector(before.position) + here.distance * vector(before.direction)
            assert vector(here.position) == pytest.approx(led, abs=1e-4)
            if here.event == event:
                assert (here.direction, here.pdf) == (before.direction, 0)
                passed += 1
    assert passed > 0


# --- what happens at them --------------------------------------------------------------------


def bends(vertex: PathVertex, arriving: Any) -> None:
    """Mirrored, or by Snell's law of glass of index 1.5."""
    normal, leaving = vector(vertex.normal), vector(vertex.direction)
    if vertex.event == "specular reflection":
        mirrored = arriving - 2 * np.dot(arriving, normal) * normal
        assert leaving == pytest.approx(mirrored, abs=NEAR)
        return
    index = 1.5 if np.dot(arriving, normal) > 0 else 1 / 1.5
    sideways = index * (arriving - np.dot(arriving, normal) * normal)
    assert leaving - np.dot(leaving, normal) * normal == pytest.approx(sideways, abs=NEAR)
    assert np.dot(leaving, normal) * np.dot(arriving, normal) > 0


@pytest.mark.parametrize("name", ["cornell", "mixed"])
def test_glass_bends_and_what_is_matte_scatters(name: str, request: pytest.FixtureRequest) -> None:
    events = set()
    for _, path in paths(request.getfixturevalue(name)):
        for before, here in zip(path.vertices, path.vertices[1:], strict=False):
            events.add(here.event)
            if here.event.startswith("specular"):
                assert here.pdf == 0
                bends(here, vector(before.direction))
            if here.event == "matte":
                cosine = abs(np.dot(vector(here.direction), vector(here.normal)))
                assert here.pdf == pytest.approx(cosine / math.pi, rel=NEAR)
    assert {"specular transmission", "matte"} <= events
    assert ({"cornell": "specular reflection", "mixed": "rough reflection"}[name]) in events


@pytest.mark.parametrize("name", ["cornell", "ended"])
def test_throughput_is_what_surfaces_and_roulette_leave(
    name: str, request: pytest.FixtureRequest
) -> None:
    """Matte surfaces leave their colour; glass the square of the index, there and back."""
    seen = set()
    for scene, path in paths(request.getfixturevalue(name)):
        assert path.vertices[1].throughput == (1, 1, 1)
        for here, after in zip(path.vertices[1:], path.vertices[2:], strict=False):
            share = vector(after.throughput) / vector(here.throughput) * here.survival
            material: Any = scene.materials[here.material or ""]
            seen.add(here.survival < 1)
            if here.event == "matte":
                assert share == pytest.approx(vector(material.color), rel=NEAR)
            elif here.event == "specular reflection":
                assert share == pytest.approx(vector([1, 1, 1]), rel=NEAR)
            elif here.event == "specular transmission":
                assert min(abs(share[0] / 2.25 - 1), abs(share[0] * 2.25 - 1)) < NEAR
    assert seen == ({False} if name == "cornell" else {False, True})


@pytest.mark.parametrize("name", ["cornell", "ended", "mixed"])
def test_paths_end_for_the_reason_reported(name: str, request: pytest.FixtureRequest) -> None:
    found = request.getfixturevalue(name)
    for scene, path in paths(found):
        last, bounces = path.vertices[-1], found[0].recipe.settings.bounces
        scattered = sum(v.event not in ("camera", "ends") for v in path.vertices)
        if path.end == "left the scene":
            assert last.direction is not None
            far = vector(last.position) + 100 * vector(last.direction)
            assert not any(crossed_between(o, vector(last.position), far) for o in scene.objects)
        elif path.end == "bounce limit":
            assert (last.event, scattered) == ("ends", bounces)
        elif path.end == "roulette":
            assert last.survival < 1
        else:
            material: Any = scene.materials[last.material or ""]
            assert path.end == "absorbed"
            assert material.type == "light" or last.event == "rough reflection"
    ends = {path.end for _, path in paths(found)}
    wanted = {"cornell": "bounce limit", "ended": "roulette", "mixed": "left the scene"}
    assert wanted[name] in ends
