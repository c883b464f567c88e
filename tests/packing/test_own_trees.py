"""BVHs of meshes that stand in several places, from one scene to the next."""

import numpy as np
import pytest

from glrt.packing.scene_tree import tree_of
from glrt.plan.facts import SceneFacts
from glrt.scene import instancing
from tests.support.builders import MATTE, scene_of
from tests.support.meshes import blob, icosphere, mesh

BLOB = blob(3)


@pytest.mark.parametrize("sizes", [(3, 1), (1, 3)], ids=["smaller", "larger"])
def test_trees_of_instances_stay_where_another_mesh_changes(
    sizes: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tree that follows another one is the tree that is built without it."""
    monkeypatch.setattr(instancing, "LEAST_SAVED", 1)
    scenes = (
        scene_of(
            [
                mesh(icosphere(size), "white"),
                *(mesh(BLOB, "white", translate=[x, 0, 0]) for x in (3.0, 6.0)),
            ],
            {"white": MATTE},
        )
        for size in sizes
    )
    before, now = map(SceneFacts, scenes)
    found, wanted = tree_of(now, tree_of(before)), tree_of(now)
    assert found
    assert wanted
    assert found.own.names == wanted.own.names
    for name in ("slots", "triangles"):
        assert np.array_equal(getattr(found.own, name), getattr(wanted.own, name)), name
    assert np.array_equal(found.shapes.wide.slots, wanted.shapes.wide.slots)
