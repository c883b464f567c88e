"""Images on surfaces: which a material has, their texels, and texture coordinates.

shaders_glsl/structs/maps.glsl declares the rows, shaders_glsl/textures/ reads them.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from glrt.methods.contents import Contents
from glrt.rendering.kernel_structs import CONSTANTS, STRUCTS
from glrt.rendering.pack_mesh import corner_meshes
from glrt.scene.materials import Opaque, Principled
from glrt.scene.scene import Finish, Scene
from glrt.scene.shapes import Shape
from glrt.scene.texture_axes import texture_axes
from glrt.scene.texture_sizes import sizes_of
from glrt.scene.textures import NormalTexture, Texture

Array = np.ndarray[Any, Any]

NO_MAP, ALL_CHANNELS = CONSTANTS["NO_MAP"], CONSTANTS["ALL_CHANNELS"]
FIELDS = {  # of the struct Maps, by the key of a material
    "color": "color",
    "emission": "emission",
    "normal": "normal",
    "metallic": "metallic",
    "roughness": "roughness",
    "alpha": "coverage",
}
_WRAPS = {"repeat": "REPEAT", "mirror": "MIRROR", "clamp": "CLAMP"}
_CHANNELS = "rgba"


def textures_of(scene: Scene, finishes: Sequence[Finish]) -> dict[Texture, None]:
    """The textures of the visible surfaces, each once."""
    names = dict.fromkeys(finish.material for finish in finishes)
    return {texture: None for name in names for texture in _textures(scene, name).values()}


def _textures(scene: Scene, name: str) -> Mapping[str, Texture]:
    material = scene.materials[name]
    return material.textures if isinstance(material, Opaque) else {}


def images_of(textures: Mapping[Texture, None]) -> list[Texture]:
    """One texture for each image or checkerboard, in the order of their texels."""
    found = dict[object, Texture]()
    for texture in textures:
        found.setdefault(texture.source, texture)
    return list(found.values())


def pack_maps(scene: Scene, finishes: Sequence[Finish]) -> dict[str, Array]:
    """Rows of the structs Map, one for each texture, and Maps, one for each finish; or none."""
    textures = textures_of(scene, finishes)
    maps = np.zeros(len(textures), STRUCTS["Map"])
    images = images_of(textures)
    shapes = sizes_of([texture.texels.shape[:2] for texture in images])
    firsts = np.cumsum([0, *(height * width for height, width in shapes)])
    place = {texture.source: number for number, texture in enumerate(images)}
    for row, texture in zip(maps, textures, strict=True):
        number = place[texture.source]
        row["u"], row["v"] = texture.transform
        row["first"], (row["height"], row["width"]) = firsts[number], shapes[number]
        row["wrap"] = CONSTANTS[_WRAPS[texture.wrap]]
        row["is_sharp"] = texture.filter == "nearest" or texture.checker is not None
        channel = texture.channel
        row["channel"] = ALL_CHANNELS if channel is None else _CHANNELS.index(channel)
        row["set"] = texture.uv
        row["strength"] = texture.strength if isinstance(texture, NormalTexture) else 1.0
    of_material = np.zeros(len(finishes) if len(textures) else 0, STRUCTS["Maps"])
    numbers = {texture: number for number, texture in enumerate(textures)}
    for row, finish in zip(of_material, finishes, strict=False):
        own = _textures(scene, finish.material)
        for key, field in FIELDS.items():
            row[field] = numbers[own[key]] if key in own else NO_MAP
        material = scene.materials[finish.material]
        cutoff = material.alpha_cutoff if isinstance(material, Principled) else None
        row["cutoff"] = -1.0 if cutoff is None else cutoff
    return {"Map": maps, "Maps": of_material}


def pack_coordinates(
    scene: Scene, shapes: Sequence[Shape], contents: Contents, eye: Array
) -> dict[str, Array]:
    """Rows of the structs Axes, of planes, quads and disks, and Uv, of corners; or none."""
    if not contents.mapped:
        return {"Axes": np.zeros(0, STRUCTS["Axes"]), "Uv": np.zeros(0, STRUCTS["Uv"])}
    flat = [axes for shape in shapes if (axes := texture_axes(shape)) is not None]
    axes_rows = np.zeros(len(flat), STRUCTS["Axes"])
    for row, axes in zip(axes_rows, flat, strict=True):
        row["origin"], row["u"], row["v"] = axes.origin - eye, axes.u, axes.v
    meshes = [mesh.triangles for mesh in corner_meshes(scene, contents)]
    rows = np.zeros(sum(len(mesh.vertices) for mesh in meshes), STRUCTS["Uv"])
    first = 0
    for mesh in meshes:
        some = slice(first, first + len(mesh.vertices))
        if mesh.uv is not None:
            rows["first"][some], rows["second"][some] = mesh.uv[:, :2], mesh.uv[:, 2:]
        first = some.stop
    return {"Axes": axes_rows, "Uv": rows}
