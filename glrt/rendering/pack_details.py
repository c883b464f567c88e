"""What some materials have beyond the struct Material: a row for each such material.

shaders_glsl/structs/details.glsl declares the rows.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from glrt.rendering.kernel_structs import CONSTANTS, STRUCTS
from glrt.scene.conductors import Conductor
from glrt.scene.facets import STEPS, FacetLoss, facet_loss
from glrt.scene.glasses import glasses_of
from glrt.scene.materials import Metal
from glrt.scene.scene import Finish, Scene

Array = np.ndarray[Any, Any]
ALBEDOS = STEPS  # rows of the struct Albedo for each glass whose facets lose light


def conductor_rows(scene: Scene, finishes: Sequence[Finish]) -> dict[str, int]:
    """The rows of the materials that have one in the array of the struct Conductor."""
    return {metal: row for row, metal in enumerate(_metals(scene, finishes))}


def _metals(scene: Scene, finishes: Sequence[Finish]) -> dict[str, Conductor]:
    names = dict.fromkeys(finish.material for finish in finishes)
    materials = {name: scene.materials[name] for name in names}
    return {
        name: metal.conductor
        for name, metal in materials.items()
        if isinstance(metal, Metal) and metal.conductor
    }


def pack_conductors(scene: Scene, finishes: Sequence[Finish]) -> Array:
    """Rows of the struct Conductor."""
    metals = _metals(scene, finishes)
    rows = np.zeros(len(metals), STRUCTS["Conductor"])
    if metals:
        rows["n"], rows["k"] = zip(*metals.values(), strict=True)
    return rows


def glass_rows(scene: Scene, finishes: Sequence[Finish]) -> dict[str, int]:
    """The rows of the materials that have one in the array of the struct Glass.

    Those with a priority come first, the highest before the others.
    """
    return {glass: row for row, glass in enumerate(glasses_of(scene, finishes))}


def pack_glasses(scene: Scene, finishes: Sequence[Finish]) -> dict[str, Array]:
    """Rows of the structs Glass and Albedo."""
    glasses = glasses_of(scene, finishes).values()
    rows = np.zeros(len(glasses), STRUCTS["Glass"])
    losses: list[FacetLoss] = []
    for row, glass in zip(rows, glasses, strict=True):
        row["absorption"], row["ior"] = glass.absorption, glass.ior
        row["first_albedo"] = CONSTANTS["NO_DETAILS"]
        if loss := facet_loss(glass.alpha, glass.ior) if glass.alpha else None:
            row["first_albedo"] = ALBEDOS * len(losses)
            row["mean_outer"], row["mean_inner"] = loss.means
            row["crossing_outer"], row["crossing_inner"] = loss.crossing
            losses.append(loss)
    return {"Glass": rows, "Albedo": _albedos(losses)}


def _albedos(losses: Sequence[FacetLoss]) -> Array:
    rows = np.zeros((len(losses), ALBEDOS), STRUCTS["Albedo"])
    for part, loss in zip(rows, losses, strict=True):
        for side, albedo in zip(("outer", "inner"), loss.albedos, strict=True):
            part[side], part[f"{side}_end"] = albedo[:-1], albedo[1:]
    return rows.reshape(-1)
