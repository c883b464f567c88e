"""Sky and sun in the words of Mitsuba: a colour, or an image whose rows include both poles."""

import math

import numpy as np

from glrt.scene.export.mitsuba.words import Pixels, Words, color
from glrt.scene.export.placing import around, placed
from glrt.scene.export.sky_maps import is_even, sky_towards
from glrt.scene.scene import Scene

_COLUMNS = 1024  # of an image, at least
_FINE = 2048  # columns of an image of the sky from which it is not made finer
_ROWS = 512  # of a gradient, from pole to pole, which is then right to 3e-6 of its range
FAR = 2.0**13  # the sun, in lengths of the scene


def sky(scene: Scene) -> Words:
    """Return the background of a scene that has one."""
    if is_even(scene):
        return {"type": "constant", "radiance": color(scene.background_colors[0])}
    picture = scene.sky
    if picture is None or picture.pixels is None:
        angle = np.pi * np.arange(_ROWS) / (_ROWS - 1)
        return _mapped(scene, angle, np.array([0.0, np.pi]))
    height, width, _ = picture.pixels.shape
    finer = max(-(-_COLUMNS // width), 2 if width <= _FINE else 1)
    rows, columns = height * finer, width * finer
    azimuth = 2 * np.pi * (np.arange(columns) + 0.5) / columns
    return _mapped(scene, np.pi * np.arange(rows + 1) / rows, azimuth)


def _mapped(scene: Scene, angle: np.ndarray, azimuth: np.ndarray) -> Words:
    """Return an image; rows are angles from +y, and columns azimuths from -z towards +x."""
    pixels = np.empty((len(angle), len(azimuth), 3), np.float32)
    for row, each in zip(pixels, angle, strict=True):  # a row at a time bounds the memory
        sine = np.sin(each)
        parts = sine * np.sin(azimuth), np.cos(each) + 0 * azimuth, -sine * np.cos(azimuth)
        row[:] = sky_towards(scene, np.stack(parts, axis=-1))
    return {"type": "envmap", "bitmap": Pixels(pixels)}


def sun(scene: Scene, extent: float) -> Words:
    """Return a disk that is far away for things as near to the origin as `extent`."""
    if scene.sun is None:
        raise ValueError("the scene has no sun")
    towards = scene.sun.towards
    radius = FAR * extent * math.tan(math.radians(scene.sun.angle) / 2)
    u, v = (radius * axis for axis in around(-towards))
    return {
        "type": "disk",
        "to_world": placed(FAR * extent * towards, u, v, -towards),
        "bsdf": {"type": "diffuse", "reflectance": color((0, 0, 0))},
        "emitter": {"type": "area", "radiance": color(scene.sun_radiance)},
    }
