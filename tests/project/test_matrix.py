"""A share of the matrix of docs/results/platforms.md: route by pipeline by scene."""

import shutil
from ctypes.util import find_library
from typing import Any

import numpy as np
import pytest

from tests.project.matrix import WAYS, Way, difference, drawn
from tests.support.system_packages import needs_osmesa, needs_package

SHARE = ["lens", "methods/glass"]


@pytest.fixture(scope="module")
def first() -> dict[str, Any]:
    needs_package(bool(find_library("EGL")), "libegl1")
    return drawn(WAYS[0], SHARE)


@pytest.mark.slow
@pytest.mark.slow_cases("way0")
@pytest.mark.parametrize(
    "way", [Way("osmesa", "fragment"), Way("window", "fragment", "OpenGL 4.1")]
)
def test_every_way_draws_the_same_bits(first: dict[str, Any], way: Way) -> None:
    """This holds on software drivers; elsewhere differences are far below the noise."""
    if way.route == "osmesa":
        needs_osmesa()
    else:
        needs_package(bool(shutil.which("Xvfb")), "xvfb")
    found = drawn(way, SHARE)
    is_software = all("llvmpipe" in str(made["renderer"]) for made in (first, found))
    for name in SHARE:
        told = difference(name, found, first)
        assert told == "=" if is_software else float(told) < 0.01


@pytest.mark.slow
def test_another_driver_draws_the_same_picture() -> None:
    """The noise is the same: paths part only where a rounding decides."""
    needs_package(bool(find_library("EGL")), "libegl1")
    first, *others = (drawn(way, SHARE) for way in (WAYS[0], *WAYS[-2:]))
    are_others = all("zink" in str(found["renderer"]) for found in others)
    needs_package(are_others, "mesa-vulkan-drivers, and zink in libgl1-mesa-dri")
    for name in SHARE:
        compute, fragment = (difference(name, found, first) for found in others)
        assert compute == "=" or float(compute) < 1e-4
        assert compute == fragment
        assert difference(name, others[1], others[0]) == "="


def test_a_difference_is_reported_by_its_size() -> None:
    first = {f"a {seed}": np.full((2, 4, 5, 3), seed, np.float32) for seed in (0, 1)}
    other = {"a 0": first["a 0"].copy()}
    assert difference("a", other, first) == "="
    other["a 0"][0, 0, 0] = 0.1
    assert difference("a", other, first) == "2.2e-02"
    other["a 0"][:] = -0.0
    assert difference("a", other, first) == "0.0e+00"
