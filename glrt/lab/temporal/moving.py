"""Camera or objects move: whether history makes the picture worse than the film alone."""

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from glrt.analysis.motion.playing import Picture, Played, play
from glrt.analysis.motion.sequences import Sequence as Frames
from glrt.analysis.motion.sequences import with_camera
from glrt.lab.scenes import glass, lamp, matte, plane, quad, scene_of, sphere
from glrt.lab.sweep import Lab, Sweep
from glrt.rendering.history.temporal import WAYS, Way
from glrt.scene.scene import Scene
from glrt.settings import settings_for

SPEEDS = (0.1, 0.3, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # pixels a frame, of what is in the middle
FRAMES, SIDE, TRUE = 8, 40, 4096
PLACES = 4  # camera moves whose squared errors are averaged
SAMPLES = 16  # samples per pixel of a frame
AWAY = 3.5  # distance of the camera from the plane through 0
TALL = 2 * AWAY * math.tan(math.radians(20))  # what the picture shows of that plane
MODES = ("reproject", "taa", "ataa", "wrls", "wrls delayed", "upsample", "reset")
CHOSEN, NAIVE = "reproject", "history that stays in its pixels"
WORSE = 1.1  # times the error of `reset`, at most
Lights = tuple[float, ...]
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
    """Error of what a mirror shows, by speed: a reflection does not move with its surface.

    The scene is a wall that is a mirror, over a floor; the balls are next to the camera.
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


def crossing(lab: Lab) -> Sweep:
    """Error on a matte ball that goes past a still camera, by its speed.

    It ends in the middle of the picture, where its outline is a circle. The lamp stays, so that
    the light on the ball changes while it moves.
    """
    ball, radius = np.array([0.0, 0.5, 0.0]), 0.5

    def scene(place: float) -> Scene:
        return scene_of(
            [
                plane([0, 0, 0], [0, 1, 0], "floor"),
                sphere([place, *ball[1:]], radius, "matte"),
                sphere([0.4, 3, 1.2], 0.5, "lamp"),
            ],
            {"floor": matte(0.7), "matte": matte(0.5), "lamp": lamp(9.0)},
            {"position": [0, ball[1], AWAY], "look_at": [*ball], "fov": 40},
        )

    offsets = np.arange(SIDE) + 0.5 - SIDE / 2
    outline = radius / math.sqrt(AWAY**2 - radius**2) / math.tan(math.radians(20)) * SIDE / 2
    inside = np.hypot(*np.meshgrid(offsets, offsets)) < outline - 1
    return error_on(lab, "ball", "the ball", scene, inside)


def error_on(
    lab: Lab, thing: str, mover: str, scene_at: Callable[[float], Scene], inside: Any
) -> Sweep:
    """Error where a thing is seen at the end, by the speed of `mover`, itself or a part of it.

    `scene_at` has the scene with the mover some scene units before its end; `inside`, (SIDE, SIDE),
    are the pixels that show the thing then.
    """
    truths = _truths(lab, scene_at(0.0))
    errors: dict[str, list[float]] = {name: [] for name in (NAIVE, *MODES)}
    for pixels in SPEEDS:
        places = [(frame - FRAMES + 1) * pixels * TALL / SIDE for frame in range(FRAMES)]
        moves = Frames(thing, tuple(map(scene_at, places)))
        _add_errors(lab, moves, truths, errors, 1, inside)
    return _against_reset(
        f"speed of {mover}, in pixels a frame",
        f"relative RMS error on the {thing}, after {FRAMES} frames of one sample",
        SPEEDS,
        errors,
    )


def _sideways(lab: Lab, scene: Scene) -> Sweep:
    """Errors by the speed of a camera that is AWAY from the plane through 0."""
    errors: dict[str, list[float]] = {name: [] for name in (NAIVE, *MODES)}
    for pixels in SPEEDS:
        step = pixels * TALL / SIDE
        places = [(frame - FRAMES + 1) * step for frame in range(FRAMES)]
        moves = Frames("pan", tuple(_aside(scene, place) for place in places))
        truths = _truths(lab, moves.scenes[-1])
        _add_errors(lab, moves, truths, errors, SAMPLES)
    return _against_reset(
        "speed of the camera, in pixels a frame",
        f"relative RMS error after {FRAMES} frames",
        SPEEDS,
        errors,
    )


FACTORS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0)
FLICKERS = (0.1, 0.25, 0.5, 0.8, 1.0)
STILL, AFTER = 16, 2  # frames of a sample before the light changes, and after it
BANDS = (1, 2, 4, 8, 16)  # pixels
BEFORE = 8  # frames of a sample before the edge moves


def step(lab: Lab) -> Sweep:
    """Error of the screen two frames after all light changed, by the factor of the change."""
    return Sweep(
        parameter="factor of all light",
        measure=f"relative RMS error {AFTER} frames of one sample later",
        x=FACTORS,
        promise="none",
        **_lit(lab, FACTORS, lambda factor: (*[1.0] * STILL, *[factor] * AFTER)),
    )


def flicker(lab: Lab) -> Sweep:
    """Error of the screen while all light changes with each frame, to and fro, by its factor."""
    return Sweep(
        parameter="factor of all light in every other frame",
        measure=f"relative RMS error after {STILL} frames of one sample",
        x=FLICKERS,
        promise="none",
        **_lit(lab, FLICKERS, lambda factor: (1.0, factor) * (STILL // 2)),
    )


def _lit(lab: Lab, factors: tuple[float, ...], lights: Callable[[float], Lights]) -> dict[str, Any]:
    """Curves of the error of the last frame; `lights` has the factor of all light of each frame.

    The scene is a matte ball on a floor, with a still camera. A factor scales all of the light, so
    one reference serves all factors.
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
    truths = _truths(lab, scene)
    errors: dict[str, list[float]] = {mode: [] for mode in MODES}
    for factor in factors:
        dimmed = {f: scene.model_copy(update={"lights": {"lamp": f}}) for f in lights(factor)}
        frames = Frames("light", tuple(dimmed[f] for f in lights(factor)))
        scaled = [lights(factor)[-1] * truth for truth in truths]
        for mode in MODES:
            squares = [
                _squared(_shown(lab, frames, WAYS[mode], 100 * place, 1)[-1], scaled)
                for place in range(lab.count(PLACES, 1))
            ]
            errors[mode].append(_root(squares))
    return _curves(errors)


def uncovered(lab: Lab) -> Sweep:
    """Error of what the edge of a near wall has just uncovered, by the width of that band.

    The camera looks past the edge of a wall at distance 1 to a wall at distance 3, and moves
    sideways: d units uncover 2 d units of the far wall.
    """
    scene = scene_of(
        [
            quad([-9, -9, -1], [9, 0, 0], [0, 18, 0], "near"),
            plane([0, 0, -3], [0, 0, 1], "far"),
            plane([0, -1, 0], [0, 1, 0], "far"),
            sphere([1.2, 1.4, -1.6], 0.5, "lamp"),
        ],
        {"near": matte(0.3), "far": matte(0.8), "lamp": lamp(9.0)},
        {"position": [0, 0, 0], "look_at": [0, 0, -3], "fov": 40},
    )
    truths = _truths(lab, scene)
    errors: dict[str, list[float]] = {name: [] for name in (NAIVE, *MODES)}
    for width in BANDS:
        band = np.s_[:, SIDE // 2 : SIDE // 2 + width]
        aside = width / SIDE * 2 * math.tan(math.radians(20)) * 3 / 2
        moves = Frames("pan", (*[_aside(scene, -aside)] * BEFORE, scene))
        _add_errors(lab, moves, truths, errors, 1, band)
    return _against_reset(
        "width of what is uncovered, in pixels",
        "relative RMS error there, after one sample",
        BANDS,
        errors,
    )


def _add_errors(
    lab: Lab,
    moves: Frames,
    truths: list[Any],
    errors: dict[str, list[float]],
    samples: int,
    where: Any = ...,
) -> None:
    """Append the errors of the last frame by each mode, and of the pixelwise mean of all frames."""
    squares: dict[str, list[float]] = {name: [] for name in errors}
    for place in range(lab.count(PLACES, 1)):
        shown = {mode: _shown(lab, moves, WAYS[mode], 100 * place, samples) for mode in MODES}
        pictures = {NAIVE: np.mean(shown["reset"], axis=0)}
        pictures |= {mode: screens[-1] for mode, screens in shown.items()}
        for name, picture in pictures.items():
            squares[name].append(_squared(picture, truths, where))
    for name, found in squares.items():
        errors[name].append(_root(found))


def _against_reset(
    parameter: str, measure: str, x: Sequence[float], errors: dict[str, list[float]]
) -> Sweep:
    """A sweep whose promise is an error that is hardly above that of `reset`."""
    return Sweep(
        parameter=parameter,
        measure=measure,
        x=x,
        promise=f"at most {WORSE:g} times that of reset",
        bound=[WORSE * error for error in errors["reset"]],
        **_curves(errors),
    )


def _aside(scene: Scene, by: float) -> Scene:
    camera = scene.camera
    places = {
        name: (getattr(camera, name)[0] + by, *getattr(camera, name)[1:])
        for name in ("position", "look_at")
    }
    return with_camera(scene, camera.model_copy(update=places))


def _shown(lab: Lab, moves: Frames, way: Way, seed: int, samples: int = SAMPLES) -> list[Picture]:
    settings = settings_for(moves.scenes[0].render, seed=seed, **SETTINGS)
    return [*play(moves, Played(settings, way), lab.context, samples)]


def _truths(lab: Lab, scene: Scene) -> list[Any]:
    """Two renders, whose noise is independent."""
    count = lab.count(TRUE, 512)
    return [
        lab.render(scene, count, seed=seed, **SETTINGS).radiance.astype(float) for seed in (8, 9)
    ]


def _squared(picture: Any, truths: list[Any], where: Any = ...) -> float:
    first, second = truths
    mean = (first + second) / 2
    scale = mean**2 + 0.01 * mean.mean() ** 2
    return float(((picture - first) * (picture - second) / scale)[where].mean())


def _root(squares: list[float]) -> float:
    return math.sqrt(max(statistics.fmean(squares), 0.0))


def _curves(errors: dict[str, list[float]]) -> dict[str, Any]:
    others = {name: found for name, found in errors.items() if name != CHOSEN}
    return {"chosen": (CHOSEN, errors[CHOSEN]), "others": others}
