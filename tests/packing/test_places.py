"""Where the camera stands is in one field of each kind of shape, and in no other."""

from typing import Any

import pytest

from glrt.gpu.struct_arrays import MOST_UNIFORM_BYTES
from glrt.packing.scene_arrays import pack_scene
from glrt.packing.shapes import NUMBERED, PLACES
from glrt.plan.facts import SceneFacts
from glrt.rendering.pipelines import Tier, text_of
from tests.support.builders import MATTE, box, cylinder, disk, plane, quad, scene_of, sphere

pytestmark = pytest.mark.usefixtures("exact_kernels")  # shared ones have no shapes written in

SHAPES = [
    sphere([0, 0, 0], 1, "white"),
    plane([0.3, -1, 0], [0.2, 1, 0.1], "white"),
    quad([-2, 2, -2], [4, 1, 0], [0, 0, 2], "white"),
    disk([2, 0, 1], [1, 1, 0], 0.5, "white"),
    box([3, 3, 3], [4, 5, 6], "white", rotate=(10, 20, 30)),
    cylinder([-3, 0, 0], [-2, 1, 1], 0.4, "white"),
]


def packed(shapes: list[dict[str, Any]] = SHAPES, eye: Any = (0, 0, 9)) -> dict[str, Any]:
    camera = {"position": list(eye), "look_at": [0, 0, 0]}
    return pack_scene(SceneFacts(scene_of(shapes, {"white": MATTE}, camera)), None)


def test_another_eye_changes_the_place_of_each_kind_alone() -> None:
    before, after = packed(), packed(eye=(0.7, -0.3, 7.5))
    changed = {
        (struct, field)
        for struct in NUMBERED
        for field in before[struct].dtype.names
        if before[struct][field].tobytes() != after[struct][field].tobytes()
    }
    assert changed == set(PLACES.items())


@pytest.mark.parametrize(
    ("number", "change", "tiers"),
    [
        (0, {"center": [0, 0, 0]}, ["placed", "baked"]),
        (0, {"center": [0, 1, 0]}, ["placed"]),
        (1, {"point": [0.3, -2, 0]}, ["placed"]),
        (2, {"corner": [-2, 1, -2]}, ["placed"]),
        (3, {"center": [2, 1, 1]}, ["placed"]),
        (4, {"min": [3, 4, 3], "max": [4, 6, 6]}, ["placed"]),
        (0, {"radius": 1.5}, []),
        (2, {"edge_u": [4, 0, 0]}, []),
        (4, {"rotate": [10, 20, 31]}, []),
        (5, {"to": [-2, 1, 2]}, []),
    ],
)
def test_a_kernel_that_reads_places_serves_shapes_that_are_shifted(
    number: int, change: dict[str, Any], tiers: list[Tier]
) -> None:
    after = [shape | change if at == number else shape for at, shape in enumerate(SHAPES)]
    fast: tuple[Tier, ...] = "placed", "baked"
    assert [tier for tier in fast if written(SHAPES, tier) == written(after, tier)] == tiers


def written(shapes: list[dict[str, Any]], tier: Tier) -> str:
    return text_of(packed(shapes), tier, MOST_UNIFORM_BYTES)
