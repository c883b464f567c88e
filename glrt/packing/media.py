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
LEAST_COLLISIONS = 4  # on the diagonal of a grid that emits and hardly collides, on average


def medium_row(facts: SceneFacts, name: str | None) -> int:
    """Return the row of a medium in the array of the struct Medium; NO_MEDIUM for vacuum."""
    return facts.media.names.index(name) if name is not None else CONSTANTS["NO_MEDIUM"]


def pack_media(facts: SceneFacts) -> dict[str, Array]:
    """Return rows of the structs Medium and Boundary, by name; none in a scene without media."""
    layers, names, grids = layer_of_group(facts), facts.media.names, facts.media.grids
    media = np.zeros(len(names), STRUCTS["Medium"])
    for row, name in zip(media, names, strict=True):
        medium = facts.scene.media[name]
        row["scattering"], row["extinction"] = medium.scattering, medium.extinction
        row["anisotropy"], row["emission"] = medium.anisotropy, facts.scene.emission_of_medium(name)
        row["layer"] = layers.get(media_group(name), 0)
        row["grid"] = grids.index(name) if name in grids else CONSTANTS["NO_GRID"]
    rows = np.zeros(len(facts.media.bounds), STRUCTS["Boundary"])
    number_of = {number: place for place, number in enumerate(order_of_kernel(facts.scene))}
    for row, (number, inside, outside) in zip(rows, facts.media.bounds, strict=True):
        row["object"] = number_of[number]
        row["inside"], row["outside"] = medium_row(facts, inside), medium_row(facts, outside)
    return {"Medium": media, "Boundary": rows, "Grid": _pack_grids(facts)}


def _pack_grids(facts: SceneFacts) -> Array:
    """Return rows of the struct Grid, in the order of their voxels in the texture."""
    scene, grids = facts.scene, facts.media.grids
    eye = np.array(scene.camera.position, np.float64)
    rows = np.zeros(len(grids), STRUCTS["Grid"])
    first = 0
    for row, name in zip(rows, grids, strict=True):
        place, grid = placement_of(scene, name), grid_of(scene, name)
        row["x"], row["y"], row["z"] = place.linear
        row["at_x"], row["at_y"], row["at_z"] = place.linear @ eye + place.origin
        row["size"], row["first"] = grid.voxels.shape[::-1], first
        row["first_brick"] = first + grid.voxels.size
        first += grid.voxels.size + grid.tops.size
        row["top"] = grid.top
        if scene.media[name].emits and grid.top:
            row["least"] = LEAST_COLLISIONS / place.diagonal(grid) / grid.top
    return rows
