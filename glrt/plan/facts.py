"""Facts that follow from a scene alone: counts, lamps, glasses, and the BVHs of its shapes."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

from glrt.plan.particles import ParticleFacts, is_sampled
from glrt.scene.coincidence import Coincidence, coincidence_of
from glrt.scene.glasses import Around, around_camera, glasses_of
from glrt.scene.instancing import Apart, tree_sizes, with_own_tree
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import SKY_GROUP, SUN_GROUP, Finish, Scene
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import Radiance

TREE_FROM = 33  # bounded shapes: more than are baked, and there a tree pays (docs/results/speed.md)
SPHERES_FROM = 33  # spheres: from here on a tree of their own is faster
REST_FROM = 16  # other shapes beside a tree over spheres: from here on a second tree pays
MOST_NEAR = 32  # lamps that are weighed at each point; of more, so many clusters
SAMPLED = ("sphere", "quad", "disk", "mesh")  # kinds of lamps; others are found by scattering
MOST_LAMPS = 65_535  # that can be sampled: a triangle keeps the number of its light in 16 bits
ENDLESS = ("plane",)  # kinds of shapes without bounds
MESH = "mesh"  # the kind whose triangles rays always find by a tree


@dataclass(frozen=True)
class SceneFacts:
    """What follows from a scene, each fact derived once, when it is first used."""

    scene: Scene
    apart: Apart = "repeated"  # which meshes have a BVH of their own

    @cached_property
    def finishes(self) -> tuple[Finish, ...]:
        """Finishes of the visible surfaces, in the order of their materials."""
        return tuple(self.scene.finishes)

    @cached_property
    def materials(self) -> dict[str, Material]:
        """Materials that visible surfaces use, in the order of the scene file."""
        return {it.material: self.scene.materials[it.material] for it in self.finishes}

    @cached_property
    def shapes(self) -> dict[str, int]:
        """Number of visible shapes of each kind."""
        found = dict.fromkeys(KINDS, 0)
        for shape in self.scene.visible:
            found[shape.shape] += 1
        return found

    @cached_property
    def lamps(self) -> dict[str, int]:
        """Number of visible shapes of each kind whose emission can be sampled."""
        samples = {name: is_sampled(it) for name, it in self.scene.materials.items()}
        found = dict.fromkeys(KINDS, 0)
        for shape in self.scene.visible:
            found[shape.shape] += samples[shape.material]
        return found

    @cached_property
    def instances(self) -> tuple[int, ...]:
        """Numbers of the meshes with a BVH of their own."""
        return with_own_tree(self.scene.meshes, self.scene.materials, self.apart)

    @cached_property
    def _tree_sizes(self) -> tuple[int, list[int]]:
        return tree_sizes(self.scene.meshes, self.instances)

    @property
    def triangles(self) -> int:
        """Number of triangles in memory: meshes that share a BVH count once."""
        shared, own = self._tree_sizes
        return shared + sum(own)

    @property
    def largest_tree(self) -> int:
        """Number of triangles in the largest BVH."""
        shared, own = self._tree_sizes
        return max([shared, *own])

    @cached_property
    def bright_triangles(self) -> int:
        """Number of triangles that emit."""
        materials = self.scene.materials
        lit = (mesh for mesh in self.scene.meshes if is_sampled(materials[mesh.material]))
        return sum(len(mesh.triangles.faces) for mesh in lit)

    @property
    def is_smooth(self) -> bool:
        """Whether some mesh interpolates normals."""
        return any(mesh.smooth for mesh in self.scene.meshes)

    @cached_property
    def is_colored(self) -> bool:
        """Whether some mesh multiplies colours of its vertices with those of its material."""
        return any(has_vertex_colors(self.scene, mesh) for mesh in self.scene.meshes)

    @cached_property
    def emissions(self) -> dict[str, list[Radiance]]:
        """Emissions at intensity 1 of each light group with a lamp, of the sun, and of the sky.

        Lamps that are black count, so that the kernel stays the same when they shine.
        """
        found: dict[str, list[Radiance]] = {}
        for finish in self.finishes:
            material = self.scene.materials[finish.material]
            if finish.group and isinstance(material, Opaque):
                found.setdefault(finish.group, []).append(material.emission)
        if any(self.scene.sun_irradiance):
            found.setdefault(SUN_GROUP, []).append(self.scene.sun_irradiance)
        if any(map(any, self.scene.background.gradient)):
            found[SKY_GROUP] = list(self.scene.background.gradient)
        return found

    @cached_property
    def coincidence(self) -> Coincidence:
        """Lamps that share a place with other surfaces."""
        return coincidence_of(self.scene)

    @cached_property
    def glasses(self) -> dict[str, Dielectric]:
        """Glasses that are more than clear and smooth, by name; highest priority first."""
        return glasses_of(self.scene, self.finishes)

    @cached_property
    def camera_medium(self) -> Around:
        """The glass around the camera."""
        return around_camera(self.scene, self.glasses)

    @cached_property
    def particles(self) -> ParticleFacts:
        """Facts that particles from lamps need."""
        return ParticleFacts(self.scene, self.has_sphere_tree)

    @property
    def sampled_lamps(self) -> int:
        """How many lamps can be sampled."""
        return self._lamps_but_triangles + self.lamp_triangles

    @property
    def lamp_triangles(self) -> int:
        """How many triangles are sampled as lamps: of those that emit all, or none of too many."""
        is_room = self._lamps_but_triangles + self.bright_triangles <= MOST_LAMPS
        return self.bright_triangles if is_room else 0

    @property
    def sampled(self) -> tuple[str, ...]:
        """The kinds of lamps that are there and can be sampled."""
        kinds = [kind for kind in SAMPLED if self.lamps[kind]]
        return tuple(kind for kind in kinds if kind != MESH or self.lamp_triangles)

    @property
    def _lamps_but_triangles(self) -> int:
        return sum(self.lamps[kind] for kind in SAMPLED if kind != MESH)

    @property
    def instance_bits(self) -> int:
        """Bits of the number of a triangle within its tree; even, so that kernels do for others."""
        bits = max(self.largest_tree - 1, 1).bit_length()
        return bits + bits % 2 if self.instances else 0

    @property
    def has_sphere_tree(self) -> bool:
        """Whether rays are to find spheres by a tree of their own."""
        return self.shapes["sphere"] >= SPHERES_FROM

    @property
    def tree_kinds(self) -> tuple[str, ...]:
        """The kinds that rays are to find by the other tree, beside triangles; none without one."""
        kinds = [kind for kind in KINDS if kind not in (*ENDLESS, MESH) and self.shapes[kind]]
        if self.has_sphere_tree:
            kinds = [kind for kind in kinds if kind != "sphere"]
        least = REST_FROM if self.has_sphere_tree or self.shapes[MESH] else TREE_FROM
        return tuple(kinds) if self.count_of(kinds) >= least else ()

    @property
    def has_trees(self) -> bool:
        """Whether rays are to find some shapes by a tree."""
        return self.has_sphere_tree or bool(self.tree_kinds) or self.shapes[MESH] > 0

    def count_of(self, kinds: Iterable[str]) -> int:
        """How many shapes are of these kinds."""
        return sum(self.shapes[kind] for kind in kinds)

    @property
    def conductors(self) -> list[str]:
        """The metals whose reflectance depends on the angle."""
        return [n for n, it in self.materials.items() if isinstance(it, Metal) and it.conductor]

    @property
    def coated(self) -> list[str]:
        """The principled materials that have a coat."""
        own = {n: it for n, it in self.materials.items() if isinstance(it, Principled)}
        return [name for name, material in own.items() if material.clearcoat > 0]

    @property
    def mapped(self) -> set[str]:
        """The keys that are images in some material."""
        opaque = [it for it in self.materials.values() if isinstance(it, Opaque)]
        return {key for it in opaque for key in it.textures}

    @property
    def transmitting(self) -> list[str]:
        """The principled materials that are glass in part."""
        own = {n: it for n, it in self.materials.items() if isinstance(it, Principled)}
        return [name for name, it in own.items() if it.glass]

    @property
    def holed(self) -> list[str]:
        """The principled materials that light passes in part."""
        own = {n: it for n, it in self.materials.items() if isinstance(it, Principled)}
        return [name for name, it in own.items() if it.has_holes]

    @property
    def solid_glasses(self) -> list[str]:
        """The glasses that enclose a volume."""
        return self._glasses(lambda glass: not glass.thin)

    @property
    def rough_glasses(self) -> list[str]:
        """The glasses whose surface is rough."""
        return self._glasses(lambda glass: glass.alpha > 0)

    @property
    def panes(self) -> list[str]:
        """The glasses that are thin panes."""
        return self._glasses(lambda glass: glass.thin)

    @property
    def tinted(self) -> list[str]:
        """The glasses that absorb light."""
        return self._glasses(lambda glass: any(glass.absorption))

    @property
    def media(self) -> list[str]:
        """The glasses that have a priority over each other."""
        return self._glasses(lambda glass: glass.priority is not None)

    def _glasses(self, are: Callable[[Dielectric], bool]) -> list[str]:
        glasses = ((name, glass_of(material)) for name, material in self.materials.items())
        return [name for name, glass in glasses if glass and are(glass)]

    @property
    def cones(self) -> list[str]:
        """The materials of lamps whose emission has a cone."""
        lit = (finish.material for finish in self.finishes if finish.group)
        return [name for name in dict.fromkeys(lit) if getattr(self.materials[name], "cone", None)]

    @property
    def one_sided(self) -> list[str]:
        """The materials of lamps that emit from their front alone."""
        lit = (finish.material for finish in self.finishes if finish.is_one_sided)
        return list(dict.fromkeys(lit))

    @property
    def is_aimed(self) -> bool:
        """Whether some lamp cannot be seen from everywhere."""
        return bool(self.cones or self.one_sided)

    @property
    def has_many_lights(self) -> bool:
        """Whether there are more lamps than are weighed one by one."""
        return self.sampled_lamps > MOST_NEAR

    @property
    def clusters(self) -> int:
        """How many clusters of lamps are weighed at each point; of few lamps each is one."""
        return min(self.sampled_lamps, MOST_NEAR)


def has_vertex_colors(scene: Scene, mesh: Mesh) -> bool:
    """Whether colours of its vertices are seen: glass has none."""
    is_opaque = not scene.materials[mesh.material].is_transparent
    return is_opaque and mesh.triangles.colors is not None
