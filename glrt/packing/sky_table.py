"""The image of the sky as a tree that the kernel samples: shaders_glsl/lights/sky_sampling.glsl."""

from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.gpu.shared_resources import Shared
from glrt.scene.files.named_images import Pixels
from glrt.scene.lights.sky_image import SkyPicture

Array = np.ndarray[Any, Any]


class SkySampling(NamedTuple):
    """The tree and the density by which a sky image is sampled."""

    tree: Array  # (rows, width, 4) float32: sums of the parts of each node, level below level
    density: float  # probability per solid angle where brightness times sine is 1; 0 if black


def sky_sampling(pixels: Pixels) -> SkySampling:
    """Return the tree and the density for an image of the sky, (H, W, 3)."""
    patches = patch_sums(pixels)
    total = float(patches.sum()) / (pixels.shape[0] * pixels.shape[1])
    density = 1 / (2 * np.pi**2 * total) if total > 0 else 0.0
    return SkySampling(_tree(patches), density)


def patch_sums(pixels: Pixels) -> Array:
    """Return brightness times sine over the patches between four pixels, (H + 1, W) float64.

    The unit is the area of a pixel. The first and the last row reach to the poles.
    """
    height = len(pixels)
    sines = np.sin(np.pi * (np.arange(height) + 0.5) / height)
    weights = pixels.mean(axis=2, dtype=np.float64) * sines[:, None]
    framed = np.pad(weights, ((1, 1), (0, 0)))  # 0 at the poles
    columns = (framed + np.roll(framed, -1, axis=1)) / 2
    sums: Array = (columns[:-1] + columns[1:]) / 2
    sums[[0, -1]] /= 2
    return sums


def _tree(patches: Array) -> Array:
    """Return the levels of the tree from the root on, one below the other, (rows, width, 4)."""
    levels = []
    rows, columns = patches.shape
    size = 1 << (max(rows, columns) - 1).bit_length()
    sums = np.pad(patches, ((0, 0), (0, size - columns)))
    while sums.shape[1] > 1:
        sums = np.pad(sums, ((0, len(sums) % 2), (0, 0)))
        parts = sums.reshape(len(sums) // 2, 2, -1, 2).transpose(0, 2, 1, 3)
        nodes = parts.reshape(*parts.shape[:2], 4)
        levels.append(np.pad(nodes, ((0, 0), (0, size // 2 - nodes.shape[1]), (0, 0))))
        sums = nodes.sum(axis=2)
    return np.concatenate(levels[::-1]).astype(np.float32)


class SkyTable(Shared):
    """The sampling tree of a sky image on the driver; its last user frees it."""

    def __init__(self, gl: moderngl.Context, picture: SkyPicture) -> None:
        """Upload the tree of an image whose pixels were read."""
        assert picture.pixels is not None
        found = sky_sampling(picture.pixels)
        super().__init__(tree_texture(gl, found.tree))
        self.density, self._source = found.density, picture.source

    def samples(self, picture: SkyPicture) -> bool:
        """Return whether the tree belongs to this image."""
        return self._source == picture.source


def tree_texture(gl: moderngl.Context, tree: Array) -> moderngl.Texture:
    """Return the texture of a tree in float32, without interpolation."""
    height, width, _ = tree.shape
    texture = gl.texture((width, height), 4, np.ascontiguousarray(tree), dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture
