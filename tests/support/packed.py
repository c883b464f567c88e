"""The arrays of a scene for the kernel, for tests that look at single rows."""

from typing import Any

import numpy as np

from glrt.packing.scene_arrays import pack_scene
from glrt.packing.scene_tree import tree_of
from glrt.plan.facts import SceneFacts
from glrt.scene.scene import Scene


def packed(scene: Scene) -> dict[str, np.ndarray[Any, Any]]:
    """Arrays keyed by the name of their struct, with the BVH that the scene needs."""
    facts = SceneFacts(scene)
    return pack_scene(facts, tree_of(facts))
