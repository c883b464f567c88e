"""Probes after a step of light, and in rooms of any size."""

from typing import Any

import numpy as np

from glrt.analysis.motion.playing import Played, play
from glrt.analysis.motion.sequences import light_step
from glrt.lab.scenes import Table, lamp, matte, quad, scene_of, sphere
from glrt.lab.sweep import Lab, Sweep, mean_of
from glrt.rendering.history.temporal import Way
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.scene.scene import Scene
from glrt.settings import settings_for

SETTINGS: dict[str, Any] = {"width": 16, "height": 16, "sampler": "sobol", "method": "ddgi"}
SAMPLES = 256

UPDATES = (1, 3, 10, 23, 50, 100)  # after the step
DIM = 0.25
DARK, BRIGHT = 0.005, 0.8  # albedos: nearly all light has one bounce, or many
SHARE = 0.25  # of the probes that one update is about
LATE = 1.02  # times the share that is to be left

SIZES = (1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4)
MOST_WRONG = 0.01


def step(lab: Lab) -> Sweep:
    """How much of the light before a step is left in live probes, by their updates since."""
    return Sweep(
        parameter="updates after the light is dimmed",
        measure="share of the change that is missing",
        x=UPDATES,
        chosen=("over one bounce", _left(lab, DARK, HYSTERESIS)),
        others={
            f"over many, albedo {BRIGHT:g}": _left(lab, BRIGHT, HYSTERESIS),
            "over one bounce, hysteresis 0.9": _left(lab, DARK, 0.9),
            f"over one bounce, {SHARE:g} of the probes": _left(lab, DARK, HYSTERESIS, SHARE),
        },
        promise=f"at most {LATE:g} times {HYSTERESIS:g}^n: half after 23",
        bound=[LATE * HYSTERESIS**n for n in UPDATES],
    )


def scale(lab: Lab) -> Sweep:
    """Error of the light of a larger or smaller room, against a room of 2 x 2 x 2."""
    samples = lab.count(SAMPLES)

    def light(size: float, probes: float) -> float:
        room = _room(size, probes)
        return mean_of(lab.render(room, samples, **SETTINGS))[0]

    truth = light(1.0, 1.0)
    return Sweep(
        parameter="half the edge of a room",
        measure="relative error of the mean",
        x=SIZES,
        chosen=("probes in its box", [abs(light(size, size) / truth - 1) for size in SIZES]),
        others={"probes in a box of 2": [abs(light(size, 1.0) / truth - 1) for size in SIZES]},
        promise=f"at most {MOST_WRONG:g} at any size",
        bound=[MOST_WRONG] * len(SIZES),
    )


def _left(lab: Lab, albedo: float, hysteresis: float, share: float = 1.0) -> list[float]:
    """The share of a dimming to DIM that live probes still miss, in a closed room that emits."""
    room, materials = [sphere([0, 0, 0], 1, "wall")], {"wall": lamp(1.0, albedo)}
    scene = scene_of(room, materials, probes={"per_update": share})
    ways = {**SETTINGS, "probes": 2, "bounces": 3, "roulette": False}
    settings = settings_for(scene.render, **ways)
    frames = light_step(scene, UPDATES[-1] + 1, 1, DIM)
    played = play(frames, Played(settings, Way("reset"), hysteresis), lab.context)
    means = [float(picture.mean(dtype=np.float64)) for picture in played]
    held = [(mean - shines) / albedo - shines for mean, shines in _with_light(means)]
    end = DIM * held[0]
    return [(held[n] - end) / (held[0] - end) for n in UPDATES]


def _with_light(means: list[float]) -> list[tuple[float, float]]:
    """The mean of each frame, and the emission of its room: 1 in the first frame, then DIM."""
    return [(mean, DIM if number else 1.0) for number, mean in enumerate(means)]


def _room(size: float, box: float) -> Scene:
    """A room from -size to size with a ball for a lamp, and probes from -box to box."""
    walls: list[Table] = []
    for side in (-size, size):
        walls += [
            quad([-size, side, -size], [2 * size, 0, 0], [0, 0, 2 * size], "m"),
            quad([-size, -size, side], [2 * size, 0, 0], [0, 2 * size, 0], "m"),
            quad([side, -size, -size], [0, 2 * size, 0], [0, 0, 2 * size], "m"),
        ]
    bulb = sphere([0, 0.6 * size, 0.3 * size], 0.15 * size, "lamp")
    eye = {"position": [0, 0, 0.9 * size], "look_at": [0, -size, 0], "fov": 50}
    probes = {"min": [-box] * 3, "max": [box] * 3, "counts": [3, 3, 3]}
    return scene_of([*walls, bulb], {"m": matte(0.5), "lamp": lamp(20.0)}, eye, probes=probes)
