"""Shapes as rows of the kernel's arrays: a packer for each kind, in the kernel's order.

Positions are made relative to the camera in float64, so that no digits are lost far from the
origin. docs/extending.md explains how to add a kind.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.scene.lit_scene import Finish
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

Array = np.ndarray[Any, Any]


class Placing(NamedTuple):
    """Data that a packer needs in addition to its shapes."""

    eye: Array  # position of the camera, float64
    scene: Scene
    finishes: Mapping[Finish, int]  # row of each finish in the array of the struct Material
    lights: Mapping[int, int]  # row of each sampled lamp, by the kernel's number of its shape

    def material(self, thing: Shape) -> int:
        """Return the row of an object's material."""
        return self.finishes[self.scene.finish(thing)]

    def light(self, number: int) -> int:
        """Return the row of a lamp; NO_LIGHT if the shape is not sampled."""
        return self.lights.get(number, CONSTANTS["NO_LIGHT"])


def pack_spheres(rows: Array, spheres: Sequence[Sphere], placing: Placing, first: int) -> None:
    """Fill rows of the struct Sphere; `first` is the kernel's number of the first."""
    rows["center"] = np.array([s.center for s in spheres], np.float64) - placing.eye
    rows["radius"] = [s.radius for s in spheres]
    rows["material"] = [placing.material(s) for s in spheres]
    rows["light"] = [placing.light(first + i) for i in range(len(spheres))]


def pack_planes(rows: Array, planes: Sequence[Plane], placing: Placing, first: int) -> None:
    """Fill rows of the struct Plane."""
    del first  # planes are no sampled lamps
    for row, plane in zip(rows, planes, strict=True):
        normal = unit(np.array(plane.normal, np.float64))
        offset = np.dot(normal, np.array(plane.point, np.float64) - placing.eye)
        row["point"] = normal * offset  # nearest to the eye
        row["normal"] = normal
        row["material"] = placing.material(plane)


def pack_quads(rows: Array, quads: Sequence[Quad], placing: Placing, first: int) -> None:
    """Fill rows of the struct Quad."""
    for index, (row, quad) in enumerate(zip(rows, quads, strict=True)):
        edges = np.array(quad.edge_u, np.float64), np.array(quad.edge_v, np.float64)
        normal = np.cross(*edges)
        area = np.linalg.norm(normal)
        u, v = sorted(edges, key=np.linalg.norm)
        length = np.linalg.norm(v)
        row["corner"] = np.array(quad.corner, np.float64) - placing.eye
        row["edge_u"], row["edge_v"] = u, v
        row["normal"], row["height"] = normal / area, length
        row["width"], row["shear"] = area / length, np.dot(u, v) / length
        row["dual_u"] = np.cross(v, np.cross(u, v)) / area**2
        row["dual_v"] = np.cross(np.cross(u, v), u) / area**2
        row["material"] = placing.material(quad)
        row["light"] = placing.light(first + index)


def pack_disks(rows: Array, disks: Sequence[Disk], placing: Placing, first: int) -> None:
    """Fill rows of the struct Disk."""
    for index, (row, disk) in enumerate(zip(rows, disks, strict=True)):
        row["center"] = np.array(disk.center, np.float64) - placing.eye
        row["normal"] = unit(np.array(disk.normal, np.float64))
        row["radius"] = disk.radius
        row["material"] = placing.material(disk)
        row["light"] = placing.light(first + index)


def pack_boxes(rows: Array, boxes: Sequence[Box], placing: Placing, first: int) -> None:
    """Fill rows of the struct Box."""
    del first  # boxes are no sampled lamps
    for row, box in zip(rows, boxes, strict=True):
        row["center"] = np.array(box.middle, np.float64) - placing.eye
        for name, axis, half in zip("xyz", box.axes, box.halves, strict=True):
            row[f"axis_{name}"], row[f"half_{name}"] = axis, half
        row["material"] = placing.material(box)


