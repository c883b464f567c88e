"""Scene -> the arrays of the kernel's blocks, keyed by block name.

Positions are taken relative to the camera in float64: far from the origin nothing is lost.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.sphere_nodes import pack_nodes
from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants, read_structs, record
from glrt.methods.features import has_tree, is_light, used_materials
from glrt.methods.light_layers import layer_of_group
from glrt.rendering.pack_lights import lamps_of, pack_clusters, pack_lights
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes import Plane, Quad, Shape, Sphere
from glrt.settings import Settings, settings_for

Array = np.ndarray[Any, Any]

_TEXT = read("scene.glsl")
STRUCTS = read_structs(_TEXT)
CONSTANTS = read_constants(_TEXT)


class Shapes(NamedTuple):
    """The objects by kind; the kernel numbers them through in this order."""

    spheres: list[Sphere]
    planes: list[Plane]
    quads: list[Quad]

    def in_order(self) -> list[Shape]:
        """All shapes; the place in the list is the kernel's number."""
        return [*self.spheres, *self.planes, *self.quads]


def shapes_of(scene: Scene) -> Shapes:
    """Sort the objects by kind, keeping the order of the scene file within each."""
    return Shapes(
        [s for s in scene.objects if isinstance(s, Sphere)],
        [s for s in scene.objects if isinstance(s, Plane)],
        [s for s in scene.objects if isinstance(s, Quad)],
    )


def pack_scene(scene: Scene, known: Array | None = None) -> dict[str, Array]:
    """Arrays for the storage blocks of the kernel, keyed by block name.

    `known` are the nodes of a scene with the same objects: a tree is not built again.
    """
    shapes = shapes_of(scene)
    eye = np.array(scene.camera.position, np.float64)
    names = {name: index for index, name in enumerate(used_materials(scene))}
    lamps = lamps_of(scene, shapes.in_order())
    light_of = {shape: light for light, shape in enumerate(lamps.shapes)}
    spheres = _pack_spheres(shapes.spheres, eye, names, light_of)
    return {
        "Spheres": spheres,
        "Planes": _pack_planes(shapes.planes, eye, names),
        "Quads": _pack_quads(
            shapes.quads, eye, names, light_of, len(shapes.spheres) + len(shapes.planes)
        ),
        "Nodes": pack_nodes(spheres if has_tree(scene) else spheres[:0], STRUCTS["Node"], known),
        "Materials": _pack_materials(scene),
        "Lights": pack_lights(lamps, STRUCTS["Light"]),
        "Clusters": pack_clusters(lamps, eye, STRUCTS["Cluster"]),
    }


def scene_blocks(scene: Scene | None = None) -> dict[str, bytes]:
    """The content of the blocks that path text reads; zeros without a scene.

    A driver may want a buffer for a block that nothing reads.
    """
    if not scene:
        blocks = {"Spheres": "Sphere", "Planes": "Plane", "Quads": "Quad", "Lights": "Light"}
        blocks |= {
            "Clusters": "Cluster",
            "Materials": "Material",
            "Nodes": "Node",
            "FrameBlock": "Frame",
        }
        return {name: bytes(STRUCTS[row].itemsize) for name, row in blocks.items()}
    arrays = pack_scene(scene)
    counts = {name: len(rows) for name, rows in arrays.items()}
    frame = pack_frame(scene, settings_for(scene.render), counts, 0, 1)
    data = {name: rows.tobytes() or bytes(rows.itemsize) for name, rows in arrays.items()}
    return {**data, "FrameBlock": frame}


def pack_camera(camera: Camera, aspect: float) -> dict[str, object]:
    """The fields of the struct Camera; `aspect` is width over height of the full frame."""
    forward = _unit(_vector(camera.look_at) - _vector(camera.position))
    right = _unit(np.cross(forward, _vector(camera.up)))
    tan_y = math.tan(math.radians(camera.fov) / 2)
    tan_lens = math.tan(math.radians(camera.defocus_angle) / 2)
    return {
        "right": right,
        "tan_x": tan_y * aspect,
        "up": np.cross(right, forward),
        "tan_y": tan_y,
        "forward": forward,
        "lens_radius": tan_lens * camera.resolved_focus_distance,
        "tan_lens": tan_lens,
    }


