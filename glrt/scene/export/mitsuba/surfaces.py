"""Surfaces in the words of Mitsuba: how they scatter, and what they emit."""

from typing import Any

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.export.mitsuba.textures import STRAIGHT, Turn, measured, painted, report_lying
from glrt.scene.export.mitsuba.words import COMMENT, Words, color
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene

BLACK = 0.0, 0.0, 0.0
_SMOOTH = 1e-3  # the least roughness that Mitsuba's principled surface takes
_PLAIN_IOR = 1.5


class Surfaces:
    """The surfaces of a scene; equal ones are the same words."""

    def __init__(self, scene: Scene, report: Report) -> None:
        """`report` takes each thing that Mitsuba does not show."""
        self._scene, self._report = scene, report
        self._known = dict[object, Words]()

    def scattering(self, finish: Finish, turn: Turn = STRAIGHT) -> Words:
        """Return how a surface scatters, on both sides; `turn` changes its coordinates first."""
        key = finish.material, turn.tobytes()
        if key not in self._known:
            name, material = finish.material, self._scene.materials[finish.material]
            found = self.bsdf(name, material, turn)
            self._known[key] = {**found, COMMENT: name}
        return self._known[key]

    def emitter(self, finish: Finish, turn: Turn = STRAIGHT) -> Words:
        """Return what a surface emits from its front; empty for one that is no lamp."""
        emission, material = self._scene.emission(finish), self._scene.materials[finish.material]
        if not any(emission) or not isinstance(material, Opaque):
            return {}
        if material.cone:
            self._report(f"the cone of {quoted(finish.material)}")
        image = material.textures.get("emission")
        radiance = painted(image, emission, turn) if image else color(emission)
        return {"emitter": {"type": "area", "radiance": radiance}}

    def bsdf(self, name: str, material: Material, turn: Turn) -> Words:
        """Return how a material scatters."""
        if isinstance(material, Nothing):
            return {"type": "null"}
        if isinstance(material, Dielectric):
            return self._glass(name, material)
        report_lying(name, material.textures, self._report)
        if isinstance(material, Principled):
            return self._principled(name, material, turn)
        if isinstance(material, Metal):
            if material.alpha:
                self._report(f"the correlated shadows between facets of {quoted(name)}")
            if material.anisotropy:
                self._report(f"the anisotropy of {quoted(name)}")
            return both_sides(metal(material, turn))
        image = material.textures.get("color")
        paint = material.color or BLACK
        return both_sides(_matte(painted(image, paint, turn) if image else color(paint)))

    def _glass(self, name: str, material: Dielectric) -> Words:
        if material.priority is not None:
            self._report(f"the priority of {quoted(name)}")
        if material.spread:
            self._report(f"the dispersion of {quoted(name)}")
        if material.alpha and material.thin:
            self._report(f"the roughness of {quoted(name)}, a thin pane")
        elif material.alpha:
            self._report(f"the light that facets of {quoted(name)} send to each other")
        return glass(material)

    def _principled(self, name: str, material: Principled, turn: Turn) -> Words:
        if material.normal:
            self._report(f"the image of normals of {quoted(name)}")
        inner = self._inner(name, material, turn)
        if not material.has_holes:
            return inner
        return {"type": "mask", "opacity": _opacity(material, turn), "nested": inner}

    def _inner(self, name: str, material: Principled, turn: Turn) -> Words:
        clear = material.glass
        if clear and material.transmission == 1 and not material.metallic and not material.textures:
            found = self._glass(name, clear)
            tinted = {"specular_transmittance": color(material.color)}
            return found if material.color == (1, 1, 1) else {**found, **tinted}
        if material.is_matte:
            image = material.textures.get("color")
            paint = painted(image, material.color, turn) if image else color(material.color)
            return both_sides(_matte(paint))
        self._report_differences(name, material)
        return both_sides_of(material, principled(material, turn))

    def _report_differences(self, name: str, material: Principled) -> None:
        is_metal = material.metallic == 1 and "metallic" not in material.textures
        if not is_metal:
            self._report(f"the exact surface of {quoted(name)}: glTF's principled is not Mitsuba's")
        elif material.facet_alpha:
            self._report(f"the correlated shadows between facets of {quoted(name)}")
            self._report(f"the light that facets of {quoted(name)} send to each other")
        if material.anisotropy:
            self._report(f"the anisotropy of {quoted(name)}")
        if material.film:
            self._report(f"the iridescence of {quoted(name)}")
        if any(material.sheen):
            self._report(f"the sheen of {quoted(name)}")
        if material.diffuse_transmission:
            self._report(f"the diffuse transmission of {quoted(name)}")
        if material.clearcoat:
            self._report(f"the exact coat of {quoted(name)}")
        if material.specular != 1 or material.specular_color != (1, 1, 1):
            self._report(f"the specular color of {quoted(name)}")


