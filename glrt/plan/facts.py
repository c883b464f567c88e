"""What is in a scene, counted, and by which trees rays are to find its shapes."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from glrt.scene.instancing import Apart, tree_sizes, with_own_tree
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Finish, Scene
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.shapes.mesh import Mesh

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
    """What is in a scene, counted once for all that ask."""

    shapes: dict[str, int]  # how many of each kind
    materials: dict[str, Material]  # those that are used, in the order of the scene file
    finishes: tuple[Finish, ...]  # of what surfaces are, in the order of their materials
    lamps: dict[str, int]  # how many of each kind of shape emit
    triangles: int  # that are kept: once of meshes with a tree of their own
    bright_triangles: int  # of those that emit
    instances: tuple[int, ...]  # the meshes with a tree of their own, by number
    largest_tree: int  # triangles in one tree, at most
    is_smooth: bool  # whether some mesh interpolates normals
    is_colored: bool  # whether some mesh multiplies colours of its vertices with its material's

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


def facts_of(scene: Scene, apart: Apart = "repeated") -> SceneFacts:
    """Count what is in a scene; `apart` are the meshes with trees of their own."""
    shapes = dict.fromkeys(KINDS, 0)
    lamps = dict.fromkeys(KINDS, 0)
    samples = {name: is_sampled(material) for name, material in scene.materials.items()}
    for shape in scene.visible:
        shapes[shape.shape] += 1
        lamps[shape.shape] += samples[shape.material]
    meshes = scene.meshes
    instances = with_own_tree(meshes, scene.materials, apart)
    shared, own = tree_sizes(meshes, instances)
    finishes = tuple(scene.finishes)
    return SceneFacts(
        shapes,
        {finish.material: scene.materials[finish.material] for finish in finishes},
        finishes,
        lamps,
        triangles=shared + sum(own),
        bright_triangles=sum(
            len(mesh.triangles.faces) for mesh in meshes if samples[mesh.material]
        ),
        instances=instances,
        largest_tree=max([shared, *own]),
        is_smooth=any(mesh.smooth for mesh in meshes),
        is_colored=any(has_vertex_colors(scene, mesh) for mesh in meshes),
    )


def is_sampled(material: Material) -> bool:
    """Whether a lamp of this material can be sampled: not by an image, and not with holes."""
    if isinstance(material, Principled) and material.has_holes:
        return False
    return material.emits and not (isinstance(material, Opaque) and "emission" in material.textures)


def has_vertex_colors(scene: Scene, mesh: Mesh) -> bool:
    """Whether colours of its vertices are seen: glass has none."""
    is_opaque = not scene.materials[mesh.material].is_transparent
    return is_opaque and mesh.triangles.colors is not None
