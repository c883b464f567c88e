"""Media and the bounds of volumes as rows of the kernel's arrays."""

from typing import Any

import numpy as np

from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.packing.shapes import order_of_kernel
from glrt.packing.voxel_texture import first_texels
from glrt.plan.facts import SceneFacts
from glrt.plan.media import Filling
from glrt.plan.plan import layer_of_group
from glrt.scene.grids import grid_of, placement_of
from glrt.scene.lit_scene import media_group
from glrt.scene.transfer import MOST_OPACITY, Transfer
from glrt.scene.values import Radiance

CLASSIFIED = 2.0  # in place of the anisotropy: shaders_glsl/media/transfer.glsl

Array = np.ndarray[Any, Any]


def medium_row(facts: SceneFacts, filling: Filling | None) -> int:
    """Return the row of a medium in the array of the struct Medium; NO_MEDIUM for vacuum.

    The rows of its knots follow that of a medium with a transfer function.
    """
    if filling is None:
        return CONSTANTS["NO_MEDIUM"]
    before = facts.media.rows[: facts.media.rows.index(filling)]
    return sum(1 + knots_of(facts, other.medium) for other in before)


def knots_of(facts: SceneFacts, name: str) -> int:
    """Return the number of knots of the transfer function of a medium; 0 if it has none."""
    transfer = facts.scene.media[name].transfer
    return len(transfer.values) if transfer else 0


def pack_transfer(
    row: Array, knots: Array, transfer: Transfer, colors: tuple[Radiance, ...]
) -> None:
    """Fill the row of a medium and those of its knots, as shaders_glsl/media/transfer.glsl reads.

    `colors` are those of the knots, the intensity of the light group included.
    """
    row["anisotropy"] = CLASSIFIED
    row["emission"] = 0
    row["extinction"] = len(knots), transfer.length, 0
    knots["scattering"] = colors
    knots["emission"][:, 0] = transfer.values
    knots["emission"][:, 1] = np.minimum(transfer.opacities, MOST_OPACITY)


def pack_media(facts: SceneFacts) -> dict[str, Array]:
    """Return rows of the structs Medium and Boundary, by name; none in a scene without media."""
    layers, firsts = layer_of_group(facts), first_texels(facts)
    eye = np.array(facts.scene.camera.position, np.float64)
    count = sum(1 + knots_of(facts, it.medium) for it in facts.media.rows)
    media = np.zeros(count, STRUCTS["Medium"])
    for filling in facts.media.rows:
        name = filling.medium
        medium, number = facts.scene.media[name], medium_row(facts, filling)
        row, colors = media[number], facts.scene.emissions_of_medium(name)
        row["scattering"], row["extinction"] = medium.scattering, medium.extinction
        row["anisotropy"], row["emission"] = medium.anisotropy, colors[0]
        row["layer"] = layers.get(media_group(name), 0)
        if medium.transfer:
            knots = media[number + 1 : number + 1 + knots_of(facts, name)]
            pack_transfer(row, knots, medium.transfer, colors)
        if medium.density:
            place, grid = placement_of(facts.scene, *filling), grid_of(facts.scene, name)
            row["x"], row["y"], row["z"] = place.linear
            row["at_x"], row["at_y"], row["at_z"] = place.linear @ eye + place.origin
            row["size"], row["top"] = grid.voxels.shape[::-1], grid.top
            row["first"] = firsts[medium.density.file.sha256]
    rows = np.zeros(len(facts.media.bounds), STRUCTS["Boundary"])
    number_of = {number: place for place, number in enumerate(order_of_kernel(facts.scene))}
    for row, it in zip(rows, facts.media.bounds, strict=True):
        row["object"] = number_of[it.number]
        row["inside"] = medium_row(facts, facts.media.filling(it.inside, it.number))
        row["outside"] = medium_row(facts, facts.media.filling(it.outside, it.around))
        row["ior"] = it.ior
    return {"Medium": media, "Boundary": rows}
