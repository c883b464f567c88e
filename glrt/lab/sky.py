"""An image of the sky with a sun of one pixel."""

import math
from typing import Any

import numpy as np

from glrt.lab.scenes import matte, plane, scene_of
from glrt.lab.sweep import SIGMAS, Array, Lab, Sweep, mean_of
from glrt.scene.files.named_images import ImageFile, Pixels
from glrt.scene.scene import Scene

WIDTH, HEIGHT = 64, 32
COLUMN, ROW = 20, 6  # of the sun
WALL = 0.5  # albedo of the floor


def sun(lab: Lab) -> Sweep:
    """Noise of a floor under an even sky with a sun of one pixel, by the radiance of the sun."""
    x = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6]
    samples, side = lab.count(1024, 64), 16
    noise: dict[str, list[float]] = {"mis": [], "nee": [], "naive": []}
    wrong = []
    for radiance in x:
        scene = _floor(radiance)
        for method, found in noise.items():
            size: dict[str, Any] = {"width": side, "height": side, "bounces": 1, "method": method}
            mean, stderr = mean_of(lab.render(scene, samples, **size))
            truth = floor_light(_sky(radiance))
            found.append(stderr * math.sqrt(samples) * side / truth)
            is_known = method != "naive"  # it may miss the sun altogether
            if is_known and not abs(mean - truth) <= SIGMAS * stderr + 1e-3 * truth:
                wrong.append(radiance)
    return Sweep(
        parameter="radiance of the sun over that of the sky",
        measure="relative noise of one sample",
        x=x,
        chosen=("mis", noise["mis"]),
        others={"naive": noise["naive"], "nee": noise["nee"]},
        promise="at most 0.6; the mean of mis and nee within 5.3 standard errors and 1e-3",
        bound=[0.6] * len(x),
        wrong=sorted(set(wrong)),
    )


def _sky(radiance: float) -> Pixels:
    pixels = np.ones((HEIGHT, WIDTH, 3), np.float32)
    pixels[ROW, COLUMN] = radiance
    return pixels


def _floor(radiance: float) -> Scene:
    camera = {"position": [0, 1, 1], "look_at": [0, 0, 0], "fov": 10}
    sky = {"image": "sky.exr"}
    floor = plane([0, 0, 0], [0, 1, 0], "floor")
    scene = scene_of([floor], {"floor": matte(WALL)}, camera, background=sky)
    image = ImageFile(file="sky.exr").read_as(f"{radiance:064.0f}", _sky(radiance), None)
    background = scene.background.model_copy(update={"image": image})
    return scene.model_copy(update={"background": background})


def floor_light(pixels: Pixels) -> float:
    """Radiance of the floor: the image, bilinear between pixels, times the cosine, by midpoints.

    An even sky has radiance 1, and a pixel adds its hat over the neighbouring pixels.
    """
    fine = 64
    steps = (np.arange(2 * fine) + 0.5) / fine - 1  # over the two pixels that a hat spans
    hat = 1 - np.abs(steps)
    angle = math.pi * (ROW + 0.5 + steps) / HEIGHT
    down: Array = hat * np.sin(angle) * np.maximum(np.cos(angle), 0)
    solid = float(down.sum()) * math.pi / HEIGHT / fine * 2 * math.pi / WIDTH
    return WALL * (1 + (float(pixels[ROW, COLUMN, 0]) - 1) * solid / math.pi)
