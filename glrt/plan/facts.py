"""Facts that follow from a scene alone: counts, lamps, glasses, and the BVHs of its shapes."""

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass

from glrt.core.memo import computed_once
from glrt.plan.lobes import LobeFacts
from glrt.plan.media import MediaFacts
from glrt.plan.particles import ParticleFacts, is_sampled
from glrt.scene.coincidence import Coincidence, coincidence_of
from glrt.scene.glasses import Around, around_camera, glasses_of
from glrt.scene.instancing import Apart, tree_sizes, with_own_tree
from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP, Finish, media_group
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS, SAMPLED
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import Radiance

MOST_BAKED = 64  # shapes, planes and meshes included, that a kernel may have as constants
TREE_FROM = 33  # bounded shapes that a kernel reads: a BVH pays (docs/results/speed.md)
SPHERES_FROM = 33  # spheres: from here on a BVH of their own is faster
REST_FROM = 16  # other shapes, where spheres have a BVH; a multiple of it where meshes have one
MOST_NEAR = 32  # lamps weighed at each point; more are grouped into this many clusters
MOST_LAMPS = 65_535  # sampled lamps: a triangle stores the number of its light in 16 bits
ENDLESS = ("plane",)  # kinds of shapes without bounds
MESH = "mesh"  # the kind whose triangles rays always find through a BVH


