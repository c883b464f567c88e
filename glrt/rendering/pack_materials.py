"""Materials as rows of the kernel's array: a packer for each type.

docs/extending.md says how a type is added.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from glrt.methods.light_layers import layer_of_group
from glrt.rendering.kernel_structs import CONSTANTS, STRUCTS
from glrt.scene.materials import TYPES, Dielectric, Lambertian, Light, Material, Metal
from glrt.scene.scene import Scene

Array = np.ndarray[Any, Any]


def pack_lambertian(row: Any, material: Lambertian) -> None:
    """Albedo."""
    row["kind"], row["color"] = CONSTANTS["MATTE"], material.color


def pack_metal(row: Any, material: Metal) -> None:
    """Reflectance and the alpha of GGX."""
    row["kind"], row["color"], row["alpha"] = CONSTANTS["METAL"], material.color, material.alpha


def pack_dielectric(row: Any, material: Dielectric) -> None:
    """Index of refraction."""
    row["kind"], row["ior"] = CONSTANTS["DIELECTRIC"], material.ior


def pack_light(row: Any, material: Light) -> None:
    """A lamp scatters as matte surfaces do; its emission follows from the scene."""
    row["kind"], row["color"] = CONSTANTS["MATTE"], material.color


PACKERS: dict[type, Callable[[Any, Any], None]] = {
    Lambertian: pack_lambertian,
    Metal: pack_metal,
    Dielectric: pack_dielectric,
    Light: pack_light,
}

if set(PACKERS) != set(TYPES.values()):
    raise TypeError(f"materials have packers {list(PACKERS)}, and models {list(TYPES.values())}")


def pack_materials(scene: Scene, used: Mapping[str, Material]) -> Array:
    """Rows of the struct Material, in the order of `used`."""
    layers = layer_of_group(scene)
    rows = np.zeros(len(used), STRUCTS["Material"])
    rows["ior"] = 1.0
    for row, (name, material) in zip(rows, used.items(), strict=True):
        PACKERS[type(material)](row, material)
        row["layer"] = layers.get(getattr(material, "group", None) or name, 0)
        row["emission"] = scene.emission(name)
    return rows
