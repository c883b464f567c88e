"""`--sampler auto`: blocks of 64 samples or more for long renders, and of 16 for others."""

import argparse
import math

from glrt.cli.options import AUTO, is_automatic
from glrt.image.image import Image
from glrt.samplers import DIVISIONS
from glrt.settings import Sampler, Settings, settings_for

LONG: tuple[Sampler, ...] = ("sobol64", "sobol256", "sobol1024")  # by ascending blocks
BLOCKS = 8  # of a long render, at least: its error is estimated from their spread
LEAST = BLOCKS * DIVISIONS[LONG[0]].block  # samples per pixel of a long render
METHODS = ("naive", "nee", "mis")  # those for which it was measured
MANY = 32  # times the samples of a first look: so few of them may be lost
MUCH = 1 << 25  # samples of all pixels, which take longer than another kernel compiles
BY_ERROR = "auto: many samples to --error"


def with_sampler(arguments: argparse.Namespace, settings: Settings) -> Settings:
    """Return settings of a new render, with larger blocks if it is long and that is left open.

    With `--time` or `--error` a render may end early, before the error of such blocks is known: see
    `sampler_to_error`.
    """
    if is_automatic(arguments):
        return settings
    return settings_for(settings, sampler=_by_length(arguments, settings))


def sampler_for(samples: int, parts: int = 1) -> Sampler:
    """Return the sampler with the largest blocks that fit BLOCKS times, and once in each part."""
    fits = (it for it in LONG if samples >= max(BLOCKS, parts) * DIVISIONS[it].block)
    return max(fits, key=lambda it: DIVISIONS[it].block, default="sobol")


def by_length(sampler: Sampler) -> str:
    """Return why a render has a sampler of LONG."""
    return f"auto: {BLOCKS * DIVISIONS[sampler].block} samples or more"


def kept(arguments: argparse.Namespace, settings: Settings) -> str:
    """Return a sentence if a picture goes on with a sampler that one render would not take."""
    wanted = _by_length(arguments, settings)
    if wanted == settings.sampler:
        return ""
    return (
        f"Rendering with --sampler {settings.sampler}, as the picture began. One render of "
        f"{settings.samples} samples takes {wanted} by default, and has other bits."
    )


def may_lengthen(arguments: argparse.Namespace, settings: Settings) -> bool:
    """Whether a new render to `--error` may take longer blocks after a first look."""
    is_open = getattr(arguments, "sampler", AUTO) == AUTO and not is_automatic(arguments)
    is_plain = settings.adaptive != "on" and settings.denoise == "none"
    ends_by_error = arguments.error is not None and arguments.time is None
    return is_open and is_plain and ends_by_error and settings.method in METHODS


def sampler_to_error(image: Image, error: float, most: int) -> Sampler:
    """Return the sampler for a render to an error, by a first look at its picture.

    It has long blocks if the forecast, up to `most` samples per pixel, is MANY times the samples of
    the picture and MUCH in all: these samples are lost, and another kernel compiles.
    """
    needed = min(image.samples * ((image.error or 0.0) / error) ** 2, most)
    is_long = needed >= MANY * image.samples
    is_much = needed * math.prod(image.radiance.shape[:2]) >= MUCH
    return sampler_for(int(needed)) if is_long and is_much else "sobol"


def _by_length(arguments: argparse.Namespace, settings: Settings) -> Sampler:
    """The sampler of a new render with these settings, which keep theirs if it is not open."""
    is_open = getattr(arguments, "sampler", AUTO) == AUTO
    is_fixed = arguments.time is None and arguments.error is None and settings.adaptive != "on"
    if not (is_open and is_fixed and settings.method in METHODS):
        return settings.sampler
    found = sampler_for(settings.samples, arguments.part[1] if arguments.part else 1)
    return found if found in LONG else settings.sampler
