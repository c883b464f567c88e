"""Cones of lamps: their share of the emission, against its definition and its integral."""

import math

import numpy as np
import pytest

from glrt.scene.lights.cone import Cone
from tests.support.numerics import directions

CASES = [(0, 45), (20, 30), (30, 30), (0, 180), (170, 180), (89, 91), (0.001, 0.01)]


@pytest.mark.parametrize(("inner", "outer"), CASES)
def test_the_share_falls_from_one_to_zero_between_the_half_angles(
    inner: float, outer: float
) -> None:
    cone = Cone(axis=(1, 2, -2), inner=inner, outer=outer)
    aside = np.array([2, 1, 2]) / 3
    angles = np.radians(np.linspace(0, 180, 721))
    towards = np.cos(angles)[:, None] * cone.unit_axis + np.sin(angles)[:, None] * aside
    shares = cone.shares(towards)
    assert (np.diff(shares) <= 0).all()
    assert (shares[angles < math.radians(inner) - 1e-9] == 1).all()
    assert (shares[angles > math.radians(outer) + 1e-9] == 0).all()
    middle = (math.cos(math.radians(inner)) + math.cos(math.radians(outer))) / 2
    if inner < outer and outer > 1:
        halfway = middle * cone.unit_axis + math.sqrt(1 - middle**2) * aside
        assert cone.shares(halfway[None]) == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize(("inner", "outer"), CASES)
def test_the_solid_angle_is_the_integral_of_the_share(inner: float, outer: float) -> None:
    cone = Cone(axis=(0, 0, 1), inner=inner, outer=outer)
    versine = (np.arange(100_000) + 0.5) / 100_000 * cone.versines[1]
    sine = np.sqrt(versine * (2 - versine))
    shares = cone.shares(np.stack([sine, 0 * sine, 1 - versine], axis=1))
    integral = 2 * math.pi * cone.versines[1] * shares.mean()
    assert cone.solid_angle == pytest.approx(integral, rel=1e-4)


def test_a_cone_of_all_directions_leaves_nothing_out() -> None:
    cone = Cone(axis=(0, 1, 0), inner=180, outer=180)
    assert cone.solid_angle == pytest.approx(4 * math.pi)
    assert (cone.shares(directions(1000).astype(np.float64)) == 1).sum() >= 1000
