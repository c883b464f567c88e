"""Denoising: whether the filter leaves a bias, also of what is thin; fireflies in the estimate."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.denoise.blend import blended
from glrt.denoise.denoising import denoise
from glrt.denoise.filters import FILTERS, Filtered
from glrt.denoise.half import Guide, Half, Pixels
from glrt.denoise.risk import squared_error, summed
from glrt.denoise.windows import window_mean
from glrt.image.halves import halves_of
from glrt.lab.scenes import Table, glass, lamp, matte, plane, quad, scene_of, sphere
from glrt.lab.sweep import SIGMAS, Lab, Sweep
from glrt.scene.scene import Scene
from glrt.settings import GUIDES

Floats = NDArray[np.float64]

SAMPLES = (4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
WIDTHS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0)  # in pixels, of bars and stripes
PICTURES, TRUE_OF_WIDTHS = 4, 4096  # pictures of each width; samples of their truth
FOV, NEAR, FAR = 40.0, 2.0, 3.0  # degrees; distances of bars and of the wall
SIDE, TRUE = 24, 1 << 15  # edge of the frame in pixels; samples a pixel, of the truth
SETTINGS: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 4, "aov": GUIDES}
WORSE = 1.3  # times the error of the plain picture, at most
SHARES = (0.0, 0.001, 0.003, 0.01, 0.02, 0.05)  # of observations that are fireflies
BRIGHT, DRAWS, COUNT = 50.0, 400, 4  # times as bright; pictures; observations a half
SMALL = 24  # edge of those pictures in pixels


def samples(lab: Lab) -> Sweep:
    """Error of a ball of glass and its shadow, by samples.

    From the fewest possible samples to so many that the noise is less than the filter's bias.
    """
    scene = scene_of(
        [
            plane([0, 0, 0], [0, 1, 0], "floor"),
            sphere([0, 0.8, 0], 0.5, "glass"),
            sphere([0.4, 3, 0.2], 0.5, "lamp"),
        ],
        {"floor": matte(0.7), "glass": glass(1.5), "lamp": lamp(9.0)},
        {"position": [0, 1.5, 3.5], "look_at": [0, 0.4, 0], "fov": 40},
    )
    count = lab.count(TRUE, 8192)
    truths = [lab.render(scene, count, seed=seed, **SETTINGS).radiance for seed in (8, 9)]
    errors: dict[str, list[float]] = {"denoised by nlm": [], "the filter alone": [], "plain": []}
    with lab.rendering(scene, **SETTINGS) as renderer:
        first = renderer.render(SAMPLES[0] // 2).image()
        for number in SAMPLES:
            whole = renderer.render(number).image()
            halves = halves_of(first, whole)
            alone = summed(halves, _filtered(halves))
            shown = denoise(halves, "nlm").radiance, alone, whole.radiance
            for name, radiance in zip(errors, shown, strict=True):
                errors[name].append(_error(radiance, truths))
            first = whole
    return _compared("samples a pixel", SAMPLES, errors)


def thin(lab: Lab) -> Sweep:
    """Error of dark bars and their shadows on a wall, by the width of the bars."""
    pixel = 2 * math.tan(math.radians(FOV / 2)) * NEAR / SIDE  # edge of one, where the bars are

    def bars(width: float) -> Scene:
        places = np.linspace(-0.8, 0.8, 5)
        thick = width * pixel
        return _before_a_wall(
            [quad([x, -2, -NEAR], [thick, 0, 0], [0, 4, 0], "dark") for x in places.tolist()]
        )

    return _by_width(lab, bars, "width of a bar in pixels")


def stripes(lab: Lab) -> Sweep:
    """Error of a wall of light and dark stripes, as a texture has them, by their width."""
    pixel = 2 * math.tan(math.radians(FOV / 2)) * FAR / SIDE

    def wall(width: float) -> Scene:
        thick = width * pixel
        count = math.ceil(1.2 * SIDE / width)
        low = [-thick * count / 2, -2, 1e-3 - FAR]
        return _before_a_wall(
            [
                quad([low[0] + thick * n, *low[1:]], [thick, 0, 0], [0, 4, 0], "dark")
                for n in range(0, count, 2)
            ]
        )

    return _by_width(lab, wall, "width of a stripe in pixels")


def _before_a_wall(objects: list[Table]) -> Scene:
    """A scene with these objects before a wall, and a lamp next to the camera."""
    own = [plane([0, 0, -FAR], [0, 0, 1], "wall"), sphere([1.5, 1.5, 0], 0.5, "lamp")]
    materials = {"wall": matte(0.7), "dark": matte(0.1), "lamp": lamp(9.0)}
    return scene_of([*own, *objects], materials, {"fov": FOV})


def _by_width(lab: Lab, scene_by: Callable[[float], Scene], parameter: str) -> Sweep:
    """Root mean square error over some pictures of 64 samples: denoised, blurred, and plain."""
    errors: dict[str, list[float]] = {
        "denoised by nlm": [],
        "means over 5 x 5 pixels": [],
        "the filter alone": [],
        "plain": [],
    }
    for width in WIDTHS:
        scene, found = scene_by(width), []
        count = lab.count(TRUE_OF_WIDTHS, 1024)
        truths = [lab.render(scene, count, seed=seed, **SETTINGS).radiance for seed in (8, 9)]
        for seed in range(PICTURES):
            with lab.rendering(scene, seed=seed, **SETTINGS) as renderer:
                first, whole = (renderer.render(number).image() for number in (32, 64))
            halves, blurred = halves_of(first, whole), window_mean(whole.radiance, 2)
            alone = summed(halves, _filtered(halves))
            shown = denoise(halves, "nlm").radiance, blurred, alone, whole.radiance
            found.append([_error(radiance, truths) for radiance in shown])
        for name, column in zip(errors, np.array(found).T, strict=True):
            errors[name].append(float(np.sqrt(np.mean(np.square(column)))))
    return _compared(parameter, WIDTHS, errors)


def _compared(parameter: str, x: Sequence[float], errors: dict[str, list[float]]) -> Sweep:
    """A sweep of errors; the first is that of glrt's picture, the last that of the plain one."""
    name = next(iter(errors))
    return Sweep(
        parameter=parameter,
        measure="relative RMS error",
        x=x,
        chosen=(name, errors.pop(name)),
        others=errors,
        promise=f"at most {WORSE:g} times that of the plain picture",
        bound=[WORSE * error for error in errors["plain"]],
    )


