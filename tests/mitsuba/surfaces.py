"""Surfaces in the words of Mitsuba: how they scatter, and what they emit."""

from typing import Any

from glrt.core.errors import SceneError
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.facets import facet_loss
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.scene.values import Radiance
from tests.mitsuba import metal, rough_glass
from tests.mitsuba.textured import bitmap

Words = dict[str, Any]


def surface_of(scene: Scene, finish: Finish, is_native: bool) -> Words:
    """How a surface scatters, on both sides, and what it emits from its front."""
    material = scene.materials[finish.material]
    textures = material.textures if isinstance(material, Opaque) else {}
    if textures and not (set(textures) == {"color"} and isinstance(material, Lambertian)):
        raise SceneError(f"material '{finish.material}': the converter paints matte ones alone.")
    if isinstance(material, Nothing):
        return {"bsdf": {"type": "null"}}
    if isinstance(material, Dielectric):
        return {"bsdf": _glass(finish.material, material)}
    if isinstance(material, Principled):
        return {"bsdf": _metallic(finish.material, material)}
    surface: Words = {"bsdf": {"type": "twosided", "bsdf": _scattering(material, is_native)}}
    if any(scene.emission(finish)):
        if isinstance(material, Opaque) and material.cone:
            raise SceneError(f"material '{finish.material}': Mitsuba has no lamp with a cone.")
        surface["emitter"] = {"type": "area", "radiance": _color(scene.emission(finish))}
    return surface


def _glass(name: str, material: Dielectric) -> Words:
    if any(material.absorption) or material.priority is not None:
        raise SceneError(f"material '{name}': the converter to Mitsuba knows clear glass alone.")
    if material.alpha:
        loss = facet_loss(material.alpha, material.ior)
        return rough_glass.words(material.alpha, material.ior, loss)
    kind = "thindielectric" if material.thin else "dielectric"
    return {"type": kind, "int_ior": material.ior, "ext_ior": 1.0}


def _metallic(name: str, material: Principled) -> Words:
    """The case in which Disney's surface is glTF's, except shadowing at high roughness."""
    if material.metallic < 1 or material.clearcoat or material.alpha < 1:
        raise SceneError(f"material '{name}': Mitsuba has another principled surface.")
    color = _color(material.color)
    roughness = float(material.roughness)
    return {"type": "principled", "base_color": color, "metallic": 1.0, "roughness": roughness}


def _scattering(material: Any, is_native: bool) -> Words:
    if not isinstance(material, Metal):
        painted = material.textures.get("color")
        color = bitmap(painted, material.color) if painted else _color(material.color)
        return {"type": "diffuse", "reflectance": color}
    how: Words = {"material": "none"}  # reflects all, at all angles
    if material.conductor:
        how = {"eta": _color(material.conductor.ior), "k": _color(material.conductor.k)}
    if material.color is not None:
        how["specular_reflectance"] = _color(material.color)
    if not material.roughness:
        return {"type": "conductor", **how}
    alpha = material.roughness**2
    if is_native:
        return {"type": "roughconductor", "distribution": "ggx", "alpha": alpha, **how}
    if material.conductor:
        n, k = material.conductor
        indices = {f"{name}{c}": v for name, it in (("n", n), ("k", k)) for c, v in enumerate(it)}
        return {"type": metal.NAME, "alpha": alpha, "reflectance": _color((1, 1, 1)), **indices}
    return {"type": metal.NAME, "alpha": alpha, "reflectance": how["specular_reflectance"]}


def _color(color: Radiance) -> Words:
    return {"type": "rgb", "value": list(color)}
