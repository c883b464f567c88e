"""The voxels of all grids of media, one after the other in a texture, and bounds of their bricks.

A texel has four voxels, from (x, y) to (x + 1, y + 1), so that two texels hold the corners of the
cell around a place. The edge of the grid is repeated beyond it. After the voxels of a grid follow
the largest and the smallest density in each of its bricks.
"""

from collections.abc import Sequence

import moderngl
import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.shared_resources import Shared
from glrt.packing.texel_texture import WIDTH
from glrt.plan.facts import SceneFacts
from glrt.scene.files.named_grids import GridFile


class VoxelTexture(Shared):
    """Voxels of all grids, RGBA in half floats; their last user frees them."""

    def __init__(self, context: Context, grids: Sequence[GridFile]) -> None:
        """Upload the voxels of grids that were read."""
        super().__init__(texture_of(context.gl, grids))
        self._grids = list(grids)

    def holds(self, grids: Sequence[GridFile]) -> bool:
        """Return whether the texture holds exactly these grids, in this order."""
        return self._grids == list(grids)


def grids_of(facts: SceneFacts) -> list[GridFile]:
    """Return the grids of the media in use, each once."""
    found = [facts.scene.media[name].density for name in facts.media.grids]
    files = {it.file.sha256: it.file for it in found if it is not None}
    return list(files.values())


def first_texels(facts: SceneFacts) -> dict[str | None, int]:
    """Return the number of the first texel of each grid of `grids_of`, by the grid's SHA-256."""
    firsts: dict[str | None, int] = {}
    first = 0
    for grid in grids_of(facts):
        firsts[grid.sha256] = first
        first += 0 if grid.voxels is None else grid.voxels.size + grid.tops.size
    return firsts


def texture_of(gl: moderngl.Context, grids: Sequence[GridFile]) -> moderngl.Texture:
    """Return a texture of grids that were read, in lines of WIDTH texels."""
    parts = [(it.voxels, it.tops, it.bottoms) for it in grids if it.voxels is not None]
    count = sum(voxels.size + tops.size for voxels, tops, _ in parts)
    lines = -(-count // WIDTH)
    texels = np.zeros((lines * WIDTH, 4), np.float16)
    first = 0
    for voxels, tops, bottoms in parts:
        _, height, width = voxels.shape
        cells = texels[first : first + voxels.size].reshape(*voxels.shape, 4)
        right, below = np.arange(width), np.arange(height)
        right[:-1], below[:-1] = right[1:].copy(), below[1:].copy()
        lower = voxels[:, below]
        cells[..., 0], cells[..., 1] = voxels, voxels[..., right]
        cells[..., 2], cells[..., 3] = lower, lower[..., right]
        first += voxels.size
        bricks = texels[first : first + tops.size]
        bricks[:, 0], bricks[:, 1] = tops.ravel(), bottoms.ravel()
        first += tops.size
    texture = gl.texture((WIDTH, lines), 4, texels, dtype="f2")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture
