"""Milliseconds of a frame, for each way to play a sequence; the ways take turns."""

import random
import statistics
from collections.abc import Callable, Mapping

from glrt.analysis.chart.curves import Interval
from glrt.analysis.motion.playing import Played, play
from glrt.analysis.motion.sequences import Sequence
from glrt.gpu.context import Context


def milliseconds_of(
    sequence: Sequence,
    ways: Mapping[str, Played],
    context: Context,
    samples: int,
    rounds: int,
    report: Callable[[int], None],
) -> dict[str, Interval]:
    """Median and quartiles of the milliseconds of a frame, over all rounds, by the name of the way.

    A round plays each way once. The ways take turns after each frame, in another order each time,
    so that other load affects all alike. They must have been played before: then nothing is
    compiled. The first frame does not count, as it has no history; neither do frames before the
    first that is looked at. `report` receives the number of each round.
    """
    seconds: dict[str, list[float]] = {name: [] for name in ways}
    for number in range(rounds):
        report(number)
        order, names = random.Random(number), [*ways]
        spent: dict[str, list[float]] = {name: [] for name in ways}
        players = {
            name: play(sequence, way, context, samples, seconds=spent[name])
            for name, way in ways.items()
        }
        for _ in (*sequence.scenes, None):  # the last step releases what they hold
            order.shuffle(names)
            for name in names:
                next(players[name], None)
        for name in ways:
            seconds[name] += spent[name][max(sequence.first, 1) :]
    return {name: _quartiles([1e3 * one for one in spent]) for name, spent in seconds.items()}


def _quartiles(values: list[float]) -> Interval:
    low, median, high = statistics.quantiles(values, n=4, method="inclusive")
    return Interval(median, low, high)
