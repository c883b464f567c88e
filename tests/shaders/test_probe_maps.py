"""Directions on a square, visibility by moments and the weights of probes, by closed forms."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.packing.probes import even_directions, seeds, turn
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, plane, scene_of

Floats = NDArray[Any]
SIDES = (6, 14)


def directions(count: int = 4000) -> Floats:
    random = np.random.default_rng(3)
    found = random.normal(size=(count, 3))
    axes = np.concatenate([np.eye(3), -np.eye(3), [[1, 0, -1], [0, -1, -1], [1, -1, 0]]])
    found = np.concatenate([found, axes])
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None], np.float32)


def decoded(place: Floats) -> Floats:
    """The direction of a place on the square, or just beyond its edges: folded over them."""
    x, y = place[:, 0].copy(), place[:, 1].copy()
    over = np.abs(y) > 1
    x[over], y[over] = -x[over], np.sign(y[over]) * (2 - np.abs(y[over]))
    over = np.abs(x) > 1
    x[over], y[over] = np.sign(x[over]) * (2 - np.abs(x[over])), -y[over]
    z = 1 - np.abs(x) - np.abs(y)
    below = z < 0
    signs = np.where(x >= 0, 1, -1), np.where(y >= 0, 1, -1)
    folded = (1 - np.abs(y)) * signs[0], (1 - np.abs(x)) * signs[1]
    found = np.stack([np.where(below, folded[0], x), np.where(below, folded[1], y), z], axis=1)
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])


# --- octahedra --------------------------------------------------------------------------------


def test_a_direction_comes_back_from_the_square(call_glsl: CallGlsl) -> None:
    wanted = directions()
    found = call_glsl("from_octahedron(to_octahedron(d))", "vec3", d=wanted)
    np.testing.assert_allclose(found, wanted, atol=3e-7)


def test_the_square_is_that_of_the_survey(call_glsl: CallGlsl) -> None:
    wanted = directions()
    place = call_glsl("to_octahedron(d)", "vec2", d=wanted)
    assert np.abs(place).max() <= 1
    np.testing.assert_allclose(decoded(place.astype(np.float64)), wanted, atol=1e-6)


@pytest.mark.parametrize("side", SIDES)
def test_a_border_repeats_what_lies_beyond_the_fold(call_glsl: CallGlsl, side: int) -> None:
    """A texel of the border is as far outside as its inner texel is inside, over the fold."""
    y, x = np.mgrid[: side + 2, : side + 2]
    texels = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.int32)
    inner = call_glsl("inner_texel(t, s)", "ivec2", t=texels, s=np.array([side]))
    assert inner.min() == 1
    assert inner.max() == side
    middles = (texels - 0.5) / side * 2 - 1
    expression = "direction_of_texel(inner_texel(t, s), s)"
    found = call_glsl(expression, "vec3", t=texels, s=np.array([side]))
    corners = np.isin(texels, (0, side + 1)).all(axis=1)  # there the fold goes both ways
    np.testing.assert_allclose(found[~corners], decoded(middles)[~corners], atol=1e-6)
    np.testing.assert_array_equal(inner[corners], side + 1 - np.clip(texels[corners], 1, side))


# --- weights ----------------------------------------------------------------------------------


def test_visibility_is_the_cube_of_chebyshevs_bound(call_glsl: CallGlsl) -> None:
    mean = np.array([1.0, 1.0, 1.0, 2.0, 0.5, 1.0])
    spread = np.array([0.1, 0.1, 0.3, 0.5, 0.2, 0.0])
    distance = np.array([0.9, 1.05, 1.2, 2.5, 0.5, 1.5])
    moments = np.stack([mean, mean**2 + spread**2], axis=1)
    found = call_glsl("chance_seen(m, d)", m=moments, d=distance)
    beyond = np.maximum(distance - mean, 0)
    bound = spread**2 / np.maximum(spread**2 + beyond**2, 1e-30)
    wanted = np.where(beyond > 0, np.maximum(bound**3, 0.05), 1)
    np.testing.assert_allclose(found, wanted, rtol=1e-4)


def test_a_probe_before_a_surface_weighs_more_than_one_behind(call_glsl: CallGlsl) -> None:
    up = np.array([[0.0, 1.0, 0.0]])
    towards = np.array([[0, 1, 0], [1, 0, 0], [0, -1, 0]], np.float32)
    found = call_glsl("weight_of_side(n, t)", n=up, t=towards)
    np.testing.assert_allclose(found, [1.2, 0.45, 0.2], rtol=1e-6)


def test_small_weights_fall_faster_and_none_is_zero(call_glsl: CallGlsl) -> None:
    found = call_glsl("crushed(w)", w=np.array([1.0, 0.2, 0.1, 0.0]))
    np.testing.assert_allclose(found[:3], [1.0, 0.2, 0.1**3 / 0.04], rtol=1e-5)
    assert found[3] > 0


GRID = {"min": [-1.0, 0.0, -3.0], "max": [1.0, 4.0, 0.0], "counts": [2, 8, 3]}
SCENE = scene_of([plane([0, -9, 0], [0, 1, 0], "m")], {"m": MATTE}, probes=GRID)


def asked(call_glsl: CallGlsl, expression: str, returns: str, **inputs: Any) -> Floats:
    constants = {"HAS_PROBES": True}
    options = {"method": "ddgi"}
    return call_glsl(
        expression, returns, scene=SCENE, constants=constants, options=options, **inputs
    )


def test_probes_stand_in_the_middles_of_their_cells(call_glsl: CallGlsl) -> None:
    numbers = np.array([0, 1, 2, 15, 16, 47])
    found = asked(call_glsl, "middle_of_cell(k)", "vec3", k=numbers)
    wanted = [[-0.5, 0.25, -2.5], [0.5, 0.25, -2.5], [-0.5, 0.75, -2.5], [0.5, 3.75, -2.5]]
    np.testing.assert_allclose(found[:4], wanted)
    np.testing.assert_allclose(found[4:], [[-0.5, 0.25, -1.5], [0.5, 3.75, -0.5]])
    back = asked(call_glsl, "probe_at(cell_of_probe(k))", "int", k=numbers)
    np.testing.assert_array_equal(back, numbers)


def test_what_probes_know_ends_a_cell_beyond_the_box(call_glsl: CallGlsl) -> None:
    places = np.array([[0, 2, -1], [1, 2, -1], [1.5, 2, -1], [0, 4.25, -1], [0, 2, 1], [2, 9, -9]])
    found = asked(call_glsl, "share_of_probes(p)", "float", p=places)
    np.testing.assert_allclose(found, [1, 1, 0.5, 0.5, 0, 0], atol=1e-6)


def test_light_is_looked_up_before_a_surface_towards_the_eye(call_glsl: CallGlsl) -> None:
    """A fifth of the way along the normal; the length is 0.225 of the shortest edge, 0.5."""
    here, normal, wo = (np.array([v], float) for v in ([0, 1, 0], [0, 1, 0], [0.6, 0.8, 0]))
    found = asked(call_glsl, "biased_place(p, n, w)", "vec3", p=here, n=normal, w=wo)
    np.testing.assert_allclose(found[0] - here[0], 0.1125 * (0.2 * normal[0] + 0.8 * wo[0]), 1e-5)


def test_nearness_adds_up_to_one(call_glsl: CallGlsl) -> None:
    beyond = np.random.default_rng(1).uniform(0.01, 0.99, (50, 3))
    corners = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, 8).T
    total = sum(
        call_glsl("nearness(c, b)", c=corner[None].astype(np.int32), b=beyond) for corner in corners
    )
    np.testing.assert_allclose(total, 1, rtol=1e-5)


# --- rays -------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [64, 192])
def test_directions_are_even(count: int) -> None:
    found = even_directions(count)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1)
    np.testing.assert_allclose(found.mean(axis=0), 0, atol=0.2 / count)
    np.testing.assert_allclose(found.T @ found / count, np.eye(3) / 3, atol=0.6 / count)
    nearest = np.sort(found @ found.T, axis=1)[:, -2]
    assert np.arccos(nearest).min() > 0.7 * np.sqrt(4 * np.pi / count)


def test_turns_are_rotations_that_hang_on_their_numbers() -> None:
    turns = np.array([turn(seeds(7, 2, n)) for n in range(4000)])
    np.testing.assert_allclose(
        turns @ turns.transpose(0, 2, 1), np.tile(np.eye(3), (4000, 1, 1)), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(turns), 1)
    assert np.abs(turns.mean(axis=0)).max() < 6 / np.sqrt(3 * 4000)  # each entry varies by 1/3
    np.testing.assert_allclose((turns**2).mean(axis=0), 1 / 3, atol=6 * 0.3 / np.sqrt(4000))
    assert len({turn(seeds(*key)).tobytes() for key in [(7, 2, 0), (7, 3, 0), (8, 2, 0)]}) == 3
