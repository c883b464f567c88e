"""Objects that a user adds: one of each kind, at a place and of a size, and models from files."""

import math
from pathlib import Path
from typing import Any

import numpy as np

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

LAMP = "lamp"  # what is added as one
MATTE = Lambertian(color=(0.7, 0.7, 0.7))
BRIGHT = Light(emission=(10.0, 10.0, 10.0))
ADDED = (*(kind for kind, model in KINDS.items() if model.example(np.zeros(3), 1.0)), LAMP)


def with_new(scene: Scene, kind: str, place: Vector, size: float) -> Scene:
    """One more object of a kind with a material of its own, both named by the kind.

    A lamp is a square that looks down. Lengths are in scene units.
    """
    size = two_digits(size)
    middle = np.array([near(part, size) for part in place])
    is_lamp = kind == LAMP
    model = KINDS["quad" if is_lamp else kind]
    fields = model.example(middle, size)
    if is_lamp:  # edges in the other order: it looks down
        fields["edge_u"], fields["edge_v"] = fields["edge_v"], fields["edge_u"]
    names = {thing.name for thing in scene.objects if thing.name}
    groups = [*scene.materials, *scene.light_groups]  # so that a lamp has one of its own
    parts = {"material": free_name(kind, groups), "name": free_name(kind, names)}
    shape: Shape = made(model, {**_fields(fields), **parts})
    return with_added(scene, shape, BRIGHT if is_lamp else MATTE)


def with_model(scene: Scene, path: Path, place: Vector, size: float) -> Scene:
    """The meshes of a model, with its materials, about a place and within a radius.

    Raises `SceneError` for what is no model.
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
    """By their names in the model: those in the scene; one that is there already is shared."""
    found: dict[str, tuple[str, Material]] = {}
    for name in dict.fromkeys(mesh.material for mesh in meshes):
        material = model.materials[name]
        is_there = scene.materials.get(name) == material
        taken = [*scene.materials, *(told for told, _ in found.values())]
        found[name] = (name if is_there else free_name(name, taken), material)
    return found


def two_digits(value: float) -> float:
    """Of a length: a scene file is to be read."""
    return float(f"{value:.2g}")


def near(value: float, size: float) -> float:
    """Of a coordinate: its multiple of a power of ten that is a tenth of a size or less."""
    step = 10.0 ** math.floor(math.log10(size / 10))
    return _tidy(round(value / step) * step)


def _tidy(value: float) -> float:
    """Without the last digits, and without the sign of zero."""
    return float(f"{value:.7g}") + 0.0


def _fields(fields: dict[str, Any]) -> dict[str, Any]:
    return {
        key: [_tidy(part) for part in value] if isinstance(value, np.ndarray) else _tidy(value)
        for key, value in fields.items()
    }
