"""The reasons of features: how shapes are found, and where no BVH is used."""

import pytest

from glrt.plan.explanation import explain
from glrt.plan.facts import MOST_BAKED, TREE_FROM
from glrt.plan.plan import prepare
from glrt.settings import Settings
from tests.support.builders import MATTE, quad, scene_of, sphere

ALONE = f"glrt render tries up to {MOST_BAKED} shapes one by one"


def reason_of(name: str, quads: int = 0, spheres: int = 0) -> str:
    """Why the kernel of a scene of quads and spheres has a feature."""
    things = [quad([k, 0, -9], [0.5, 0, 0], [0, 0.5, 0], "matte") for k in range(quads)]
    things += [sphere([k, 2, -9], 0.4, "matte") for k in range(spheres)]
    (found,) = (
        feature
        for feature in explain(prepare(scene_of(things, {"matte": MATTE}), Settings()))
        if feature.name == name
    )
    return found.reason


@pytest.mark.parametrize(
    ("quads", "reason"),
    [
        (TREE_FROM - 1, f"{TREE_FROM - 1} bounded shapes; it pays from {TREE_FROM} on"),
        (TREE_FROM, f"over {TREE_FROM} quads; in the window: {ALONE}"),
        (MOST_BAKED, f"over {MOST_BAKED} quads; in the window: {ALONE}"),
        (MOST_BAKED + 1, f"over {MOST_BAKED + 1} quads"),
    ],
)
def test_the_tree_of_shapes_says_where_it_is_used(quads: int, reason: str) -> None:
    assert reason_of("tree of shapes", quads=quads) == reason


@pytest.mark.parametrize(("spheres", "is_alone"), [(MOST_BAKED, True), (MOST_BAKED + 1, False)])
def test_the_tree_of_spheres_says_where_it_is_used(spheres: int, is_alone: bool) -> None:
    assert (ALONE in reason_of("tree of spheres", spheres=spheres)) == is_alone
