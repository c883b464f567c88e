"""Options of `glrt chart` for what the window shows while something moves."""

import argparse
import itertools
import math
from typing import Any, get_args

from glrt.core.errors import UsageError
from glrt.rendering.history.ataa import CHOICES, SAMPLES
from glrt.rendering.history.lattice import FACTORS
from glrt.rendering.history.temporal import Mode, Way
from glrt.rendering.history.upsample import FACTOR
from glrt.rendering.history.wrls import Predictor
from glrt.rendering.probe_supply import HYSTERESIS


def add_moving(parser: argparse.ArgumentParser) -> None:
    """Add the options to the parser of the command."""
    parser.add_argument(
        "--temporal",
        metavar="MODE,...",
        help="chart the error of what the window shows while the camera moves and after the light "
        f"changes, in place of methods; of {', '.join(get_args(Mode))}. No clock is read without "
        "--milliseconds: --rounds and --seconds are not used",
    )
    parser.add_argument(
        "--milliseconds",
        action="store_true",
        help="with --temporal, chart the error against the median milliseconds of a frame, too, "
        "over --rounds rounds in which the modes take turns",
    )
    parser.add_argument(
        "--predictor",
        metavar="NAME,...",
        default="published",
        help="what wrls of --temporal predicts from; of published, delayed (default: published)",
    )
    parser.add_argument(
        "--traced",
        metavar="N,...",
        default=str(SAMPLES),
        help="samples that ataa of --temporal traces where history fails, "
        f"{CHOICES[0]} to {CHOICES[-1]} (default: {SAMPLES})",
    )
    parser.add_argument(
        "--factor",
        metavar="K,...",
        default=str(FACTOR),
        help="one pixel in K x K is sampled by upsample of --temporal, and a small picture that "
        "takes as many rays is charted, too; of "
        f"{', '.join(map(str, FACTORS))} (default: {FACTOR})",
    )
    parser.add_argument(
        "--hysteresis",
        metavar="H,...",
        help="with --temporal, chart method ddgi, too: with probes of their own for each picture, "
        "and with live ones that keep such a share of what they hold (the window's: "
        f"{HYSTERESIS:g})",
    )


def ways_of(arguments: argparse.Namespace) -> tuple[Way, ...]:
    """Return the modes to chart in order, each with all values of its own option."""
    predictors = _chosen("--predictor", arguments.predictor, get_args(Predictor))
    traced = _chosen("--traced", arguments.traced, tuple(map(str, CHOICES)))
    factors = _chosen("--factor", arguments.factor, tuple(map(str, FACTORS)))
    modes = _chosen("--temporal", arguments.temporal, get_args(Mode))
    options = [*itertools.product(predictors, map(int, traced), map(int, factors))]
    found = [Way(mode, *chosen) for mode in modes for chosen in options]
    return tuple({way.name: way for way in found}.values())


def hysteresis_of(arguments: argparse.Namespace) -> tuple[float, ...]:
    """Return the values of --hysteresis, from 0 to below 1; empty if it is not given."""
    if arguments.hysteresis is None:
        return ()
    if arguments.temporal is None:
        raise UsageError("--hysteresis is of live probes while something moves: give --temporal.")
    try:
        given = tuple(dict.fromkeys(map(float, arguments.hysteresis.split(","))))
    except ValueError:
        given = (math.nan,)
    if not all(0 <= kept < 1 for kept in given):
        raise UsageError(
            f"--hysteresis takes shares from 0 to below 1, with commas between; got "
            f"{arguments.hysteresis!r}."
        )
    return given


def _chosen(option: str, given: str | None, known: tuple[Any, ...]) -> tuple[Any, ...]:
    names = given.split(",") if given is not None else []
    if unknown := [name for name in names if name not in known]:
        raise UsageError(f"{option} takes {', '.join(known)}; got {unknown[0]!r}.")
    return tuple(dict.fromkeys(names))
