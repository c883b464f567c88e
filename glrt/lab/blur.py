"""Motion blur: how evenly the times of samples cover the time for which the shutter is open."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.lab.scenes import lamp, quad, scene_of
from glrt.lab.sweep import Lab, Sweep
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

PIXELS = (0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)  # that the lamp crosses
SIDE, WIDE = 32, 8.0  # of the picture and of the lamp, in pixels
SAMPLES = 64
AWAY = 4.0  # distance of the camera from the lamp
PIXEL = 2 * AWAY * math.tan(math.radians(20)) / SIDE  # in the plane of the lamp
BOUND = 0.015  # of the lamp's radiance
FINE = 256  # places in a pixel at which the truth is found

Columns = NDArray[np.float64]


def passing(lab: Lab) -> Sweep:
    """Error of the blur of a lamp, by how far it goes while the shutter is open.

    A square passes in front of nothing: each place is as bright as long as it is covered, so its
    profile is a trapezoid. Times that are random for each sample are compared.
    """
    seeds = lab.count(16, 4)
    even = [_error(lab, way, seeds, is_even=True) for way in PIXELS]
    random = [_error(lab, way, seeds, is_even=False) for way in PIXELS]
    return Sweep(
        parameter="pixels that a lamp of 8 pixels crosses while the shutter is open",
        measure=f"RMS error of columns at {SAMPLES} samples, over the lamp's radiance",
        x=PIXELS,
        chosen=("glrt: even times in a block", even),
        others={"a random time for each sample": random},
        promise=f"{BOUND:g} of the lamp's radiance",
        bound=[BOUND] * len(PIXELS),
    )


def _error(lab: Lab, way: float, seeds: int, is_even: bool) -> float:
    scene, truth = _scene(way), _truth(way)
    settings: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 0, "samples": SAMPLES}
    renderer = Renderer(scene, context=lab.context, opens_shutter=is_even, **settings)
    found = []
    for seed in range(seeds):
        if is_even:
            renderer.update(seed=seed)
            found.append(_columns(renderer.render()))
        else:
            found.append(_at_random_times(renderer, scene, seed))
    if lab.rendered is not None:
        lab.rendered.append(renderer.image())
    renderer.release()
    return float(np.sqrt(np.square(np.array(found) - truth).mean()))


def _at_random_times(renderer: Renderer, scene: Scene, seed: int) -> Columns:
    """The mean of stills of one sample each."""
    times = np.random.default_rng(seed).random(SAMPLES)
    columns = []
    for number, time in enumerate(times):
        renderer.update(scene.in_shutter(float(time)), seed=1 + SAMPLES * seed + number)
        columns.append(_columns(renderer.render(1)))
    mean: Columns = np.mean(columns, axis=0)
    return mean


def _columns(renderer: Renderer) -> Columns:
    """Mean of each column of a picture, (SIDE,)."""
    means: Columns = renderer.image().radiance[..., 0].mean(axis=0, dtype=np.float64)
    return means


def _scene(way: float) -> Scene:
    """A lamp that goes `way` pixels to the right while the shutter is open, about the middle."""
    left, tall = -PIXEL * (WIDE + way) / 2, PIXEL * SIDE
    ends = [[left, -tall, 0], [left + PIXEL * way, -tall, 0]]
    square = {**quad(ends[0], [PIXEL * WIDE, 0, 0], [0, 2 * tall, 0], "lamp"), "name": "it"}
    track = {"target": "objects.it.corner", "times": [0.0, 1.0], "values": ends}
    camera = {"position": [0, 0, AWAY], "look_at": [0, 0, 0], "fov": 40, "shutter": 1.0}
    animation = {"fps": 1.0, "frames": 1, "tracks": [track]}
    return scene_of([square], {"lamp": lamp(1.0)}, camera, animation=animation)


def _truth(way: float) -> Columns:
    """The share of the time for which each column is covered, (SIDE,)."""
    places = (np.arange(SIDE * FINE) + 0.5) / FINE - SIDE / 2
    left = -(WIDE + way) / 2
    covered = np.minimum(places - left, way) - np.maximum(places - left - WIDE, 0)
    shares: Columns = (np.clip(covered, 0, None) / way).reshape(SIDE, FINE).mean(axis=1)
    return shares
