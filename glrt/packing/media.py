"""Media and the bounds of volumes as rows of the kernel's arrays."""

from typing import Any

import numpy as np

from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.shapes import order_of_kernel
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import layer_of_group
from glrt.scene.grids import grid_of, placement_of
from glrt.scene.lit_scene import media_group

Array = np.ndarray[Any, Any]


def medium_row(facts: SceneFacts, name: str | None) -> int:
    """Return the row of a medium in the array of the struct Medium; NO_MEDIUM for vacuum."""
    return facts.media.names.index(name) if name is not None else CONSTANTS["NO_MEDIUM"]


def pack_media(facts: SceneFacts) -> dict[str, Array]:
    """Return rows of the structs Medium and Boundary, by name; none in a scene without media."""
    layers, names = layer_of_group(facts), facts.media.names
    eye, first = np.array(facts.scene.camera.position, np.float64), 0
    media = np.zeros(len(names), STRUCTS["Medium"])
    for row, name in zip(media, names, strict=True):
        medium = facts.scene.media[name]
        row["scattering"], row["extinction"] = medium.scattering, medium.extinction
        row["anisotropy"], row["emission"] = medium.anisotropy, facts.scene.emission_of_medium(name)
        row["layer"] = layers.get(media_group(name), 0)
        if name in facts.media.grids:
            place, grid = placement_of(facts.scene, name), grid_of(facts.scene, name)
            row["x"], row["y"], row["z"] = place.linear
            row["at_x"], row["at_y"], row["at_z"] = place.linear @ eye + place.origin
            row["size"], row["first"], row["top"] = grid.voxels.shape[::-1], first, grid.top
            first += grid.voxels.size + grid.tops.size
    rows = np.zeros(len(facts.media.bounds), STRUCTS["Boundary"])
    number_of = {number: place for place, number in enumerate(order_of_kernel(facts.scene))}
    for row, (number, inside, outside) in zip(rows, facts.media.bounds, strict=True):
        row["object"] = number_of[number]
        row["inside"], row["outside"] = medium_row(facts, inside), medium_row(facts, outside)
    return {"Medium": media, "Boundary": rows}