def pack_cylinders(
    rows: Array, cylinders: Sequence[Cylinder], placing: Placing, first: int
) -> None:
    """Fill rows of the struct Cylinder."""
    del first  # cylinders are no sampled lamps
    for row, cylinder in zip(rows, cylinders, strict=True):
        row["center"] = np.array(cylinder.middle, np.float64) - placing.eye
        row["axis"], row["radius"] = cylinder.axis, cylinder.radius
        row["half_height"], row["is_capped"] = cylinder.half, cylinder.capped
        row["material"] = placing.material(cylinder)


def pack_meshes(rows: Array, meshes: Sequence[Mesh], placing: Placing, first: int) -> None:
    """Fill rows of the struct Mesh; glrt/packing/triangles.py packs the triangles."""
    del first  # meshes are no sampled lamps
    rows["material"] = [placing.material(mesh) for mesh in meshes]
    rows["is_smooth"] = [bool(mesh.smooth) for mesh in meshes]


def unit(value: Array) -> Array:
    """Return a vector of length 1 along another one."""
    along: Array = value / np.linalg.norm(value)
    return along


# Each model has the name of its struct.
PACKERS: dict[type, Callable[[Array, Any, Placing, int], None]] = {
    Sphere: pack_spheres,
    Plane: pack_planes,
    Quad: pack_quads,
    Disk: pack_disks,
    Box: pack_boxes,
    Cylinder: pack_cylinders,
    Mesh: pack_meshes,
}
NUMBERED = tuple(kind.__name__ for kind in PACKERS)  # structs, in the order of the numbering

# The one field of each struct that depends on the place of the eye.
PLACES = {
    "Sphere": "center",
    "Plane": "point",
    "Quad": "corner",
    "Disk": "center",
    "Box": "center",
    "Cylinder": "center",
}

UNSET = np.iinfo(np.int32).min  # in a field of a row that its packer must fill


def check_packers(packers: Collection[type], kinds: Collection[type]) -> None:
    """Raise TypeError unless each model has a packer, in their order, and a field of its place."""
    if without := [kind.__name__ for kind in kinds if kind not in packers]:
        raise TypeError(f"shapes without a packer: {', '.join(without)}; add them to PACKERS")
    if list(packers) != list(kinds):
        raise TypeError("PACKERS has another order than Shape in glrt/scene/shapes/kinds.py")
    names = [kind.__name__ for kind in kinds if kind is not Mesh]  # triangles lie in a texture
    if without := [name for name in names if name not in PLACES]:
        raise TypeError(f"shapes without a place: {', '.join(without)}; add them to PLACES")


check_packers(PACKERS, KINDS.values())


def order_of_kernel(scene: Scene) -> list[int]:
    """Return the places of the visible objects in the scene, by kind, each kind as in the file."""
    return [n for kind in PACKERS for n in scene.shown if type(scene.objects[n]) is kind]


def in_order(scene: Scene) -> list[Shape]:
    """Return the visible objects in the kernel's order."""
    return [scene.objects[number] for number in order_of_kernel(scene)]


def pack_shapes(shapes: Sequence[Shape], placing: Placing) -> dict[str, Array]:
    """Return the rows of each kind by the name of its struct; `shapes` are in kernel order."""
    arrays, first = {}, 0
    for kind, pack in PACKERS.items():
        some = [shape for shape in shapes if type(shape) is kind]
        rows = np.zeros(len(some), STRUCTS[kind.__name__])
        if some:
            owed = [name for name in ("material", "light") if name in (rows.dtype.names or ())]
            for name in owed:
                rows[name] = UNSET
            pack(rows, some, placing, first)
            for name in owed:
                if (rows[name] == UNSET).any():
                    raise TypeError(f"{pack.__name__} leaves `{name}` unset")
        arrays[kind.__name__] = rows
        first += len(some)
    return arrays
