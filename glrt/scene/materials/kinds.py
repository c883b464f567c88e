"""Every type of material of a surface.

Each is a frozen model in a file of its own. The kernel's part of a type is in shaders_glsl/bsdfs/
and glrt/packing/materials.py. docs/extending.md explains how to add a type.
"""

from typing import Annotated, Any, get_args

from pydantic import Field

from glrt.scene.materials.base import Surface
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled

Material = Annotated[
    Lambertian | Metal | Dielectric | Principled | Light | Nothing,
    Field(discriminator="type"),
]

TYPES: dict[str, Any] = {  # the model of each type
    model.model_fields["type"].default: model for model in get_args(get_args(Material)[0])
}


def glass_of(material: Surface | None) -> Dielectric | None:
    """Return the glass that a material is, or partly is; None if light does not pass it."""
    if isinstance(material, Principled):
        return material.glass
    return material if isinstance(material, Dielectric) else None
