"""Sky and sun in the words of Mitsuba: a colour, or an image whose rows include both poles."""

import math
from typing import Any

import numpy as np

from glrt.scene.scene import Scene
from glrt.scene.values import Radiance
from tests.support.sky_images import sky64

SKY_COLUMNS = 1024  # of an image
SKY_ROWS = 512  # from pole to pole: the gradient is then right to 3e-6 of its range
FAR = 2.0**13  # the sun, in lengths of the scene

Words = dict[str, Any]


def sky(mi: Any, scene: Scene) -> Words:
    """The background of a scene that has one."""
    if scene.background.is_pictured:
        return _image_of_sky(mi, scene)
    return _background(mi, *scene.background_colors)


def _background(mi: Any, bottom: Radiance, *rest: Radiance) -> Words:
    *horizon, top = rest
    if {bottom, *rest} == {bottom}:
        return {"type": "constant", "radiance": {"type": "rgb", "value": list(top)}}
    # Rows run from the upper pole to the lower one, both included, and are interpolated.
    cosine = np.cos(np.pi * np.arange(SKY_ROWS) / (SKY_ROWS - 1))
    knots = np.linspace(-1, 1, 2 + len(horizon))
    colors = np.array([bottom, *horizon, top])
    rows = np.stack([np.interp(cosine, knots, channel) for channel in colors.T], axis=-1)
    pixels = np.repeat(rows[:, None].astype(np.float32), 2, axis=1)
    return {"type": "envmap", "bitmap": mi.Bitmap(pixels)}


def _image_of_sky(mi: Any, scene: Scene) -> Words:
    """The image sampled again on a fine grid: Mitsuba's rows include both poles."""
    picture = scene.sky
    assert picture is not None
    assert picture.pixels is not None
    azimuth = 2 * np.pi * (np.arange(SKY_COLUMNS) + 0.5) / SKY_COLUMNS  # from -z towards +x
    angle = np.pi * np.arange(SKY_ROWS + 1)[:, None] / SKY_ROWS
    sine = np.sin(angle)
    parts = sine * np.sin(azimuth), np.cos(angle) + 0 * azimuth, -sine * np.cos(azimuth)
    direction = np.stack(parts, axis=-1).reshape(-1, 3)
    found = sky64(picture.pixels, direction, scene.background.rotation or 0.0)
    pixels = (found * scene.background_colors[0]).reshape(SKY_ROWS + 1, SKY_COLUMNS, 3)
    return {"type": "envmap", "bitmap": mi.Bitmap(pixels.astype(np.float32))}


def sun(mi: Any, scene: Scene, extent: float) -> Words:
    """A disk that is far away for things as near to the origin as `extent`, and faces them."""
    assert scene.sun
    center = FAR * extent * scene.sun.towards
    radius = FAR * extent * math.tan(math.radians(scene.sun.angle) / 2)
    aside = np.eye(3)[np.abs(scene.sun.towards).argmin()]
    facing = mi.ScalarTransform4f().look_at(center.tolist(), [0, 0, 0], aside.tolist())
    return {
        "type": "disk",
        "to_world": facing @ mi.ScalarTransform4f().scale(radius),
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.0] * 3}},
        "emitter": {"type": "area", "radiance": {"type": "rgb", "value": list(scene.sun_radiance)}},
    }
