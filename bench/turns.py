"""Renderers that take turns: one warm process at a time, and whether its speed is that of alone.

Between its turns a process is stopped with all of its threads. Its rate in turns is held against
its rate alone: that of the only process, in renders twice as long, one after the other. Where both
differ by more than a tenth, neither describes the renderer.
"""

import statistics
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from bench.contest import Runs
from bench.peer import Peer, Request
from glrt.core.errors import RenderError
from glrt.settings import MAX_SAMPLES

LEAST_SECONDS = 1.0  # of a turn: shorter ones measure what starts and ends a render
MOST_APART = 0.1  # of a rate in turns from the rate alone
ROUNDS_ALONE = 3
LONGER = 2  # times as long as a turn are renders alone
TRIAL = 16  # samples, at least, from which the number that fills a turn is taken

Picture = np.ndarray[Any, np.dtype[np.float32]]
Render = Callable[[int, int], tuple[Picture, float]]  # samples, seed -> picture, seconds
Command = Sequence[str]


@dataclass(frozen=True)
class Contender:
    """A renderer that is ready to render a scene."""

    name: str
    render: Render
    block: int = 1  # numbers of samples are multiples of it


@dataclass(frozen=True)
class Entry:
    """A renderer of a scene by name: what its process is asked for."""

    name: str
    program: str
    request: Request
    block: int = 1

    def contender(self, peers: Mapping[str, Peer]) -> Contender:
        """Rendered by the process of its program."""
        peer = peers[self.program]

        def render(samples: int, seed: int) -> tuple[Picture, float]:
            image, seconds = peer.render(replace(self.request, samples=samples, seed=seed))
            return image.radiance, seconds

        return Contender(self.name, render, self.block)


class Pace(NamedTuple):
    """Pixel samples a second of a renderer: medians."""

    in_turns: float
    alone: float

    @property
    def ratio(self) -> float:
        """In turns, over alone."""
        return self.in_turns / self.alone

    @property
    def is_kept(self) -> bool:
        """Whether taking turns changes the rate by no more than MOST_APART."""
        return abs(self.ratio - 1) <= MOST_APART

    def __str__(self) -> str:
        return f"{self.ratio:.2f}" + ("" if self.is_kept else " (!)")


@contextmanager
def started(commands: Mapping[str, Command]) -> Iterator[dict[str, Peer]]:
    """The processes of some programs, each stopped until it has its turn; they end afterwards."""
    with ExitStack() as stack:
        peers = {}
        for name, command in commands.items():
            peers[name] = Peer(command, is_paused_at_rest=True)
            stack.callback(peers[name].close)
        yield peers


def installed(commands: Mapping[str, Command]) -> dict[str, str]:
    """Names with versions of the programs that start; the others are named on stderr."""
    found = {}
    for name, command in commands.items():
        try:
            with started({name: command}) as peers:
                found[name] = peers[name].name
        except RenderError as error:
            print(f"Without {name}: {error}", file=sys.stderr)
    return found


def taking_turns(
    commands: Mapping[str, Command], entries: Sequence[Entry], rounds: int, seconds: float
) -> tuple[list[Runs], list[Pace]]:
    """Interleaved renders of all entries, about `seconds` each, and the paces that they keep."""
    alone = [pace_alone(commands, entry, seconds) for entry in entries]
    with started({entry.program: commands[entry.program] for entry in entries}) as peers:
        runs = interleaved([entry.contender(peers) for entry in entries], rounds, seconds)
    return runs, [pace(each, rate) for each, rate in zip(runs, alone, strict=True)]


def pace(runs: Runs, alone: float) -> Pace:
    """The pace of a renderer in turns, with its rate alone."""
    return Pace(float(np.median(runs.rates)), alone)


def pace_alone(commands: Mapping[str, Command], entry: Entry, seconds: float) -> float:
    """The rate of an entry in a process that is the only one."""
    with started({entry.program: commands[entry.program]}) as peers:
        return rate_alone(entry.contender(peers), seconds)


def rate_alone(contender: Contender, seconds: float) -> float:
    """Pixel samples a second in renders one after the other: the median."""
    samples = samples_for(contender, LONGER * seconds)
    rates = []
    for seed in range(1, ROUNDS_ALONE + 1):
        picture, taken = contender.render(samples, seed)
        rates.append(picture[..., 0].size * samples / taken)
    return statistics.median(rates)


def interleaved(
    contenders: Sequence[Contender],
    rounds: int,
    seconds: float,
    first_seed: int = 1,
    multiple: int = 1,
) -> list[Runs]:
    """Interleaved renders of about `seconds` each, in `multiple` times so many whole blocks."""
    samples = [samples_for(each, seconds, multiple) for each in contenders]
    return interleaved_of(contenders, samples, rounds, first_seed)


def interleaved_of(
    contenders: Sequence[Contender], samples: Sequence[int], rounds: int, first_seed: int = 1
) -> list[Runs]:
    """Interleaved renders of so many samples for each contender."""
    renders: list[list[tuple[Picture, float]]] = [[] for _ in contenders]
    for seed in range(first_seed, first_seed + rounds):
        for each, count, done in zip(contenders, samples, renders, strict=True):
            done.append(each.render(count, seed))
    return [
        Runs(
            renderer=each.name,
            samples=count,
            seconds=np.array([taken for _, taken in done]),
            pictures=np.stack([picture for picture, _ in done]),
        )
        for each, count, done in zip(contenders, samples, renders, strict=True)
    ]


def samples_for(contender: Contender, seconds: float, multiple: int = 1) -> int:
    """The samples that take about `seconds`, in whole blocks; they are rendered once to warm up."""
    step = contender.block * multiple
    samples = -(-TRIAL // contender.block) * contender.block

    def trial() -> float:
        """Seconds of the second render: the first one compiles."""
        return [contender.render(samples, 0)[1] for _ in range(2)][1]

    while (taken := trial()) < seconds / 2 and samples < MAX_SAMPLES:
        samples *= 2
    found = max(round(seconds / taken * samples / step), 1) * step
    contender.render(found, 0)
    return found


def complaints(names: Sequence[str], paces: Sequence[Pace], seconds: float) -> Iterator[str]:
    """Why the figures must not be quoted, if they must not: a sentence for each reason."""
    if seconds < LEAST_SECONDS:
        yield f"Turns of {seconds:g} s are too short: {LEAST_SECONDS:g} s or more."
    for name, found in zip(names, paces, strict=True):
        if not found.is_kept:
            yield (
                f"{name}: {found.in_turns / 1e6:.2f} million samples/s in turns, "
                f"{found.alone / 1e6:.2f} alone, {found.ratio:.2f} times as many."
            )


def verdict(found: Sequence[str]) -> str:
    """The complaints as a paragraph, or that there is none."""
    if not found:
        return f"Every rate in turns is within {MOST_APART:.0%} of the rate alone."
    return "NOT TO BE QUOTED:\n" + "\n".join(f"- {text}" for text in found)
