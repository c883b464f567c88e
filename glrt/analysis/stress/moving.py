"""The camera moves: whether history makes the picture worse than the film alone."""

import math
import statistics
from dataclasses import replace
from typing import Any

import numpy as np

from glrt.analysis.motion.playing import Picture, play
from glrt.analysis.motion.sequences import Sequence, with_camera
from glrt.analysis.stress.scenes import glass, lamp, matte, plane, scene_of, sphere
from glrt.analysis.stress.sweep import Lab, Sweep
from glrt.rendering.temporal import WAYS, Way
from glrt.scene.scene import Scene
from glrt.settings import settings_for

SPEEDS = (0.1, 0.3, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # pixels a frame, of what is in the middle
FRAMES, SIDE, TRUE = 8, 40, 4096
PLACES = 4  # moves of which the squared errors are averaged
SAMPLES = 16  # of a frame
MODES = ("reproject", "taa", "ataa", "wrls", "wrls delayed", "reset")
CHOSEN, NAIVE = "reproject", "history that stays in its pixels"
WORSE = 1.1  # times the error of `reset`, at most
SETTINGS: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 4, "sampler": "independent"}


def speed(lab: Lab) -> Sweep:
    """Error of what is on the screen after some frames, by how fast the camera goes sideways.

    A matte and a glass ball over a floor, before the sky: they hide each other, and the floor.
    """
    scene = scene_of(
        [
            plane([0, 0, 0], [0, 1, 0], "floor"),
            sphere([-0.5, 0.5, 0], 0.5, "matte"),
            sphere([0.6, 0.5, 0.6], 0.5, "glass"),
            sphere([0.4, 3, 0.2], 0.5, "lamp"),
        ],
        {"floor": matte(0.7), "matte": matte(0.5), "glass": glass(1.5), "lamp": lamp(9.0)},
        {"position": [0, 0.9, 3.5], "look_at": [0, 0.5, 0], "fov": 40},
    )
    return _sideways(lab, scene)


def reflection(lab: Lab) -> Sweep:
    """The same of what a mirror shows, which moves otherwise than its surface.

    A wall that is a mirror, over a floor; the balls stand beside the camera.
    """
    scene = scene_of(
        [
            plane([0, 0, 0], [0, 1, 0], "floor"),
            plane([0, 0, 0], [0, 0, 1], "mirror"),
            sphere([-0.7, 0.6, 2.2], 0.5, "red"),
            sphere([0.7, 0.6, 2.6], 0.4, "blue"),
            sphere([0, 4, 3], 1.0, "lamp"),
        ],
        {
            "floor": matte(0.5),
            "red": {"type": "lambertian", "color": [0.8, 0.2, 0.1]},
            "blue": {"type": "lambertian", "color": [0.1, 0.2, 0.8]},
            "mirror": {"type": "metal", "color": [0.9, 0.9, 0.9], "roughness": 0.0},
            "lamp": lamp(9.0),
        },
        {"position": [0, 1.2, 3.5], "look_at": [0, 0.6, 0], "fov": 40},
    )
    return replace(_sideways(lab, scene), bound=None, promise="none")


def _sideways(lab: Lab, scene: Scene) -> Sweep:
    """Of a camera 3.5 units before the plane through 0."""
    tall = 2 * 3.5 * float(np.tan(np.radians(20)))  # what the picture shows of that plane
    errors: dict[str, list[float]] = {name: [] for name in (NAIVE, *MODES)}
    count = lab.count(TRUE, 512)
    for pixels in SPEEDS:
        step = pixels * tall / SIDE
        places = [(frame - FRAMES + 1) * step for frame in range(FRAMES)]
        moves = Sequence("pan", tuple(_aside(scene, place) for place in places))
        truths = [
            np.asarray(lab.render(moves.scenes[-1], count, seed=seed, **SETTINGS).radiance, float)
            for seed in (8, 9)
        ]
        squares: dict[str, list[float]] = {name: [] for name in errors}
        for place in range(lab.count(PLACES, 1)):
            shown = {mode: _shown(lab, moves, WAYS[mode], 100 * place) for mode in MODES}
            pictures = {NAIVE: np.mean(shown["reset"], axis=0)}
            pictures |= {mode: screens[-1] for mode, screens in shown.items()}
            for name, picture in pictures.items():
                squares[name].append(_squared(picture, truths))
        for name, found in squares.items():
            errors[name].append(math.sqrt(max(statistics.fmean(found), 0.0)))
    return Sweep(
        parameter="speed of the camera, in pixels a frame",
        measure=f"relative RMS error after {FRAMES} frames",
        x=SPEEDS,
        chosen=(CHOSEN, errors[CHOSEN]),
        others={name: errors[name] for name in errors if name != CHOSEN},
        promise=f"at most {WORSE:g} times that of reset",
        bound=[WORSE * error for error in errors["reset"]],
    )


FACTORS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0)
STILL, AFTER = 16, 2  # frames of a sample before the light changes, and after it


def step(lab: Lab) -> Sweep:
    """Error of what is on the screen two frames after all light changed, by how much it did.

    A matte ball on a floor, a still camera. Other light is as bright everywhere: so one reference
    serves all factors.
    """
    scene = scene_of(
        [
            plane([0, 0, 0], [0, 1, 0], "floor"),
            sphere([0, 0.5, 0], 0.5, "matte"),
            sphere([0.4, 3, 1.2], 0.5, "lamp"),
        ],
        {"floor": matte(0.7), "matte": matte(0.5), "lamp": lamp(9.0)},
        {"position": [0, 1.2, 3.0], "look_at": [0, 0.4, 0], "fov": 40},
    )
    count = lab.count(TRUE, 512)
    truths = [
        np.asarray(lab.render(scene, count, seed=seed, **SETTINGS).radiance, float)
        for seed in (8, 9)
    ]
    errors: dict[str, list[float]] = {mode: [] for mode in MODES}
    for factor in FACTORS:
        dimmed = scene.model_copy(update={"lights": {"lamp": factor}})
        frames = Sequence("step", (*[scene] * STILL, *[dimmed] * AFTER))
        scaled = [factor * truth for truth in truths]
        for mode in MODES:
            squares = [
                _squared(_shown(lab, frames, WAYS[mode], 100 * place, 1)[-1], scaled)
                for place in range(lab.count(PLACES, 1))
            ]
            errors[mode].append(math.sqrt(max(statistics.fmean(squares), 0.0)))
    return Sweep(
        parameter="factor of all light",
        measure=f"relative RMS error {AFTER} frames of one sample later",
        x=FACTORS,
        chosen=(CHOSEN, errors[CHOSEN]),
        others={name: errors[name] for name in errors if name != CHOSEN},
        promise="none",
    )


def _aside(scene: Scene, by: float) -> Scene:
    camera = scene.camera
    places = {
        name: (getattr(camera, name)[0] + by, *getattr(camera, name)[1:])
        for name in ("position", "look_at")
    }
    return with_camera(scene, camera.model_copy(update=places))


def _shown(lab: Lab, moves: Sequence, way: Way, seed: int, samples: int = SAMPLES) -> list[Picture]:
    settings = settings_for(moves.scenes[0].render, seed=seed, **SETTINGS)
    return [*play(moves, settings, lab.context, way.mode, samples, predictor=way.predictor)]


def _squared(picture: Any, truths: list[Any]) -> float:
    """Against two renders, whose noise is independent."""
    first, second = truths
    mean = (first + second) / 2
    scale = mean**2 + 0.01 * mean.mean() ** 2
    return float(((picture - first) * (picture - second) / scale).mean())