@dataclass(frozen=True)
class SceneFacts:
    """Facts that follow from a scene, derived when they are first used."""

    scene: Scene
    apart: Apart = "repeated"  # which meshes have a BVH of their own

    @computed_once
    def finishes(self) -> tuple[Finish, ...]:
        """Finishes of the visible surfaces, in the order of their materials."""
        return tuple(self.scene.finishes)

    @computed_once
    def materials(self) -> dict[str, Material]:
        """Materials that visible surfaces use, in the order of the scene file."""
        return {it.material: self.scene.materials[it.material] for it in self.finishes}

    @computed_once
    def shapes(self) -> dict[str, int]:
        """Number of visible shapes of each kind."""
        found = dict.fromkeys(KINDS, 0)
        for shape in self.scene.visible:
            found[shape.shape] += 1
        return found

    @computed_once
    def lamps(self) -> dict[str, int]:
        """Number of visible shapes of each kind whose emission can be sampled."""
        samples = {name: is_sampled(it) for name, it in self.scene.materials.items()}
        found = dict.fromkeys(KINDS, 0)
        for shape in self.scene.visible:
            found[shape.shape] += samples[shape.material]
        return found

    @computed_once
    def instances(self) -> tuple[int, ...]:
        """Numbers of the visible meshes that have a BVH of their own."""
        return with_own_tree(self.scene.meshes, self.scene.materials, self.apart)

    @computed_once
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

    @computed_once
    def bright_triangles(self) -> int:
        """Number of triangles whose emission could be sampled."""
        materials = self.scene.materials
        lit = (mesh for mesh in self.scene.meshes if is_sampled(materials[mesh.material]))
        return sum(len(mesh.triangles.faces) for mesh in lit)

    @property
    def is_smooth(self) -> bool:
        """Whether some mesh interpolates normals."""
        return any(mesh.smooth for mesh in self.scene.meshes)

    @computed_once
    def is_colored(self) -> bool:
        """Whether some mesh multiplies the colour of its material by colours of its vertices."""
        return any(has_vertex_colors(self.scene, mesh) for mesh in self.scene.meshes)

    @computed_once
    def emissions(self) -> dict[str, list[Radiance]]:
        """Emissions at intensity 1 by light group: of its lamps, of the sun, and of the sky.

        Black lamps count too, so that the kernel stays the same when they start to shine.
        """
        found: dict[str, list[Radiance]] = {}
        for finish in self.finishes:
            material = self.scene.materials[finish.material]
            if finish.group and isinstance(material, Opaque):
                found.setdefault(finish.group, []).append(material.emission)
        for name, medium in self.scene.media.items():
            if medium.emits:
                found[media_group(name)] = list(medium.emissions)
        if any(self.scene.sun_irradiance):
            found.setdefault(SUN_GROUP, []).append(self.scene.sun_irradiance)
        if any(map(any, self.scene.background.gradient)):
            found[SKY_GROUP] = list(self.scene.background.gradient)
        return found

    @computed_once
    def coincidence(self) -> Coincidence:
        """Flat lamps that lie in the same place as other surfaces."""
        return coincidence_of(self.scene)

    @computed_once
    def glasses(self) -> dict[str, Dielectric]:
        """Glasses that are rough, tinted or have a priority, by name; highest priority first."""
        return glasses_of(self.scene, self.finishes)

    @computed_once
    def camera_glass(self) -> Around:
        """The glass around the camera."""
        return around_camera(self.scene, self.glasses)

    @computed_once
    def lobes(self) -> LobeFacts:
        """Facts about how the materials of visible surfaces scatter light."""
        return LobeFacts(self.materials)

    @computed_once
    def media(self) -> MediaFacts:
        """Facts about the media between surfaces."""
        return MediaFacts(self.scene)

    @computed_once
    def particles(self) -> ParticleFacts:
        """Facts that particles from lamps need."""
        return ParticleFacts(self.scene, self.has_sphere_tree)

    @property
    def sampled_lamps(self) -> int:
        """Number of lamps that are sampled; each triangle counts as one."""
        return self._lamps_but_triangles + self.lamp_triangles

    @property
    def lamp_triangles(self) -> int:
        """Number of triangles sampled as lamps: all bright ones, or none if too many."""
        is_room = self._lamps_but_triangles + self.bright_triangles <= MOST_LAMPS
        return self.bright_triangles if is_room else 0

    @property
    def sampled(self) -> tuple[str, ...]:
        """Kinds of lamps in the scene that are sampled."""
        kinds = [kind for kind in SAMPLED if self.lamps[kind]]
        return tuple(kind for kind in kinds if kind != MESH or self.lamp_triangles)

    @property
    def _lamps_but_triangles(self) -> int:
        return sum(self.lamps[kind] for kind in SAMPLED if kind != MESH)

    @property
    def instance_bits(self) -> int:
        """Bits for the number of a triangle within its BVH; 0 if no mesh has a BVH of its own.

        The number of bits is even, so that one kernel fits meshes of similar size.
        """
        bits = max(self.largest_tree - 1, 1).bit_length()
        return bits + bits % 2 if self.instances else 0

    @property
    def has_sphere_tree(self) -> bool:
        """Whether rays find spheres through a BVH of their own."""
        return self.shapes["sphere"] >= SPHERES_FROM

    @property
    def tree_kinds(self) -> tuple[str, ...]:
        """Kinds of shapes, meshes aside, in the BVH over shapes; empty if they stay outside it."""
        kinds = [kind for kind in KINDS if kind not in (*ENDLESS, MESH) and self.shapes[kind]]
        if self.has_sphere_tree:
            kinds = [kind for kind in kinds if kind != "sphere"]
        return tuple(kinds) if self.count_of(kinds) >= self.least_for_tree(kinds) else ()

    def least_for_tree(self, kinds: Collection[str]) -> int:
        """Return from how many shapes of these kinds on a BVH over them pays.

        Meshes have a BVH anyway. Each kind in it makes all its rounds slower, and keeps rays from
        afar from starting near the meshes.
        """
        if self.shapes[MESH]:
            return REST_FROM * (1 + len(kinds))
        return REST_FROM if self.has_sphere_tree else TREE_FROM

    @property
    def has_trees(self) -> bool:
        """Whether rays find some shapes through a BVH."""
        return self.has_sphere_tree or bool(self.tree_kinds) or self.shapes[MESH] > 0

    def count_of(self, kinds: Iterable[str]) -> int:
        """Return the number of visible shapes of these kinds."""
        return sum(self.shapes[kind] for kind in kinds)

    @property
    def mapped(self) -> set[str]:
        """Material keys that some visible material takes from a texture."""
        opaque = [it for it in self.materials.values() if isinstance(it, Opaque)]
        return {key for it in opaque for key in it.textures}

    @property
    def solid_glasses(self) -> list[str]:
        """Names of the glasses that enclose a volume."""
        return self._glasses(lambda glass: not glass.thin)

    @property
    def rough_glasses(self) -> list[str]:
        """Names of the rough glasses that enclose a volume."""
        return self._glasses(lambda glass: glass.alpha > 0 and not glass.thin)

    @property
    def rough_panes(self) -> list[str]:
        """Names of the rough glasses that are thin panes."""
        return self._glasses(lambda glass: glass.alpha > 0 and glass.thin)

    @property
    def panes(self) -> list[str]:
        """Names of the glasses that are thin panes."""
        return self._glasses(lambda glass: glass.thin)

    @property
    def tinted(self) -> list[str]:
        """Names of the glasses that absorb light."""
        return self._glasses(lambda glass: any(glass.absorption))

    @property
    def nested(self) -> list[str]:
        """Names of the glasses with a priority; none where it ranks volumes with media."""
        if self.media.is_ranked:
            return []
        return self._glasses(lambda glass: glass.priority is not None)

    def _glasses(self, are: Callable[[Dielectric], bool]) -> list[str]:
        glasses = ((name, glass_of(material)) for name, material in self.materials.items())
        return [name for name, glass in glasses if glass and are(glass)]

    @property
    def cones(self) -> list[str]:
        """Names of the lamp materials that emit into a cone of directions."""
        lit = (finish.material for finish in self.finishes if finish.group)
        return [name for name in dict.fromkeys(lit) if getattr(self.materials[name], "cone", None)]

    @property
    def one_sided(self) -> list[str]:
        """Names of the lamp materials that emit from their front alone on some object."""
        lit = (finish.material for finish in self.finishes if finish.is_one_sided)
        return list(dict.fromkeys(lit))

    @property
    def is_aimed(self) -> bool:
        """Whether some lamp cannot be seen from everywhere: it has a cone or one side."""
        return bool(self.cones or self.one_sided)

    @property
    def has_many_lights(self) -> bool:
        """Whether there are too many lamps to weigh one by one."""
        return self.sampled_lamps > MOST_NEAR

    @property
    def clusters(self) -> int:
        """Number of lamp clusters weighed at each point; with few lamps, each lamp is a cluster."""
        return min(self.sampled_lamps, MOST_NEAR)


def has_vertex_colors(scene: Scene, mesh: Mesh) -> bool:
    """Return whether a mesh shows colours of its vertices; glass does not."""
    is_opaque = not scene.materials[mesh.material].is_transparent
    return is_opaque and mesh.triangles.colors is not None
