"""Scenes whose images need no file, and what float64 says of an image at texture coordinates."""

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from glrt.scene.files.named_images import TextureImage
from glrt.scene.materials.base import Opaque
from glrt.scene.scene import Scene

Array = np.ndarray[Any, Any]


def random_image(width: int, height: int, seed: int = 1) -> Array:
    """(H, W, 4) of numbers that half floats hold exactly."""
    return np.random.default_rng(seed).integers(0, 257, (height, width, 4)) / 256


def with_images(scene: Scene, images: Mapping[str, Array]) -> Scene:
    """The scene with these images, (H, W, 4), in place of files of those names."""
    known = dict[TextureImage, TextureImage]()
    for material in scene.materials.values():
        for texture in material.textures.values() if isinstance(material, Opaque) else ():
            if texture.image is not None:
                pixels = images[texture.image.file].astype(np.float16)
                sha256 = hashlib.sha256(pixels.tobytes()).hexdigest()
                known[texture.image] = texture.image.read_as(sha256, pixels, None)
    materials = {
        name: material.with_images(known) if isinstance(material, Opaque) else material
        for name, material in scene.materials.items()
    }
    return scene.model_copy(update={"materials": materials})


def value64(image: Array, uv: Array, wrap: tuple[str, str], sharp: bool = False) -> Array:
    """(n, 4): the image at n places, after its transform; between the middles of pixels linear."""
    height, width, _ = image.shape
    inside = [_within(uv[:, axis], wrap[axis]) for axis in (0, 1)]
    place = np.stack(inside, axis=1) * [width, height]
    if sharp:
        column, row = np.minimum(place.astype(int), [width - 1, height - 1]).T
        found: Array = image[row, column]
        return found
    corner = np.floor(place - 0.5)
    share = place - 0.5 - corner
    total = np.zeros((len(uv), 4))
    for x in (0, 1):
        for y in (0, 1):
            column, row = (corner + np.array([x, y])).astype(int).T
            column = column % width if wrap[0] == "repeat" else column
            row = row % height if wrap[1] == "repeat" else row
            column, row = column.clip(0, width - 1), row.clip(0, height - 1)
            weight = (share[:, 0] if x else 1 - share[:, 0]) * (
                share[:, 1] if y else 1 - share[:, 1]
            )
            total += weight[:, None] * image[row, column]
    return total


def _within(uv: Array, wrap: str) -> Array:
    if wrap == "clamp":
        return uv.clip(0, 1)
    if wrap == "repeat":
        return uv - np.floor(uv)
    rest: Array = uv % 2
    return np.where(rest > 1, 2 - rest, rest)
