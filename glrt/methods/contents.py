"""What is in a scene, counted, and by which trees rays are to find its shapes."""

from collections.abc import Iterable
from dataclasses import dataclass

from glrt.scene.materials import Material
from glrt.scene.scene import Scene
from glrt.scene.shapes import KINDS

TREE_FROM = 33  # bounded shapes: more than are baked, and there a tree pays (docs/results/speed.md)
SPHERES_FROM = 33  # spheres: from here on a tree of their own is faster
REST_FROM = 16  # other shapes beside a tree over spheres: from here on a second tree pays
MOST_NEAR = 32  # lamps that are weighed at each point; of more, so many clusters
SAMPLED = ("sphere", "quad", "disk")  # kinds of lamps; others are found by scattering
ENDLESS = ("plane",)  # kinds of shapes without bounds


@dataclass(frozen=True)
class Contents:
    """What is in a scene, counted once for all that ask."""

    shapes: dict[str, int]  # how many of each kind
    materials: dict[str, Material]  # those that are used, in the order of the scene file
    lamps: dict[str, int]  # how many of each kind of shape emit

    @property
    def sampled_lamps(self) -> int:
        """How many lamps can be sampled."""
        return sum(self.lamps[kind] for kind in SAMPLED)

    @property
    def has_sphere_tree(self) -> bool:
        """Whether rays are to find spheres by a tree of their own."""
        return self.shapes["sphere"] >= SPHERES_FROM

    @property
    def tree_kinds(self) -> tuple[str, ...]:
        """The kinds of shapes that rays are to find by the other tree; none without one."""
        kinds = [kind for kind in KINDS if kind not in ENDLESS and self.shapes[kind]]
        if self.has_sphere_tree:
            kinds = [kind for kind in kinds if kind != "sphere"]
        least = REST_FROM if self.has_sphere_tree else TREE_FROM
        return tuple(kinds) if self.count_of(kinds) >= least else ()

    @property
    def has_trees(self) -> bool:
        """Whether rays are to find some shapes by a tree."""
        return self.has_sphere_tree or bool(self.tree_kinds)

    def count_of(self, kinds: Iterable[str]) -> int:
        """How many shapes are of these kinds."""
        return sum(self.shapes[kind] for kind in kinds)

    @property
    def has_many_lights(self) -> bool:
        """Whether there are more lamps than are weighed one by one."""
        return self.sampled_lamps > MOST_NEAR

    @property
    def clusters(self) -> int:
        """How many clusters of lamps are weighed at each point; of few lamps each is one."""
        return min(self.sampled_lamps, MOST_NEAR)


def contents_of(scene: Scene) -> Contents:
    """Count what is in a scene."""
    shapes = dict.fromkeys(KINDS, 0)
    lamps = dict.fromkeys(KINDS, 0)
    for shape in scene.objects:
        shapes[shape.shape] += 1
        lamps[shape.shape] += is_light(scene.materials[shape.material])
    return Contents(shapes, used_materials(scene), lamps)


def is_light(material: Material) -> bool:
    """Whether a material emits."""
    return material.type == "light"


def used_materials(scene: Scene) -> dict[str, Material]:
    """The materials that some object is made of, in the order of the scene file."""
    names = {shape.material for shape in scene.objects}
    return {name: material for name, material in scene.materials.items() if name in names}
