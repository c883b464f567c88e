"""Sky and sun in the words of pbrt."""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.scene.export.companions import Companions, pfm_of
from glrt.scene.export.pbrt.text import directive, transform, with_parameters
from glrt.scene.export.placing import around, placed
from glrt.scene.export.sky_maps import is_even, sky_towards
from glrt.scene.scene import Scene

Floats = NDArray[np.float64]

_SMALLEST, _LARGEST = 512, 4096  # edges of a map
_FINE = 2  # points in a pixel along each axis, whose mean is taken
FAR = 2.0**13  # the sun, in lengths of the scene


def sky(scene: Scene, companions: Companions) -> str:
    """Return the light of the background of a scene that has one."""
    if is_even(scene):
        words: dict[str, object] = {"rgb L": scene.background_colors[0]}
    else:
        words = {"string filename": companions.add("sky", ".pfm", pfm_of(_mapped(scene)))}
    return with_parameters(directive("LightSource", "infinite"), words)


def sun(scene: Scene, extent: float) -> list[str]:
    """Return a disk that is far away for things as near to the origin as `extent`."""
    if scene.sun is None:
        raise ValueError("the scene has no sun")
    towards = scene.sun.towards
    radius = FAR * extent * math.tan(math.radians(scene.sun.angle) / 2)
    light = {"rgb L": scene.sun_radiance}
    return [
        "AttributeBegin",
        with_parameters(directive("Material", "diffuse"), {"rgb reflectance": (0.0, 0.0, 0.0)}),
        with_parameters(directive("AreaLightSource", "diffuse"), light),
        transform(placed(FAR * extent * towards, *around(-towards), -towards)),
        with_parameters(directive("Shape", "disk"), {"float radius": radius}),
        "AttributeEnd",
    ]


def directions_of(size: int, fine: int = 1) -> Floats:
    """Return the unit directions of points in the pixels of a square map, (n, n, 3), n = size fine.

    Pixels have equal solid angles, and the middle is +z (Clarberg 2008).
    """
    steps = 2 * (np.arange(size * fine) + 0.5) / (size * fine) - 1
    u, v = np.meshgrid(steps, steps)
    across, down = np.abs(u), np.abs(v)
    signed = 1 - (across + down)
    radius = 1 - np.abs(signed)
    turn = np.divide(down - across, radius, out=np.zeros_like(u), where=radius > 0) + 1
    angle = turn * math.pi / 4
    z = np.copysign(1 - radius**2, signed)
    wide = radius * np.sqrt(2 - radius**2)
    parts = np.copysign(np.cos(angle), u) * wide, np.copysign(np.sin(angle), v) * wide, z
    return np.stack(parts, axis=-1)


def _mapped(scene: Scene) -> NDArray[np.float32]:
    """Return the sky as an image, (n, n, 3), on the map of `directions_of`."""
    size = _SMALLEST
    if scene.sky is not None and scene.sky.pixels is not None:
        height, width, _ = scene.sky.pixels.shape
        while size < _LARGEST and size**2 < 2 * height * width:
            size *= 2
    found = np.zeros((size, size, 3), np.float32)
    towards = directions_of(size, _FINE).reshape(size, _FINE, size, _FINE, 3)
    for row, each in zip(found, towards, strict=True):  # a row at a time bounds the memory
        light = sky_towards(scene, each.reshape(-1, 3)).reshape(_FINE, size, _FINE, 3)
        row[:] = light.mean(axis=(0, 2))
    return found
