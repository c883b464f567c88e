"""Rays that meet meshes from far away, as those from the horizon do, against float64."""

from typing import Any

import numpy as np
import pytest

from tests.accel.test_shapes_by_tree import HIT, unit
from tests.conftest import CallGlsl
from tests.support.builders import scene_of
from tests.support.meshes import blob, mesh
from tests.support.mixed_scene import MATERIALS

Array = np.ndarray[Any, Any]

COUNT = 4096
FAR = 1e-5  # of the distance: an error above is none of rounding
MISTAKEN = 3  # of COUNT rays, at most
NOWHERE = 3e38


PLACES = ((0.5, (0, 0, 0)), (0.2, (1, 1, 0)), (0.05, (-1, 0.3, 0.7)))  # sizes and middles


def scene(is_repeated: bool) -> Any:
    """Balls with bumps, of three sizes: of triangles of their own, or one ball in three places."""
    points, faces = blob(4)
    if is_repeated:
        balls = [mesh((points, faces), "white", scale=s, translate=list(at)) for s, at in PLACES]
    else:
        balls = [mesh((points * s + np.array(at), faces), "white") for s, at in PLACES]
    return scene_of(balls, MATERIALS, background={"color": [0.5, 0.6, 0.7]})


def corners() -> tuple[Array, Array, Array]:
    """The corners of all triangles, as float32 has them."""
    points, faces = blob(4)
    parts = [(points * s + np.array(at))[faces] for s, at in PLACES]
    first, second, third = np.concatenate(parts).astype(np.float32).astype(float).swapaxes(0, 1)
    return first, second, third


def distances(origins: Array, directions: Array, triangles: tuple[Array, Array, Array]) -> Array:
    """Distances to the nearest triangles in float64, (n,); infinite without one."""
    first, second, third = triangles
    u_edge, v_edge = second - first, third - first
    found = np.empty(len(origins))
    with np.errstate(divide="ignore", invalid="ignore"):
        for k, (origin, direction) in enumerate(zip(origins, directions, strict=True)):
            across = np.cross(direction, v_edge)
            inverse = 1 / np.einsum("ij,ij->i", u_edge, across)
            away = origin - first
            u = np.einsum("ij,ij->i", away, across) * inverse
            other = np.cross(away, u_edge)
            v = other @ direction * inverse
            t = np.einsum("ij,ij->i", v_edge, other) * inverse
            found[k] = np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0), t, np.inf).min()
    return found


@pytest.mark.slow_cases("*repeated")
@pytest.mark.parametrize("is_repeated", [False, True], ids=["own", "repeated"])
@pytest.mark.parametrize("distance", [3e2, 3e3, 3e4])
def test_rays_from_afar_meet_what_they_meet_in_float64(
    call_glsl: CallGlsl, distance: float, is_repeated: bool
) -> None:
    """At their distances; a triangle that is seen from its edge is not met next to the mesh."""
    shown = scene(is_repeated)
    triangles = corners()
    draw = np.random.default_rng(5)
    target = triangles[0][draw.integers(0, len(triangles[0]), COUNT)]
    direction = unit(draw.normal(size=(COUNT, 3)))
    origin = target - distance * direction + 0.002 * draw.normal(size=(COUNT, 3))
    given = {
        "o": origin,
        "d": direction,
        "leaves": np.full(COUNT, -1),
        "inward": np.zeros(COUNT, int),
    }
    limits = {"limit": np.array([3.4e38]), "ignored": np.array([-1])}
    found = call_glsl("hit.distance", "float", setup=HIT, scene=shown, **given, **limits)
    exact = [it.astype(np.float32).astype(float) for it in (origin, direction)]
    truth = distances(exact[0], exact[1], triangles)
    is_met, should_meet = found < NOWHERE, np.isfinite(truth)
    assert should_meet.mean() > 0.9
    assert (is_met != should_meet).sum() <= MISTAKEN
    both = is_met & should_meet
    assert (np.abs(found - truth)[both] > FAR * distance).sum() <= MISTAKEN