def _filtered(halves: tuple[Half, Half]) -> tuple[Pixels, Pixels]:
    first, second = (FILTERS["nlm"](half).radiance for half in halves)
    return first, second


def _error(radiance: NDArray[np.float32], truths: list[NDArray[np.float32]]) -> float:
    """Relative RMS error against two renders, whose noise is independent."""
    first, second = (truth.astype(np.float64) for truth in truths)
    mean = (first + second) / 2
    squares = (radiance - first) * (radiance - second)
    return float(np.sqrt(max((squares / (mean**2 + 0.01 * mean.mean() ** 2)).mean(), 0)))


def sparks(lab: Lab) -> Sweep:
    """Bias of the estimated mean squared error, in standard errors, by the share of fireflies.

    The picture is a wall with a shadow that no guide shows. Its mean brightness is the same for
    each share.
    """
    draws, far = lab.count(DRAWS, 50), np.zeros((2, len(SHARES)))
    for place, share in enumerate(SHARES):
        rng = np.random.default_rng(place)
        errors = np.array([_drawn(rng, share) for _ in range(draws)])
        far[:, place] = np.abs(errors.mean(axis=0)) / errors.std(axis=0, ddof=1) * np.sqrt(draws)
    return Sweep(
        parameter="share of observations that are 50 times as bright",
        measure="estimate less truth, in standard errors",
        x=SHARES,
        chosen=("two halves judge each other", far[0].tolist()),
        others={"the distance of two halves": far[1].tolist()},
        promise=f"the estimate is right on average: within {SIGMAS} standard errors",
        bound=[SIGMAS] * len(SHARES),
    )


def _drawn(rng: np.random.Generator, share: float) -> Floats:
    """How far two estimates of the squared error of one picture lie from the truth.

    The second estimate takes the error for the variance of two independent results.
    """
    bright = np.where(np.arange(SMALL) < SMALL // 3, 1.0, 0.5)[None, :, None]
    truth = bright * np.ones((SMALL, SMALL, 3))
    halves = _half(rng, truth, share), _half(rng, truth, share)
    first, second = (blended(half, _blurred(half)) for half in halves)
    true = np.square(summed(halves, (first, second)) - truth).mean()
    estimate = squared_error(halves, (first, second)).mean()
    apart = np.square(first.astype(np.float64) - second).mean() / 4
    return np.array([estimate - true, apart - true])


def _blurred(half: Half) -> Filtered:
    """Means over 5 x 5 pixels: a quick filter that is wrong at edges."""
    own = np.full(half.radiance.shape[:2], 1 / 25, np.float32)
    return Filtered(window_mean(half.radiance, 2), own)


def _half(rng: np.random.Generator, truth: Floats, share: float) -> Half:
    """Observations of a gamma distribution, some of them much brighter."""
    scale = truth / (1 + share * (BRIGHT - 1))
    factor = np.where(rng.random((COUNT, *truth.shape[:2], 1)) < share, BRIGHT, 1)
    seen = rng.gamma(4.0, 0.25, (COUNT, *truth.shape)) * scale * factor
    none = Guide(*np.zeros((2, *truth.shape), np.float32))
    mean, variance = seen.mean(axis=0), seen.var(axis=0, ddof=1) / COUNT
    return Half(mean.astype(np.float32), variance.astype(np.float32), 0.5, none, none)
