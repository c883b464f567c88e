"""`--sampler auto`: blocks of 64 samples for long renders, and of 16 for others."""

import argparse

from glrt.cli.options import AUTO, is_automatic
from glrt.samplers import DIVISIONS
from glrt.settings import Sampler, Settings, settings_for

LONG: Sampler = "sobol64"
BLOCKS = 8  # of a long render, at least: its error is estimated from their spread
LEAST = BLOCKS * DIVISIONS[LONG].block  # samples per pixel
METHODS = ("naive", "nee", "mis")  # those for which it was measured
BY_LENGTH = f"auto: {LEAST} samples or more"


def with_sampler(arguments: argparse.Namespace, settings: Settings) -> Settings:
    """Return settings of a new render, with blocks of 64 if it is long and that is left open.

    With `--time` or `--error` a render may end early, before the error of such blocks is known.
    More parts than such blocks need smaller ones.
    """
    fits = not arguments.part or arguments.part[1] * DIVISIONS[LONG].block <= settings.samples
    is_taken = fits and not is_automatic(arguments) and _is_long(arguments, settings)
    return settings_for(settings, sampler=LONG) if is_taken else settings


def kept(arguments: argparse.Namespace, settings: Settings) -> str:
    """Return a sentence if a picture goes on with a sampler that one render would not take."""
    if settings.sampler == LONG or not _is_long(arguments, settings):
        return ""
    return (
        f"Rendering with --sampler {settings.sampler}, as the picture began. One render of "
        f"{settings.samples} samples takes {LONG} by default, and has other bits."
    )


def _is_long(arguments: argparse.Namespace, settings: Settings) -> bool:
    """Whether a new render would take blocks of 64."""
    is_open = getattr(arguments, "sampler", AUTO) == AUTO
    is_fixed = arguments.time is None and arguments.error is None and settings.adaptive != "on"
    return is_open and is_fixed and settings.samples >= LEAST and settings.method in METHODS
