"""Textures of materials, and texture coordinates of shapes, as rows for the kernel.

shaders_glsl/structs/maps.glsl declares the rows, shaders_glsl/textures/ reads them.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.triangles import corner_meshes
from glrt.plan.facts import SceneFacts
from glrt.scene.images.texture_sizes import sizes_of
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.textures import NormalTexture, Texture
from glrt.scene.shapes.kinds import Shape

Array = np.ndarray[Any, Any]

NO_MAP, ALL_CHANNELS = CONSTANTS["NO_MAP"], CONSTANTS["ALL_CHANNELS"]
FIELDS = {  # fields of the struct Maps, by the key of a material
    "color": "color",
    "emission": "emission",
    "normal": "normal",
    "metallic": "metallic",
    "roughness": "roughness",
    "alpha": "coverage",
    "transmission": "crossed",
}
_WRAPS = {"repeat": "REPEAT", "mirror": "MIRROR", "clamp": "CLAMP"}
_CHANNELS = "rgba"


def textures_of(facts: SceneFacts) -> dict[Texture, None]:
    """Return the textures of the visible surfaces, each once."""
    materials = facts.materials.values()
    return {texture: None for it in materials for texture in _textures(it).values()}


def _textures(material: Material) -> Mapping[str, Texture]:
    return material.textures if isinstance(material, Opaque) else {}


def images_of(textures: Mapping[Texture, None]) -> list[Texture]:
    """Return one texture for each image or checkerboard, in the order of their texels."""
    found = dict[object, Texture]()
    for texture in textures:
        found.setdefault(texture.source, texture)
    return list(found.values())


def pack_maps(facts: SceneFacts) -> dict[str, Array]:
    """Return rows of the structs Map, one per texture, and Maps, one per finish; or none."""
    textures, finishes = textures_of(facts), facts.finishes
    maps = np.zeros(len(textures), STRUCTS["Map"])
    images = images_of(textures)
    shapes = sizes_of([texture.texels.shape[:2] for texture in images])
    firsts = np.cumsum([0, *(height * width for height, width in shapes)])
    place = {texture.source: number for number, texture in enumerate(images)}
    for row, texture in zip(maps, textures, strict=True):
        number = place[texture.source]
        row["u"], row["v"] = texture.transform
        row["first"], (row["height"], row["width"]) = firsts[number], shapes[number]
        row["wrap_u"], row["wrap_v"] = (CONSTANTS[_WRAPS[wrap]] for wrap in texture.wrap)
        row["is_sharp"] = texture.filter == "nearest" or texture.checker is not None
        channel = texture.channel
        row["channel"] = ALL_CHANNELS if channel is None else _CHANNELS.index(channel)
        row["set"] = texture.uv
        row["strength"] = texture.strength if isinstance(texture, NormalTexture) else 1.0
    of_material = np.zeros(len(finishes) if len(textures) else 0, STRUCTS["Maps"])
    numbers = {texture: number for number, texture in enumerate(textures)}
    for row, finish in zip(of_material, finishes, strict=False):
        material = facts.materials[finish.material]
        own = _textures(material)
        for key, field in FIELDS.items():
            row[field] = numbers[own[key]] if key in own else NO_MAP
        cutoff = material.alpha_cutoff if isinstance(material, Principled) else None
        row["cutoff"] = -1.0 if cutoff is None else cutoff
    return {"Map": maps, "Maps": of_material}


def pack_coordinates(facts: SceneFacts, shapes: Sequence[Shape], eye: Array) -> dict[str, Array]:
    """Return rows of the structs Axes, for flat shapes, and Uv and Tangent, for corners.

    Flat shapes are planes, quads and disks. There are no rows without textures or anisotropy, and
    none of Tangent without textures of normals or anisotropy.
    """
    has_grain = bool(facts.lobes.anisotropic)
    is_mapped, is_bumpy = bool(facts.mapped) or has_grain, "normal" in facts.mapped or has_grain
    flat = [axes for shape in shapes if (axes := shape.texture_axes) is not None]
    axes_rows = np.zeros(len(flat) if is_mapped else 0, STRUCTS["Axes"])
    for row, axes in zip(axes_rows, flat, strict=False):
        row["origin"], row["u"], row["v"] = axes.origin - eye, axes.u, axes.v
    meshes = corner_meshes(facts) if is_mapped else []
    own = len(facts.scene.meshes) - len(facts.instances)  # from here on, in frames of their own
    count = sum(len(mesh.triangles.vertices) for mesh in meshes)
    uv_rows = np.zeros(count, STRUCTS["Uv"])
    tangents = np.zeros(count if is_bumpy else 0, STRUCTS["Tangent"])
    first = 0
    for number, mesh in enumerate(meshes):
        found = mesh.triangles
        some = slice(first, first + len(found.vertices))
        if found.uv is not None:
            uv_rows["first"][some], uv_rows["second"][some] = found.uv[:, :2], found.uv[:, 2:]
        if is_bumpy:
            along = found.shading_tangents
            tangents["along"][some] = along if number >= own else along @ mesh.linear.T
        first = some.stop
    return {"Axes": axes_rows, "Uv": uv_rows, "Tangent": tangents}
