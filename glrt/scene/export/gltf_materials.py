"""Materials of a glTF file that is written."""

import math
from typing import Any

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.gltf_textures import TextureWriter, channel_of, placing
from glrt.scene.export.left_out import Report
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.model_files.gltf_file import GltfFile, Table
from glrt.scene.scene import Scene

_LEAST_IOR = 1.0


class MaterialWriter:
    """Adds the materials of a scene to a file, each once for what it emits."""

    def __init__(self, file: GltfFile, scene: Scene, report: Report) -> None:
        """`report` takes each thing that is left out, in words."""
        self._file, self._scene, self._report = file, scene, report
        self._textures = TextureWriter(file)
        self._numbers = dict[object, int]()

    def number(self, finish: Finish) -> int:
        """Return the number in the file of the material of a surface."""
        emission = self._scene.emission(finish)
        key = finish.material, emission
        if key not in self._numbers:
            self._numbers[key] = self._file.add("materials", self._table(finish, emission))
        if any(emission) and finish.is_one_sided:
            self._report(f"the dark backs of {quoted(finish.material)}")
        return self._numbers[key]

    def _table(self, finish: Finish, emission: Any) -> Table:
        material, name = self._scene.materials[finish.material], finish.material
        table: Table = {"name": name, "doubleSided": True}
        if isinstance(material, Dielectric):
            return table | self._glass(material, name)
        if isinstance(material, Principled):
            table |= self._principled(material, name)
        elif isinstance(material, Metal):
            table |= self._metal(material, name)
        elif isinstance(material, Lambertian | Light):
            table |= self._matte(material)
        if isinstance(material, Opaque) and any(emission):
            table |= self._emission(material, emission, table.setdefault("extensions", {}))
            if material.cone:
                self._report(f"the cone of {quoted(name)}")
        self._file.use(*table.get("extensions", {}))
        return {key: value for key, value in table.items() if value not in ({}, None)}

    def _emission(self, material: Opaque, emission: Any, extensions: Table) -> Table:
        strength = max(1.0, *emission)
        if strength > 1:
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        found: Table = {"emissiveFactor": [each / strength for each in emission]}
        if image := material.textures.get("emission"):
            if image.texels.max() > 1:
                self._report("what is brighter than 1 in an image of emission")
            found["emissiveTexture"] = self._textures.lying(image, image.texels, True)
        return found

    def _matte(self, material: Lambertian | Light) -> Table:
        base = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
        return {
            "pbrMetallicRoughness": {**base, **self._color(material, 1.0)},
            "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}},
        }

    def _metal(self, material: Metal, name: str) -> Table:
        self._report(f"the exact angles of {quoted(name)}: metals of glTF brighten at the edge")
        base = {"metallicFactor": 1.0, "roughnessFactor": material.roughness}
        grain = {"extensions": _grain(material)}
        if material.conductor is None:
            return {"pbrMetallicRoughness": {**base, **self._color(material, 1.0)}, **grain}
        tint = material.color or (1.0, 1.0, 1.0)
        facing = [
            ((n - 1) ** 2 + k * k) / ((n + 1) ** 2 + k * k) * each
            for n, k, each in zip(*material.conductor, tint, strict=True)
        ]
        return {"pbrMetallicRoughness": {**base, "baseColorFactor": [*facing, 1.0]}, **grain}

    def _glass(self, material: Dielectric, name: str) -> Table:
        if material.priority is not None:
            self._report(f"the priority of {quoted(name)}")
        if material.ior < _LEAST_IOR:
            self._report(f"the index of {quoted(name)}, which is below 1")
        base = {"metallicFactor": 0.0, "roughnessFactor": material.roughness}
        extensions: Table = {
            "KHR_materials_transmission": {"transmissionFactor": 1.0},
            "KHR_materials_ior": {"ior": max(material.ior, _LEAST_IOR)},
            **_volume(material),
            **_dispersion(material),
        }
        self._file.use(*extensions)
        return {"pbrMetallicRoughness": base, "extensions": extensions}

    def _principled(self, material: Principled, name: str) -> Table:
        base = {**self._color(material, material.alpha), **self._metallic(material, name)}
        found: Table = {"pbrMetallicRoughness": base, "extensions": self._layers(material)}
        if material.normal:
            info = self._textures.lying(material.normal, material.normal.texels, False)
            found["normalTexture"] = {**info, "scale": material.normal.strength}
        if material.alpha_cutoff is not None:
            found |= {"alphaMode": "MASK", "alphaCutoff": material.alpha_cutoff}
        elif material.alpha < 1 or "alpha" in material.textures:
            found["alphaMode"] = "BLEND"
        return found

    def _color(self, material: Opaque, alpha: float) -> Table:
        """Return the base color with its image, in whose alpha an image of alpha lies."""
        color = material.color or (0.0, 0.0, 0.0)
        found: Table = {"baseColorFactor": [*color, alpha]}
        image, holes = material.textures.get("color"), material.textures.get("alpha")
        if image and holes and placing(image) != placing(holes):
            self._report("an image of alpha that lies otherwise than that of the color")
            holes = None
        if one := image or holes:
            texels = np.ones_like(one.texels)
            if image:
                texels[..., :3] = image.texels[..., :3]
            if holes:
                texels[..., 3] = channel_of(holes)
            found["baseColorTexture"] = self._textures.lying(one, texels, True)
        return found

    def _metallic(self, material: Principled, name: str) -> Table:
        found: Table = {"metallicFactor": material.metallic, "roughnessFactor": material.roughness}
        metal, rough = material.textures.get("metallic"), material.textures.get("roughness")
        if metal and rough and placing(metal) != placing(rough):
            self._report(f"an image of how metallic {quoted(name)} is")
            metal = None
        if one := metal or rough:
            texels = np.ones_like(one.texels)
            for place, image in ((1, rough), (2, metal)):
                if image:
                    texels[..., place] = channel_of(image)
            found["metallicRoughnessTexture"] = self._textures.lying(one, texels, False)
        return found

    def _layers(self, material: Principled) -> Table:
        found: Table = {"KHR_materials_ior": {"ior": material.ior}, **_grain(material)}
        if material.specular != 1 or material.specular_color != (1, 1, 1):
            tint = {"specularColorFactor": list(material.specular_color)}
            found["KHR_materials_specular"] = {"specularFactor": material.specular, **tint}
        if material.clearcoat:
            rough = {"clearcoatRoughnessFactor": material.clearcoat_roughness}
            found["KHR_materials_clearcoat"] = {"clearcoatFactor": material.clearcoat, **rough}
        if film := material.film:
            found["KHR_materials_iridescence"] = {
                "iridescenceFactor": material.iridescence,
                "iridescenceIor": film.ior,
                "iridescenceThicknessMaximum": film.thickness,
            }
        if any(material.sheen):
            found["KHR_materials_sheen"] = {
                "sheenColorFactor": list(material.sheen),
                "sheenRoughnessFactor": material.sheen_roughness,
            }
        if material.diffuse_transmission:
            found["KHR_materials_diffuse_transmission"] = {
                "diffuseTransmissionFactor": material.diffuse_transmission,
                "diffuseTransmissionColorFactor": list(material.diffuse_transmission_color),
            }
        if material.transmission:
            crossing: Table = {"transmissionFactor": material.transmission}
            if image := material.textures.get("transmission"):
                texels = np.ones_like(image.texels)
                texels[..., 0] = channel_of(image)
                crossing["transmissionTexture"] = self._textures.lying(image, texels, False)
            found |= {"KHR_materials_transmission": crossing, **_volume(material)}
            found |= _dispersion(material)
        return found


def _grain(material: Metal | Principled) -> Table:
    """Return the extension of facets that are rougher in one direction."""
    if not material.anisotropy:
        return {}
    turn = {"anisotropyRotation": math.radians(material.anisotropy_rotation)}
    return {"KHR_materials_anisotropy": {"anisotropyStrength": material.anisotropy, **turn}}


def _dispersion(material: Dielectric | Principled) -> Table:
    if not material.dispersion:
        return {}
    return {"KHR_materials_dispersion": {"dispersion": material.dispersion}}


def _volume(material: Dielectric | Principled) -> Table:
    """Return the volume of glass, for which glTF takes any thickness above 0; none of a pane."""
    if material.thin:
        return {}
    found: Table = {"thicknessFactor": 1.0}
    if material.attenuation_color is not None and material.attenuation_distance is not None:
        found["attenuationColor"] = list(material.attenuation_color)
        found["attenuationDistance"] = material.attenuation_distance
    return {"KHR_materials_volume": found}
