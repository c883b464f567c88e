"""Convert materials of a glTF file to those of a scene."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.text import quoted
from glrt.scene.meshes.triangle_meshes import NO_MATERIAL
from glrt.scene.model_files.gltf.document import Document, number, numbers
from glrt.scene.model_files.gltf.primitives import material_names
from glrt.scene.model_files.gltf.textures import TextureTables
from glrt.scene.values import LARGEST

_UNREAD = {  # textures that have no counterpart, by extension
    "KHR_materials_specular": ("specularTexture", "specularColorTexture"),
    "KHR_materials_anisotropy": ("anisotropyTexture",),
    "KHR_materials_iridescence": ("iridescenceTexture", "iridescenceThicknessTexture"),
    "KHR_materials_sheen": ("sheenColorTexture", "sheenRoughnessTexture"),
    "KHR_materials_diffuse_transmission": (
        "diffuseTransmissionTexture",
        "diffuseTransmissionColorTexture",
    ),
    "KHR_materials_clearcoat": (
        "clearcoatTexture",
        "clearcoatRoughnessTexture",
        "clearcoatNormalTexture",
    ),
}
_ROUNDING = 1e-3  # how far out of its range a value may be by rounding
_PLAIN = {"type": "principled", "color": (1.0, 1.0, 1.0), "metallic": 1.0, "roughness": 1.0}
_GREY = {"type": "principled", "color": (0.8, 0.8, 0.8), "roughness": 0.5}


@dataclass
class Look:
    """A material as a table of a scene, and the parts of it that were left out."""

    table: dict[str, Any]
    unread: list[str] = field(default_factory=list)
    is_unlit: bool = False
    hides_backs: bool = False  # doubleSided = false, as the file states
    spares: dict[str, str] = field(default_factory=dict)  # shown for unreadable images
    lost: set[tuple[str, str]] = field(default_factory=set)  # keys and images

    def number(self, value: Any, where: str, most: float = 1.0) -> float:
        """Return a number, moved into 0 to `most`; `unread` lists a change beyond rounding."""
        given = number(value, where)
        found = min(max(given, 0.0), most)
        if abs(given - found) > _ROUNDING:
            self.unread.append(f"the part of {where} outside 0 to {most:g}")
        return found

    def numbers(self, value: Any, count: int, where: str, most: float = 1.0) -> tuple[float, ...]:
        """Return `count` numbers, each as by `number`."""
        return tuple(self.number(each, where, most) for each in numbers(value, count, where))


def looks_of(document: Document, path: str) -> dict[str, Look]:
    """Return the materials of a file by `material_names`, and one for triangles without any."""
    folder = path.rpartition("/")[0] + "/" if "/" in path else ""
    textures = TextureTables(document, path, folder)
    found = {
        name: _look(document, textures, index)
        for index, name in enumerate(material_names(document))
    }
    return {**found, NO_MATERIAL: grey()}


def grey() -> Look:
    """Return the material of triangles without any."""
    return Look(dict(_GREY))


def _look(document: Document, textures: TextureTables, index: int) -> Look:
    here, given = f"materials[{index}]", document.items("materials")[index]
    textures.left_out = []
    look = Look(dict(_PLAIN), unread=textures.left_out, spares=textures.spares)
    _metallic_roughness(document, textures, given, here, look)
    _surface(document, textures, given, here, look)
    is_unlit = document.extension(given, "KHR_materials_unlit", here) is not None
    if not is_unlit:
        _emission(document, textures, given, here, look)
    _layers(document, textures, given, here, look)
    look.is_unlit = is_unlit
    look.hides_backs = given.get("doubleSided") is False
    if is_unlit:
        _let_shine(look)
    return look


def _let_shine(look: Look) -> None:
    """Let a material emit its colour and reflect nothing: it looks the same in every light."""
    shown = {"emission": look.table["color"], "color": (0.0, 0.0, 0.0), "specular": 0.0}
    keys = ("type", "ior", "alpha", "alpha_cutoff")
    kept = {key: look.table[key] for key in keys if key in look.table}
    look.table.clear()
    look.table.update(kept | shown | {"metallic": 0.0, "roughness": 1.0, "thin": True})


def _metallic_roughness(
    document: Document, textures: TextureTables, given: dict[str, Any], here: str, look: Look
) -> None:
    here = f"{here}.pbrMetallicRoughness"
    own = document.table(given.get("pbrMetallicRoughness", {}), here)
    *color, alpha = look.numbers(own.get("baseColorFactor", [1, 1, 1, 1]), 4, f"{here}.color")
    image = textures.table(own.get("baseColorTexture"), f"{here}.baseColorTexture")
    look.table["color"] = {**image, "factor": tuple(color)} if image else tuple(color)
    mode = given.get("alphaMode", "OPAQUE")
    if mode not in ("OPAQUE", "MASK", "BLEND"):
        raise ContentError(f"{here}: alphaMode is none of OPAQUE, MASK and BLEND")
    if mode != "OPAQUE":
        look.table["alpha"] = {**image, "channel": "a", "factor": alpha} if image else alpha
    if mode == "MASK":
        cutoff = number(given.get("alphaCutoff", 0.5), f"{here}: alphaCutoff", 0)
        look.table["alpha_cutoff"] = min(cutoff, 1.0)
    rest = textures.table(own.get("metallicRoughnessTexture"), f"{here}.metallicRoughnessTexture")
    for key, channel in (("metallic", "b"), ("roughness", "g")):
        factor = look.number(own.get(f"{key}Factor", 1), f"{here}.{key}Factor")
        look.table[key] = {**rest, "channel": channel, "factor": factor} if rest else factor


def _surface(
    document: Document, textures: TextureTables, given: dict[str, Any], here: str, look: Look
) -> None:
    image = textures.table(given.get("normalTexture"), f"{here}.normalTexture")
    if image:
        scale = number(given["normalTexture"].get("scale", 1), f"{here}.normalTexture.scale")
        look.table["normal"] = {**image, "strength": min(max(scale, 0.0), 100.0)}


def _emission(
    document: Document, textures: TextureTables, given: dict[str, Any], here: str, look: Look
) -> None:
    own = document.extension(given, "KHR_materials_emissive_strength", here) or {}
    strength = look.number(own.get("emissiveStrength", 1), f"{here}: emissiveStrength", 1e9)
    factor = look.numbers(given.get("emissiveFactor", [0, 0, 0]), 3, f"{here}.emissiveFactor", 1e6)
    emission = tuple(min(value * strength, LARGEST) for value in factor)
    if not any(emission):
        return
    image = textures.table(given.get("emissiveTexture"), f"{here}.emissiveTexture")
    look.table["emission"] = {**image, "factor": emission} if image else emission
    if not image and look.table.pop("alpha", None) is not None:  # a lamp has no holes
        look.table.pop("alpha_cutoff", None)
        look.unread.append("alphaMode of what emits")


def _layers(
    document: Document, textures: TextureTables, given: dict[str, Any], here: str, look: Look
) -> None:
    """Read the extensions of a material: ior, specular, transmission, volume and others."""

    def own(name: str) -> dict[str, Any]:
        found = document.extension(given, f"KHR_materials_{name}", here) or {}
        look.unread += [key for key in _UNREAD.get(f"KHR_materials_{name}", ()) if key in found]
        return found

    def value(table: dict[str, Any], key: str, default: float, most: float = 1.0) -> float:
        return look.number(table.get(key, default), f"{here}: {key}", most)

    ior = value(own("ior"), "ior", 1.5, 1e3)
    look.table["ior"] = ior if ior >= 1 else 1e3  # 0: everything is reflected
    specular = own("specular")
    look.table["specular"] = value(specular, "specularFactor", 1)
    tint = numbers(specular.get("specularColorFactor", [1, 1, 1]), 3, f"{here}: specular", 0)
    look.table["specular_color"] = tuple(min(each, 1.0) for each in tint)
    crossed = own("transmission")
    transmission = value(crossed, "transmissionFactor", 0)
    volume = own("volume")
    look.table["thin"] = value(volume, "thicknessFactor", 0, 1e15) == 0
    distance = volume.get("attenuationDistance")
    if distance is not None and not look.table["thin"]:
        color = volume.get("attenuationColor", [1, 1, 1])
        look.table["attenuation_color"] = look.numbers(color, 3, f"{here}: attenuationColor")
        look.table["attenuation_distance"] = number(
            distance, f"{here}: attenuationDistance", 1e-15, 1e15
        )
    coat = own("clearcoat")
    look.table["clearcoat"] = value(coat, "clearcoatFactor", 0)
    look.table["clearcoat_roughness"] = value(coat, "clearcoatRoughnessFactor", 0)
    grain = own("anisotropy")
    if strength := value(grain, "anisotropyStrength", 0):
        turn = number(grain.get("anisotropyRotation", 0), f"{here}: anisotropyRotation")
        look.table["anisotropy"] = strength
        look.table["anisotropy_rotation"] = math.degrees(math.remainder(turn, math.tau))
        if isinstance(look.table["roughness"], dict):
            _leave_out(look, "anisotropy", "anisotropy with an image of roughness")
    film = own("iridescence")
    if share := value(film, "iridescenceFactor", 0):
        look.table["iridescence"] = share
        look.table["iridescence_ior"] = max(value(film, "iridescenceIor", 1.3, 10), 1.0)
        thickness = value(film, "iridescenceThicknessMaximum", 400, 1e4)
        look.table["iridescence_thickness"] = thickness
    cloth = own("sheen")
    fibres = look.numbers(cloth.get("sheenColorFactor", [0, 0, 0]), 3, f"{here}: sheenColorFactor")
    if any(fibres):
        look.table["sheen"] = fibres
        look.table["sheen_roughness"] = value(cloth, "sheenRoughnessFactor", 0)
    _read_leaf(look, own("diffuse_transmission"), here)
    if transmission:
        image = textures.table(crossed.get("transmissionTexture"), f"{here}: transmissionTexture")
        factor = {**image, "channel": "r", "factor": transmission} if image else transmission
        look.table["transmission"] = factor
        if spread := value(own("dispersion"), "dispersion", 0, 10):
            look.table["dispersion"] = spread
        fit_glass(look)


def _read_leaf(look: Look, given: dict[str, Any], here: str) -> None:
    """Read how much light a matte base lets through, and its colour."""
    share, color = "diffuseTransmissionFactor", "diffuseTransmissionColorFactor"
    if through := look.number(given.get(share, 0), f"{here}: {share}", 1.0):
        look.table["diffuse_transmission"] = through
        tint = look.numbers(given.get(color, [1, 1, 1]), 3, f"{here}: {color}")
        look.table["diffuse_transmission_color"] = tint


def fit_glass(look: Look) -> None:
    """Leave out what glass of a scene cannot be combined with."""
    if look.table.get("clearcoat"):
        _leave_out(look, "clearcoat", "clearcoat over transmission")
    if look.table.get("anisotropy"):
        _leave_out(look, "anisotropy", "anisotropy of transmission")
    if look.table.get("iridescence"):
        _leave_out(look, "iridescence", "iridescence of transmission")
    if look.table.get("diffuse_transmission"):
        _leave_out(look, "diffuse_transmission", "diffuse transmission of transmission")
    if look.table.pop("sheen", None):
        look.unread.append("sheen of transmission")
    if isinstance(look.table["metallic"], dict):
        _leave_out(look, "metallic", "metallicRoughnessTexture with transmission")
    if look.table["thin"]:
        make_pane(look)
    elif look.table.get("dispersion") and look.table["roughness"] != 0.0:
        _leave_out(look, "dispersion", "dispersion of rough glass")


def _leave_out(look: Look, key: str, told: str) -> None:
    look.table[key] = 0.0
    look.unread.append(told)


def dye_unlit(look: Look, colors: NDArray[np.float64]) -> None:
    """Multiply an unlit material by its vertex colors, (v, 3), if they are all the same.

    Emission cannot vary from vertex to vertex: with different colors, the material is lit, and
    matte.
    """
    emission = look.table.pop("emission")
    given = emission["factor"] if isinstance(emission, dict) else emission
    if np.ptp(colors, axis=0).max() > _ROUNDING:
        look.table["color"] = emission
        look.unread.append("KHR_materials_unlit of what has colors of vertices")
        return
    factor = tuple(float(a * b) for a, b in zip(given, colors[0], strict=True))
    dyed = {**emission, "factor": factor} if isinstance(emission, dict) else factor
    look.table["emission"] = dyed


def without_image(look: Look, key: str) -> None:
    """Leave out the image of a key, or take the one that the file has in its stead.

    Without an image the factor stays, except for emission and normals.
    """
    table = look.table.pop(key)
    look.lost.add((key, table["image"]))
    spare = look.spares.get(table["image"], "")
    if spare and (key, spare) not in look.lost:
        look.table[key] = {**table, "image": spare}
        return
    look.unread.append(f"{key} {quoted(table['image'])}, which cannot be read")
    if key not in ("normal", "emission"):
        look.table[key] = table["factor"]


def make_pane(look: Look) -> None:
    """Let the glass of a material be a pane, which encloses nothing."""
    for key in ("attenuation_color", "attenuation_distance", "dispersion"):
        look.table.pop(key, None)
    look.table["thin"] = True
