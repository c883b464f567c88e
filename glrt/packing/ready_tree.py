"""The BVH of a scene that was built before a renderer asks for it, as by another thread."""

from typing import Any

from glrt.packing.scene_tree import SceneTree, tree_of
from glrt.plan.facts import SceneFacts
from glrt.scene.instancing import Apart
from glrt.scene.scene import Scene

_ready: list[tuple[Any, Apart, SceneTree | None]] = []  # one at most, with the objects it is of


def build_ahead(scene: Scene, apart: Apart) -> SceneTree | None:
    """Build the BVH of a scene for the next renderer of its objects, and return it.

    The one that was built ahead before is dropped.
    """
    tree = tree_of(SceneFacts(scene, apart))
    _ready[:] = [(scene.objects, apart, tree)]
    return tree


def ready_or_new(facts: SceneFacts, before: SceneTree | None) -> SceneTree | None:
    """Return the BVH that was built ahead for these very objects, once; else that of `tree_of`."""
    for objects, apart, tree in _ready:
        if objects is facts.scene.objects and apart == facts.apart:
            _ready.clear()
            return tree
    return tree_of(facts, before)