def both_sides(bsdf: Words) -> Words:
    """Return a surface that scatters in the same way on both sides."""
    return {"type": "twosided", "bsdf": bsdf}


def both_sides_of(material: Principled, bsdf: Words) -> Words:
    """Return the two-sided surface; one that light crosses has two sides by itself."""
    return bsdf if material.transmission else both_sides(bsdf)


def glass(material: Dielectric) -> Words:
    """Return Mitsuba's own glass: panes are smooth, and facets lose the light between them."""
    indices = {"int_ior": material.ior, "ext_ior": 1.0}
    if material.alpha and not material.thin:
        rough = {"distribution": "ggx", "alpha": material.alpha}
        return {"type": "roughdielectric", **rough, **indices}
    return {"type": "thindielectric" if material.thin else "dielectric", **indices}


def metal(material: Metal, turn: Turn = STRAIGHT) -> Words:
    """Return Mitsuba's own metal, of the front; facets shadow each other independently."""
    how: Words = {"material": "none"}  # reflects all, at all angles
    if material.conductor:
        how = {"eta": color(material.conductor.ior), "k": color(material.conductor.k)}
    image = material.textures.get("color")
    if material.color is not None:
        tint = painted(image, material.color, turn) if image else color(material.color)
        how["specular_reflectance"] = tint
    if not material.alpha:
        return {"type": "conductor", **how}
    return {"type": "roughconductor", "distribution": "ggx", "alpha": material.alpha, **how}


def principled(material: Principled, turn: Turn = STRAIGHT) -> Words:
    """Return the case of Disney's surface that is nearest to glTF's; equal for smooth metal."""
    images = material.textures
    found: Words = {"type": "principled"}
    paint = images.get("color")
    found["base_color"] = painted(paint, material.color, turn) if paint else color(material.color)
    for key in ("metallic", "roughness"):
        number, image = float(getattr(material, key)), images.get(key)
        least = _SMOOTH if key == "roughness" else 0.0
        found[key] = measured(image, number, turn) if image else max(number, least)
    if material.ior != _PLAIN_IOR or material.transmission:
        found["eta"] = max(float(material.ior), 1.001)
    if material.clearcoat:
        found |= {"clearcoat": material.clearcoat}
        found["clearcoat_gloss"] = 1 - material.clearcoat_roughness
    if material.transmission:
        found["spec_trans"] = material.transmission
    return found


def _matte(reflectance: Words) -> Words:
    return {"type": "diffuse", "reflectance": reflectance}


def _opacity(material: Principled, turn: Turn) -> Any:
    image, cutoff = material.textures.get("alpha"), material.alpha_cutoff
    if image is None:
        return float(material.alpha if cutoff is None else material.alpha >= cutoff)
    found = measured(image, material.alpha, turn)
    if cutoff is not None:
        found["filter_type"] = "nearest"  # what lies between would be there in part
        values = (found["bitmap"].values >= cutoff).astype(np.float32)
        found["bitmap"] = found["bitmap"]._replace(values=values)
    return found
