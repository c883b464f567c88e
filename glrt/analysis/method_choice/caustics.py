"""Whether particles from lamps are worth their work, and how many: for `--caustics auto`.

A pilot renders a small copy of the whole frame without particles and with some choices of them, and
counts the work of each. Nothing depends on a clock: every part and every crop of a picture decides
alike, and so does the next run.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.analysis.method_choice.work import counting, work_per_sample
from glrt.analysis.variants import LINKED
from glrt.error.estimate import relative_error
from glrt.error.seen_lamps import has_tiny_lamp
from glrt.gpu.context import Context
from glrt.image.image import Image, Pixels
from glrt.plan.facts import SceneFacts
from glrt.plan.particle_refusals import refusal
from glrt.plan.particles import makes_caustics, particles_a_sample
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Sampler, Settings, settings_for

Floats = NDArray[np.float64]
Values = Mapping[str, Any]  # of settings, by their names

# The settings that are tried, in addition to a render without particles.
CHOICES: tuple[Values, ...] = (
    {"particles": 0.25, "aimed": 0.5, "linked": 0.0},
    {"particles": 0.1, "aimed": 0.95, "linked": 0.0},
    LINKED,
)
LONG, SHORT = 1 << 12, 1 << 10  # most pixels of the small frame: for long and for shorter renders
COUNTED = 1 << 10  # most pixels of the frame in which work is counted, which varies less
SAMPLES = 64  # per pixel: four observations with blocks of 16
LEAST = 128  # a render is worth a pilot if it takes so many times the samples of a pilot's picture
SEED = 0x43415553  # the same for every render, so that equal renders decide alike
GAIN = 1.15  # times as efficient, at least: variances and work are estimates
HOPELESS = 0.9  # times as efficient: where the first choice is not, only links are tried then
CERTAIN = 5.0  # standard errors of the mean of a frame or tile, beyond which two differ
TILE = 8  # pixels on a side: about the size of a caustic in the small frame
NEAR = 0.85  # of the best gain suffices: later CHOICES find more light that a pilot has not seen
AROUND = 2  # pixels on each side of a pixel, whose mean is its level


class Costs(NamedTuple):
    """The cost of a round of work with particles, in rounds without particles."""

    camera_side: float  # paths from the camera are also weighed against particles
    particle_side: float  # particles diverge from each other


# On llvmpipe, 384 x 384 pixels, COSTS are 6 to 13 % more than the time that CHOICES without links
# take on four scenes of smooth glass or metal, and 1 to 25 % more on seven others: they favour
# renders without. COSTS_OF_LINKS, 192 x 192 pixels: 4 % less to 5 % more, on four scenes.
COSTS, COSTS_OF_LINKS = Costs(1.2, 2.0), Costs(1.35, 3.6)

_NONE: Values = {}
_TINY = 1e-300
BY_PILOT = f"auto: variance and counted work of {SAMPLES} samples"


class Finding(NamedTuple):
    """The choice of a pilot."""

    settings: Settings  # settings of the render
    gain: float  # efficiency of the best choice with particles, over that of none

    def decisions(self, given: Values = _NONE) -> dict[str, str]:
        """The reasons for recipes, by the names of settings that were not `given`."""
        more = () if self.settings.caustics == "off" else CHOICES[0].keys() - given.keys()
        return dict.fromkeys(["caustics", *sorted(more)], BY_PILOT)


def may_gain(scene: Scene, settings: Settings) -> bool:
    """Whether a pilot is worth its work: for a long render in which particles can be followed.

    The scene needs glass or metal that is not too rough, for its caustics, or a tiny lamp in view.
    """
    facts = SceneFacts(scene)
    focuses = any(map(makes_caustics, facts.materials.values()))
    return (
        not scene.is_blurred  # particles do not go with an open shutter
        and _pilot_of(settings, settings.samples) > 0
        and (focuses or has_tiny_lamp(scene, settings))
        and refusal(facts, settings_for(settings, caustics="on")) is None
    )


def may_differ(scene: Scene, settings: Settings, begun: int) -> bool:
    """Whether a render of all samples may choose otherwise than one of the `begun` samples."""
    is_other = _pilot_of(settings, begun) != _pilot_of(settings, settings.samples)
    return is_other and may_gain(scene, settings_for(settings, caustics="off"))


def particles_worth(
    scene: Scene,
    settings: Settings,
    context: Context,
    given: Values = _NONE,
    error: float | None = None,
) -> Finding | None:
    """The cheapest way to an error: without particles, or with one choice of them.

    `given` are settings that stay as they are. None if few samples reach `error` anyway. A shorter
    render tries a single choice, in a smaller frame.
    """
    without = settings_for(settings, caustics="off")
    pixels = _pilot_of(settings, settings.samples) or LONG
    plain = _picture(scene, without, context, pixels)
    if error is not None:
        enough = min(pixels, _pilot_of(settings, _samples_to(error, plain)))
        if not enough:
            return None
        if enough < pixels:
            pixels, plain = enough, _picture(scene, without, context, enough)
    found: list[Finding] = []
    for choice in _choices(given, SceneFacts(scene).particles.links != 0, is_short=pixels == SHORT):
        if found and found[0].gain < HOPELESS and not choice["linked"]:
            continue
        wanted = settings_for(settings, caustics="on", **choice)
        found.append(Finding(wanted, _gain(scene, wanted, plain, context, pixels)))
    most = max(finding.gain for finding in found)
    good = [finding for finding in found if finding.gain >= max(NEAR * most, GAIN)]
    return good[-1] if good else Finding(without, most)


def _choices(given: Values, has_links: bool, is_short: bool) -> list[Values]:
    """The choices that differ, with what is `given` in place of their own values.

    If it `is_short`, only the choice with links, or the first one if none has links.
    """
    found: list[Values] = []
    for choice in CHOICES:
        wanted = {**choice, **given}
        if wanted not in found and (has_links or not choice["linked"]):
            found.append(wanted)
    return [found[-1 if found[-1]["linked"] else 0]] if is_short else found


def _pilot_of(settings: Settings, samples: float) -> int:
    """The pixels of a pilot whose cost is a small share of a render of `samples` per pixel.

    0 if every pilot costs more.
    """
    whole = samples * settings.width * settings.height
    fitting = (
        pixels
        for pixels in (LONG, SHORT)
        if whole >= LEAST * SAMPLES * math.prod(_small(settings, pixels).size)
    )
    return next(fitting, 0)


def _samples_to(error: float, plain: Image) -> float:
    """About how many samples per pixel reach the error without particles."""
    assert plain.error is not None  # there are four observations or more
    return SAMPLES * (plain.error / error) ** 2


def _gain(scene: Scene, settings: Settings, plain: Image, context: Context, pixels: int) -> float:
    """The efficiency of these settings, over that of the settings of a plain picture."""
    image = _picture(scene, settings, context, pixels)
    level = around(image.radiance)
    cost = variance_of(level, image.stderr) * _slowed(scene, settings, context)
    variance = variance_of(level, plain.stderr) + _unseen(plain, image, level)
    return variance / max(cost, _TINY)


def around(radiance: Pixels) -> Pixels:
    """The level that the errors of both pictures are relative to: the mean around each pixel.

    A pixel that met a rare bright path is too bright, and its error is large. Relative to that
    pixel alone, the error would count too little in the picture that the level is taken from.
    """
    edges = [(AROUND, AROUND), (AROUND, AROUND), (0, 0)]
    padded = np.pad(radiance, edges, mode="edge")
    size = 2 * AROUND + 1
    windows = np.lib.stride_tricks.sliding_window_view(padded, (size, size), axis=(0, 1))
    return np.asarray(windows.mean(axis=(-2, -1)), radiance.dtype)


def _unseen(plain: Image, other: Image, level: Pixels) -> float:
    """Least variance of light that a plain picture lacks and another picture has; 0 without any.

    Its own errors do not show light that none of its paths has found, such as the caustic of a tiny
    lamp. It is missed in the whole frame, or in tiles where it is bright.
    """
    return max(_unseen_in(side, plain, other, level) for side in (TILE, max(level.shape)))


def _unseen_in(side: int, plain: Image, other: Image, level: Pixels) -> float:
    """The same by tiles of `side` pixels: in each, one path of one pixel would find all of it."""
    rows, columns = (np.arange(count) // side for count in level.shape[:2])
    tiles = (rows[:, None] * (columns[-1] + 1) + columns).ravel()
    counts = np.bincount(tiles)

    def mean_of(pixels: Pixels) -> Floats:
        sums = np.bincount(tiles, pixels.mean(axis=-1, dtype=float).ravel())
        return np.asarray(sums / counts)

    squares = np.square(np.hypot(plain.stderr, other.stderr), dtype=float)
    gaps, sure = mean_of(other.radiance - plain.radiance), np.sqrt(mean_of(squares) / counts)
    errors = np.where(gaps > CERTAIN * sure, gaps * np.sqrt(counts), 0.0)
    return variance_of(
        level, np.broadcast_to(errors[tiles].reshape(*level.shape[:2], 1), level.shape)
    )


def _small(settings: Settings, pixels: int) -> Settings:
    """Settings for the whole frame in at most `pixels` pixels, without AOVs and denoiser.

    Blocks have at most 16 samples, so that the variance of SAMPLES is known.
    """
    scale = min(1.0, math.sqrt(pixels / (settings.width * settings.height)))
    width, height = (max(1, int(scale * n)) for n in (settings.width, settings.height))
    frame: dict[str, Any] = {"width": width, "height": height, "crop": None}
    sampler: Sampler = "sobol" if settings.block > 1 else "independent"
    own = settings_for(settings, **frame, aov=(), denoise="none", samples=SAMPLES, seed=SEED)
    return settings_for(own, sampler=sampler)


def _picture(scene: Scene, settings: Settings, context: Context, pixels: int) -> Image:
    renderer = Renderer(scene, _small(settings, pixels), context, tier="complete")
    try:
        return renderer.render().image()
    finally:
        renderer.release()


def _slowed(scene: Scene, settings: Settings, context: Context) -> float:
    """The work of a sample with particles, over that of a sample without them."""
    small = _small(settings, COUNTED)
    with counting(scene, small, context) as counter:
        both = work_per_sample(counter, settings.bounces, lambda _: True)
        films = counter.image().particles
    assert films is not None
    own = float(films.mean.mean(dtype=float))
    whole_groups = particles_a_sample(small) / particles_a_sample(settings)
    costs = COSTS_OF_LINKS if settings.linked else COSTS
    return costs.camera_side + costs.particle_side * own / whole_groups / (both - own)


def variance_of(level: Pixels, errors: Pixels) -> float:
    """The mean square of errors, relative to a level."""
    error = relative_error(level, errors)
    assert error is not None  # there are four observations or more
    return error**2