def pack_frame(
    scene: Scene,
    settings: Settings,
    counts: Mapping[str, int],
    first_sample: int,
    samples: int,
    first_tile: int = 0,
    tile_stride: int = 1,
) -> bytes:
    """The bytes of the uniform block: one dispatch of `samples` samples from `first_sample` on.

    `counts` are the rows of each storage block; for tiles and their stride see trace.comp.
    """
    bottom, top = scene.background_colors
    frame = {
        "camera": pack_camera(scene.camera, settings.width / settings.height),
        "background_bottom": bottom,
        "bounces": settings.bounces,
        "background_top": top,
        "seed": settings.seed,
        "size": (settings.width, settings.height),
        "origin": settings.crop[:2] if settings.crop else (0, 0),
        "first_sample": first_sample,
        "sample_count": samples,
        "sphere_count": counts["Spheres"],
        "plane_count": counts["Planes"],
        "quad_count": counts["Quads"],
        "light_count": counts["Lights"],
        "first_tile": first_tile,
        "tile_stride": tile_stride,
        "node_count": counts["Nodes"],
    }
    return record(STRUCTS["Frame"], frame).tobytes()


def _pack_spheres(
    spheres: list[Sphere], eye: Array, names: dict[str, int], light_of: dict[int, int]
) -> Array:
    rows = np.zeros(len(spheres), STRUCTS["Sphere"])
    if spheres:
        rows["center"] = np.array([s.center for s in spheres], np.float64) - eye
        rows["radius"] = [s.radius for s in spheres]
        rows["material"] = [names[s.material] for s in spheres]
        rows["light"] = [light_of.get(i, CONSTANTS["NO_LIGHT"]) for i in range(len(spheres))]
    return rows


def _pack_planes(planes: list[Plane], eye: Array, names: dict[str, int]) -> Array:
    rows = np.zeros(len(planes), STRUCTS["Plane"])
    for row, plane in zip(rows, planes, strict=True):
        normal = _unit(_vector(plane.normal))
        row["point"] = normal * np.dot(normal, _vector(plane.point) - eye)  # nearest to the eye
        row["normal"] = normal
        row["material"] = names[plane.material]
    return rows


def _pack_quads(
    quads: list[Quad], eye: Array, names: dict[str, int], light_of: dict[int, int], first: int
) -> Array:
    rows = np.zeros(len(quads), STRUCTS["Quad"])
    for index, (row, quad) in enumerate(zip(rows, quads, strict=True)):
        normal = np.cross(_vector(quad.edge_u), _vector(quad.edge_v))
        area = np.linalg.norm(normal)
        u, v = sorted((_vector(quad.edge_u), _vector(quad.edge_v)), key=np.linalg.norm)
        length = np.linalg.norm(v)
        row["corner"], row["edge_u"], row["edge_v"] = _vector(quad.corner) - eye, u, v
        row["normal"], row["height"] = normal / area, length
        row["width"], row["shear"] = area / length, np.dot(u, v) / length
        row["dual_u"] = np.cross(v, np.cross(u, v)) / area**2
        row["dual_v"] = np.cross(np.cross(u, v), u) / area**2
        row["material"] = names[quad.material]
        row["light"] = light_of.get(first + index, CONSTANTS["NO_LIGHT"])
    return rows


def _pack_materials(scene: Scene) -> Array:
    kinds = {"metal": "METAL", "dielectric": "DIELECTRIC"}
    used, layers = used_materials(scene), layer_of_group(scene)
    rows = np.zeros(len(used), STRUCTS["Material"])
    for row, (name, material) in zip(rows, used.items(), strict=True):
        row["kind"] = CONSTANTS[kinds.get(material.type, "MATTE")]
        row["color"] = getattr(material, "color", 0.0)
        row["alpha"] = getattr(material, "alpha", 0.0)
        row["ior"] = getattr(material, "ior", 1.0)
        row["layer"] = layers.get(getattr(material, "group", None) or name, 0)
        row["emission"] = scene.emission(name) if is_light(material) else 0.0
    return rows


def _vector(value: Sequence[float]) -> Array:
    return np.array(value, np.float64)


def _unit(value: Array) -> Array:
    unit: Array = value / np.linalg.norm(value)
    return unit
