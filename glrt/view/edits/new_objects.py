"""Objects that a user adds: shapes of each kind at a place and of a size, and models."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.scene.files.assets import AssetFolder
from glrt.scene.files.path_text import text_of
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.model_scene import model_scene
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.values import Vector
from glrt.view.controls import made, replaced
from glrt.view.edits.scene_edits import free_name, with_added

LAMP = "lamp"  # kind that stands for a lamp
Array = NDArray[np.float64]
_SIDEWAYS, _NEARER = 0.7, 0.4  # of a new lamp, for each unit of height
MATTE = Lambertian(color=(0.7, 0.7, 0.7))
BRIGHT = Light(emission=(10.0, 10.0, 10.0))
ADDED = (*(kind for kind, model in KINDS.items() if model.example(np.zeros(3), 1.0)), LAMP)


def with_new_near(scene: Scene, kind: str, pivot: Vector, size: float) -> Scene:
    """Return the scene with a new object at the pivot, or outside of objects that contain it.

    Objects that contain the camera, too, are rooms. On the others a new object is put on top; a
    lamp hangs above, to the left of the camera's view, and faces the pivot. A plane goes to the
    pivot.
    """
    eye = np.array(scene.camera.position)
    boxes = [box for shape in scene.visible if (box := _box_of(shape)) and _is_in(box, pivot)]
    solids = [box for box in boxes if not _is_in(box, eye)]
    if not solids or kind == "plane":
        return with_new(scene, kind, pivot, size)
    low = np.min([box[0] for box in solids], axis=0)
    high = np.max([box[1] for box in solids], axis=0)
    place = np.array([pivot[0], high[1] + size / 2, pivot[2]])
    if kind != LAMP:
        return with_new(scene, kind, _vector(place), size)
    away = _unit((eye - np.array(pivot)) * (1, 0, 1))
    aside = np.cross(away, (0.0, 1.0, 0.0))  # to the left, seen from the camera
    way = _unit(np.array([0.0, 1.0, 0.0]) + _SIDEWAYS * aside + _NEARER * away)
    reach = float(np.linalg.norm(high - low)) / 2
    hung = (low + high) / 2 + (reach + size) * way
    return with_new(scene, kind, _vector(hung), size, pivot)


def with_new(
    scene: Scene, kind: str, place: Vector, size: float, faced: Vector | None = None
) -> Scene:
    """Return the scene with a new object and its own material, both named after the kind.

    A lamp is a square that faces down, or a place that is `faced`. Lengths are in scene units.
    """
    size = two_digits(size)
    middle = np.array([near(part, size) for part in place])
    is_lamp = kind == LAMP
    model = KINDS["quad" if is_lamp else kind]
    fields = model.example(middle, size)
    if is_lamp:  # edges in the other order, so that it faces down
        fields["edge_u"], fields["edge_v"] = fields["edge_v"], fields["edge_u"]
        if faced:
            fields |= _square(middle, np.array(faced), float(np.linalg.norm(fields["edge_u"])))
    names = {thing.name for thing in scene.objects if thing.name}
    groups = [*scene.materials, *scene.light_groups]  # so that a lamp gets its own group
    parts = {"material": free_name(kind, groups), "name": free_name(kind, names)}
    shape: Shape = made(model, {**_fields(fields), **parts})
    return with_added(scene, shape, BRIGHT if is_lamp else MATTE)


def _square(middle: Array, faced: Array, side: float) -> dict[str, Array]:
    """Return the fields of a square quad whose normal points to a place."""
    normal = (faced - middle) / np.linalg.norm(faced - middle)
    across = np.cross((0.0, 1.0, 0.0), normal)
    if np.linalg.norm(across) < 1e-6:
        across = np.array([1.0, 0.0, 0.0])
    edge_u = side * across / np.linalg.norm(across)
    edge_v = np.cross(normal, edge_u)
    return {"corner": middle - (edge_u + edge_v) / 2, "edge_u": edge_u, "edge_v": edge_v}


def _box_of(shape: Shape) -> tuple[Array, Array] | None:
    """Return low and high corner of the box around a shape; None if it has no end."""
    if not math.isfinite(shape.reach):
        return None
    if isinstance(shape, Mesh):
        vertices = shape.world_vertices
        return vertices.min(axis=0), vertices.max(axis=0)
    low, high = type(shape).bounds(np.array([shape.row], np.float64))
    return low[0], high[0]


def _is_in(box: tuple[Array, Array], place: Vector | Array) -> bool:
    return bool((box[0] < np.array(place)).all() and (np.array(place) < box[1]).all())


def _unit(way: Array) -> Array:
    """Return the direction of a vector, or 0 for none."""
    return way / max(float(np.linalg.norm(way)), 1e-12)


def _vector(place: Array) -> Vector:
    return float(place[0]), float(place[1]), float(place[2])


def with_model(scene: Scene, path: Path, place: Vector, size: float) -> Scene:
    """Return the scene with a model's meshes and materials, within a radius `size` of a place.

    Raises `SceneError` if the file is not a model.
    """
    model = model_scene(path, AssetFolder(path.absolute().parent), str(path))
    meshes = [thing for thing in model.objects if isinstance(thing, Mesh)]
    low, high = meshes[0].triangles_of_file.box
    factor = two_digits(2 * size / max(float(np.linalg.norm(high - low)), 1e-9))
    moved = np.array(place) - factor * (low + high) / 2
    where = {"scale": factor, "translate": [near(part, size) for part in moved]}
    names = {thing.name for thing in scene.objects if thing.name}
    name = free_name(text_of(path.stem), names)
    materials = _materials(scene, model, meshes)
    for number, mesh in enumerate(meshes):
        own = name if len(meshes) == 1 else f"{name}, {mesh.part or number}"
        told, material = materials[mesh.material]
        scene = with_added(scene, replaced(mesh, name=own, material=told, **where), material)
    return scene


def _materials(scene: Scene, model: Scene, meshes: list[Mesh]) -> dict[str, tuple[str, Material]]:
    """Return name and material in the scene, by name in the model; equal materials are shared."""
    found: dict[str, tuple[str, Material]] = {}
    for name in dict.fromkeys(mesh.material for mesh in meshes):
        material = model.materials[name]
        is_there = scene.materials.get(name) == material
        taken = [*scene.materials, *(told for told, _ in found.values())]
        found[name] = (name if is_there else free_name(name, taken), material)
    return found


def two_digits(value: float) -> float:
    """Round a length to two digits, so that scene files are easy to read."""
    return float(f"{value:.2g}")


def near(value: float, size: float) -> float:
    """Round a coordinate to multiples of a power of ten, at most a tenth of `size`."""
    step = 10.0 ** math.floor(math.log10(size / 10))
    return _tidy(round(value / step) * step)


def _tidy(value: float) -> float:
    """Round to seven digits, and turn -0 into 0."""
    return float(f"{value:.7g}") + 0.0


def _fields(fields: dict[str, Any]) -> dict[str, Any]:
    return {
        key: [_tidy(part) for part in value] if isinstance(value, np.ndarray) else _tidy(value)
        for key, value in fields.items()
    }
