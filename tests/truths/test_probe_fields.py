"""Probes under light that is known by direction, and surfaces lit by known probes."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.packing.probes import (
    IN_ROW,
    LIGHT,
    LIGHT_MAP,
    all_of,
    even_directions,
    seeds,
    turn,
    update_block,
)
from glrt.rendering.probe_tracer import RAYS, ProbeTracer
from tests.support.builders import MATTE, plane, scene_of
from tests.truths.test_probes import WAY, directions, inner, probes_of, room

Floats = NDArray[Any]

TEXELS = LIGHT_MAP * LIGHT_MAP
MEAN, SLOPE = 1.0, np.array([0.3, -0.5, 0.2])
FAR = 1e3


def linear(towards: Floats) -> Floats:
    """Radiance from directions, (..., 3) each."""
    return np.asarray(MEAN + towards @ SLOPE)


def irradiance(normals: Floats) -> Floats:
    """The irradiance of that, over the half space of each normal: pi a + 2 pi / 3 b . n."""
    return np.asarray(np.pi * MEAN + 2 * np.pi / 3 * (normals @ SLOPE))


@contextmanager
def lit_by(context: Context) -> Iterator[ProbeTracer]:
    """A tracer whose probes have taken one update of that light, from 64 directions."""
    with probes_of(room("sphere", 0.5), context, bounces=3) as (_, tracer):
        turned = even_directions(RAYS) @ turn(seeds(5)).T
        rays = np.ones((tracer.grid.probes, RAYS, 4), np.float32)
        rays[..., :3] = linear(turned)[None, :, None]
        tracer._block.write(update_block(turned, LIGHT, all_of(tracer.grid.probes)))
        tracer._rays.write(rays)
        tracer._run("probe_light", TEXELS)
        yield tracer


def test_light_that_is_linear_in_direction_is_integrated(context: Context) -> None:
    """The integral uses 64 directions with weights of a ratio; a constant passes unchanged."""
    with lit_by(context) as tracer:
        found = inner(tracer, "probe_light")[..., 0]
    expected = irradiance(directions(LIGHT_MAP - 2))
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), atol=0.02)


def between(tile: Floats, towards: Floats) -> Floats:
    """The values of a map with its border in directions, (n,): the test's own sampler."""
    square = towards[:, :2] / np.abs(towards).sum(axis=1)[:, None]
    signs = np.where(square >= 0, 1.0, -1.0)
    folded = np.where(towards[:, 2:] < 0, (1 - np.abs(square[:, ::-1])) * signs, square)
    place = (folded / 2 + 0.5) * (LIGHT_MAP - 2) + 0.5
    first = np.clip(np.floor(place), 0, LIGHT_MAP - 2).astype(int)
    (x, y), (u, v) = first.T, (place - first).T
    low = (1 - u) * tile[y, x] + u * tile[y, x + 1]
    high = (1 - u) * tile[y + 1, x] + u * tile[y + 1, x + 1]
    return np.asarray((1 - v) * low + v * high)


def test_what_is_read_between_texels_has_no_edge(context: Context) -> None:
    """The fold of the square has none either, in downward directions next to the axes."""
    with lit_by(context) as tracer:
        texture = tracer.maps["probe_light"]
        shape = texture.height, IN_ROW * LIGHT_MAP, 4
        tile = np.frombuffer(texture.read(), np.float32).reshape(shape)[:LIGHT_MAP, :LIGHT_MAP, 0]
    random = np.random.default_rng(1).normal(size=(20000, 3))
    towards = random / np.linalg.norm(random, axis=1)[:, None]
    error = between(tile, towards) - irradiance(towards)
    assert np.sqrt(np.mean(error**2)) < 0.08  # of 2.6 from the darkest direction to the brightest
    for axis in (0, 1):
        near = random.copy()
        near[:, axis], near[:, 2] = 1e-5, -np.abs(near[:, 2])
        other = near * np.where(np.arange(3) == axis, -1, 1)
        jump = between(tile, near) - between(tile, other)
        assert np.abs(jump).max() < 0.02


@pytest.mark.parametrize("tilt", [0.0, 0.3])
def test_light_of_probes_is_a_mean_without_edges_at_cells(context: Context, tilt: float) -> None:
    """Over four cells of a floor, between probes of random light: no jump, and none beyond them."""
    floor = scene_of(
        [plane([0, -0.4, 0], [tilt, 1, 0], "white")],
        {"white": {**MATTE, "color": [1, 1, 1]}},
        {"position": [0.1, 0.6, 0.05], "look_at": [0, -0.4, 0], "fov": 60},
        probes={"min": [-1, -1, -1], "max": [1, 1, 1], "counts": [4, 4, 4]},
    )
    way, size = {**WAY, "probes": 4}, 128
    with probes_of(floor, context, width=size, height=size, **way, bounces=2) as found:
        renderer, tracer = found
        renderer.probes.work_on(0)
        values = np.random.default_rng(2).uniform(1, 2, tracer.grid.probes)
        write(tracer, "probe_light", LIGHT_MAP, np.pi * values)
        write(tracer, "probe_distances", 16, np.full(tracer.grid.probes, FAR), FAR**2)
        places = tracer.maps["probe_places"]
        places.write(np.tile(np.array([0, 0, 0, 1], np.float32), (places.height * places.width, 1)))
        renderer._tracer.step(1)
        light = np.frombuffer(renderer.film.mean.read(), np.float32)
    picture = light.reshape(size, size, 4)[..., 0].astype(float)
    assert picture.min() > 1.0
    assert picture.max() < 2.0
    assert np.ptp(picture) > 0.2
    for axis in (0, 1):
        assert np.abs(np.diff(picture, axis=axis)).max() < 0.08


def write(
    tracer: ProbeTracer, name: str, side: int, of_probes: Floats, second: float | None = None
) -> None:
    """One value for all directions of each probe; `second`: of the second channel."""
    texture = tracer.maps[name]
    maps = np.zeros((texture.height // side, IN_ROW, 4), np.float32)
    maps.reshape(-1, 4)[: len(of_probes)] = of_probes[:, None]
    if second is not None:
        maps[..., 1] = second
    texels = maps.repeat(side, axis=0).repeat(side, axis=1)
    texture.write(np.ascontiguousarray(texels))
