"""Materials in the words of pbrt."""

from typing import Any

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.export.pbrt.text import directive, with_parameters
from glrt.scene.export.pbrt.textures import Textures, report_lying
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene

Words = dict[str, Any]
_ALPHA = {"bool remaproughness": False}  # roughness is the alpha of GGX


class Materials:
    """The materials of a file, each once."""

    def __init__(self, scene: Scene, textures: Textures, report: Report) -> None:
        """`report` takes each thing that pbrt does not show."""
        self.lines = list[str]()
        self._scene, self._textures, self._report = scene, textures, report
        self._known = set[str]()

    def of(self, finish: Finish) -> str:
        """Return the directive that chooses the material of the shapes that follow."""
        name, material = finish.material, self._scene.materials[finish.material]
        if isinstance(material, Nothing):
            return directive("Material", "interface")
        if name not in self._known:
            self._known.add(name)
            self._define(name, self._words(name, material))
        return directive("NamedMaterial", name)

    def light(self, finish: Finish) -> list[str]:
        """Return the directive by which the shapes that follow emit; empty for no lamp."""
        emission, material = self._scene.emission(finish), self._scene.materials[finish.material]
        if not any(emission) or not isinstance(material, Opaque):
            return []
        if material.cone:
            self._report(f"the cone of {quoted(finish.material)}")
        if image := material.textures.get("emission"):
            self._report(f"the image of emission of {quoted(finish.material)}: it shines evenly")
            mean = image.texels[..., :3].astype(np.float64).mean(axis=(0, 1))
            red, green, blue = (float(a * b) for a, b in zip(emission, mean, strict=True))
            emission = red, green, blue
        words = {"rgb L": emission, "bool twosided": not finish.is_one_sided}
        return [with_parameters(directive("AreaLightSource", "diffuse"), words)]

    def holes(self, finish: Finish) -> Words:
        """Return the parameter of a shape that says where it is there."""
        material = self._scene.materials[finish.material]
        if not isinstance(material, Principled) or not material.has_holes:
            return {}
        if image := material.textures.get("alpha"):
            alpha = self._textures.measured(image, material.alpha, material.alpha_cutoff)
            return {"texture alpha": alpha}
        return {"float alpha": material.coverage}

    def _define(self, name: str, words: Words) -> None:
        self.lines.append(with_parameters(directive("MakeNamedMaterial", name), words))

    def _words(self, name: str, material: Material) -> Words:
        if isinstance(material, Dielectric):
            return self._glass(name, material)
        assert isinstance(material, Opaque)
        report_lying(name, material.textures, self._report)
        if isinstance(material, Principled):
            return self._principled(name, material)
        if isinstance(material, Metal):
            return self._metal(name, material)
        return {"string type": "diffuse", **self._reflectance(material)}

    def _reflectance(self, material: Opaque) -> Words:
        color = material.color or (0.0, 0.0, 0.0)
        if image := material.textures.get("color"):
            return {"texture reflectance": self._textures.painted(image, color)}
        return {"rgb reflectance": color}

    def _glass(self, name: str, material: Dielectric) -> Words:
        if material.priority is not None:
            self._report(f"the priority of {quoted(name)}")
        if material.spread:
            self._report(f"the dispersion of {quoted(name)}")
        if material.thin:
            if material.alpha:
                self._report(f"the roughness of {quoted(name)}, a thin pane")
            return {"string type": "thindielectric", "float eta": material.ior}
        if material.alpha:
            self._report(f"the light that facets of {quoted(name)} send to each other")
        rough = {"float roughness": material.alpha, **_ALPHA}
        return {"string type": "dielectric", "float eta": material.ior, **rough}

    def _metal(self, name: str, material: Metal) -> Words:
        rough = {"float roughness": material.alpha, **_ALPHA}
        if material.anisotropy:
            self._report(f"the anisotropy of {quoted(name)}")
        if material.conductor:
            indices = {"rgb eta": material.conductor.ior, "rgb k": material.conductor.k}
            return {"string type": "conductor", **indices, **rough}
        self._report(f"the exact angles of {quoted(name)}: metals of pbrt brighten at the edge")
        return {"string type": "conductor", **self._reflectance(material), **rough}

    def _principled(self, name: str, material: Principled) -> Words:
        if material.normal:
            self._report(f"the image of normals of {quoted(name)}")
        if material.is_matte:
            return {"string type": "diffuse", **self._reflectance(material)}
        if (glass := material.glass) and material.transmission == 1 and not material.metallic:
            if material.color != (1, 1, 1) or "color" in material.textures:
                self._report(f"the color of {quoted(name)}, whose glass is clear")
            return self._glass(name, glass)
        self._report(f"the exact surface of {quoted(name)}: pbrt has no principled one")
        if material.anisotropy:
            self._report(f"the anisotropy of {quoted(name)}")
        if material.film:
            self._report(f"the iridescence of {quoted(name)}")
        if any(material.sheen):
            self._report(f"the sheen of {quoted(name)}")
        if material.diffuse_transmission:
            self._report(f"the diffuse transmission of {quoted(name)}")
        if material.clearcoat:
            self._report(f"the coat of {quoted(name)}")
        if material.transmission:
            self._report(f"the glass of {quoted(name)}, which is there in part")
        return self._mixed(name, material)

    def _mixed(self, name: str, material: Principled) -> Words:
        """Return metal, a coat over matte, or a mixture of both."""
        rough: Words = {"float roughness": material.facet_alpha, **_ALPHA}
        if image := material.textures.get("roughness"):
            squared = self._textures.squared(image, material.roughness)
            rough = {"texture roughness": squared, **_ALPHA}
        metal = {"string type": "conductor", **self._reflectance(material), **rough}
        paint = {"string type": "coateddiffuse", "float eta": material.ior}
        paint |= {**self._reflectance(material), **rough}
        image = material.textures.get("metallic")
        if image is None and material.metallic in (0, 1):
            return metal if material.metallic else paint
        parts = [f"{name} (paint)", f"{name} (metal)"]
        for part, words in zip(parts, (paint, metal), strict=True):
            self._define(part, words)
        amount: Words = {"float amount": material.metallic}
        if image:
            amount = {"texture amount": self._textures.measured(image, material.metallic)}
        return {"string type": "mix", "string materials": parts, **amount}
