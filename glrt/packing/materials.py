"""Materials as rows of the kernel's array: a packer for each type.

docs/extending.md explains how to add a type.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from glrt.packing.emission_cones import cone_fields, everywhere
from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.material_details import conductor_rows, glass_parts, glass_rows, gloss_rows
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import layer_of_group
from glrt.scene.lights.cone import Cone
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import TYPES
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled

Array = np.ndarray[Any, Any]


def pack_lambertian(row: Any, material: Lambertian) -> None:
    """Fill a row of the struct Material with an albedo."""
    row["kind"], row["color"] = CONSTANTS["MATTE"], material.color


def pack_metal(row: Any, material: Metal) -> None:
    """Fill a row with reflectance, which is 1 for a conductor, and the alpha of GGX."""
    color = (1.0, 1.0, 1.0) if material.color is None else material.color
    row["kind"], row["color"], row["alpha"] = CONSTANTS["METAL"], color, material.alpha
    _pack_grain(row, material)


def pack_dielectric(row: Any, material: Dielectric) -> None:
    """Fill a row with an index of refraction, how far it spreads, and the alpha of GGX."""
    row["kind"] = CONSTANTS["PANE" if material.thin else "DIELECTRIC"]
    row["color"] = 1.0
    row["ior"], row["alpha"] = material.ior, material.alpha
    row["metallic"] = material.spread


def pack_light(row: Any, material: Light) -> None:
    """Fill a row for a lamp, which scatters as matte surfaces do; the scene sets its emission."""
    row["kind"], row["color"] = CONSTANTS["MATTE"], material.color


def pack_principled(row: Any, material: Principled) -> None:
    """Fill a row with base colour and what textures may vary; the struct Gloss holds the rest."""
    rest = 1 - material.glass_share
    row["kind"], row["color"] = CONSTANTS["PRINCIPLED"], material.color
    row["alpha"], row["roughness"] = material.facet_alpha, material.roughness
    row["metallic"] = material.metallic / rest if rest > 0 else 0.0
    row["coverage"], row["crossed"] = material.coverage, 1.0
    _pack_grain(row, material)


def _pack_grain(row: Any, material: Metal | Principled) -> None:
    """Put how much rougher facets are in one direction into fields that other kinds use."""
    if material.anisotropy > 0:
        row["ior"], row["crossed"] = material.stretch, math.radians(material.anisotropy_rotation)


def pack_nothing(row: Any, material: Nothing) -> None:
    """Fill a row for the bounds of a volume."""
    del material
    row["kind"] = CONSTANTS["NONE"]


PACKERS: dict[type, Callable[[Any, Any], None]] = {
    Lambertian: pack_lambertian,
    Metal: pack_metal,
    Dielectric: pack_dielectric,
    Principled: pack_principled,
    Light: pack_light,
    Nothing: pack_nothing,
}

if set(PACKERS) != set(TYPES.values()):
    raise TypeError(f"materials have packers {list(PACKERS)}, and models {list(TYPES.values())}")


def pack_materials(facts: SceneFacts) -> Array:
    """Return rows of the struct Material: one for each finish, then those of `glass_parts`."""
    scene, finishes, layers = facts.scene, facts.finishes, layer_of_group(facts)
    rows = np.zeros(len(finishes), STRUCTS["Material"])
    rows["ior"], rows["details"] = 1.0, CONSTANTS["NO_DETAILS"]
    for row, finish in zip(rows, finishes, strict=True):
        material = scene.materials[finish.material]
        PACKERS[type(material)](row, material)
        row["layer"] = layers.get(finish.group, 0)
        row["emission"] = scene.emission(finish)
    shapes = _emitters(facts)
    places = {emitter: place for place, emitter in enumerate(shapes)}
    for rows_of in (conductor_rows, glass_rows, gloss_rows):
        number_of = rows_of(facts)
        for row, finish in zip(rows, finishes, strict=True):
            row["details"] = number_of.get(finish.material, row["details"])
    rows["emitter"] = [places.get(_emitter(facts, finish), 0) for finish in finishes]
    return np.concatenate([rows, _glass_parts(facts)])


def _glass_parts(facts: SceneFacts) -> Array:
    """Return rows of the glass that some materials partly are, in the order of `glass_parts`."""
    parts, number_of = glass_parts(facts), glass_rows(facts)
    rows = np.zeros(len(parts), STRUCTS["Material"])
    for row, (name, glass) in zip(rows, parts.items(), strict=True):
        pack_dielectric(row, glass)
        row["details"] = number_of.get(name, CONSTANTS["NO_DETAILS"])
    return rows


def pack_emitters(facts: SceneFacts) -> Array:
    """Return rows of the struct Emitter: none if all lamps emit evenly to both sides."""
    found = _emitters(facts)
    rows = np.zeros(len(found), STRUCTS["Emitter"])
    rows["outer"], rows["slope"] = everywhere(len(found))[1:]
    for row, (cone, is_one_sided) in zip(rows, found, strict=True):
        row["is_one_sided"] = is_one_sided
        if cone:
            row["axis"] = cone.unit_axis
            row["outer"], row["slope"] = cone_fields(cone)
    return rows


Emission = tuple[Cone | None, bool]  # its cone, and whether it is from the front alone


def _emitters(facts: SceneFacts) -> list[Emission]:
    """Return the ways in which lamps emit, evenly to both sides first; none if that is all."""
    evenly: Emission = (None, False)
    found = dict.fromkeys([evenly, *(_emitter(facts, finish) for finish in facts.finishes)])
    return list(found) if len(found) > 1 else []


def _emitter(facts: SceneFacts, finish: Finish) -> Emission:
    material = facts.materials[finish.material]
    cone = material.cone if finish.group and isinstance(material, Opaque) else None
    return (cone, finish.is_one_sided)
