"""Time to an error of 2 % with glrt and with other renderers, in turns of a second and more.

Each renderer is a process of its own; one at a time runs, warm, and the others are stopped. Its
rate in turns is held against its rate alone; where they differ by more than a tenth, the table says
so and the exit code is 1. Mitsuba 3, on the CPU by LLVM, is configured to its advantage, see
`bench.entries`. The WGSL version, which glrt ports to OpenGL, is compared with the method `naive`,
the only one that it has. Renderers that are not installed are named and left out.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench.cold_start import PROGRAMS, starts
from bench.cold_start import table as starts_table
from bench.contest import Array, Lead, Runs, lead_of, seconds_to
from bench.efficiency import SCENES, scene_of
from bench.entries import (
    GLRT,
    MITSUBA,
    PEERS,
    TARGET_ERROR,
    alike,
    best_mitsuba,
    level_of,
    ours,
)
from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.turns import Command, Entry, Pace, complaints, installed, started, taking_turns, verdict
from glrt.analysis.variants import SAMPLERS
from glrt.core import files
from glrt.scene.loading.scene_files import files_of
from glrt.scene.scene import Scene

ROUNDS_OF_STARTS = 5
LEVEL_TURNS = 2.0  # turns' time of the picture that variances are relative to
BACKS_UNSEEN = ("cornell", "room")  # the upper side of their lamp is not visible
MESHES = ("mesh_5", "mesh_6", "mesh_8", "clutter")  # of 20,480 to 1.3 million, and 102,400


@dataclass(frozen=True)
class Row:
    """The figures of one renderer and scene."""

    scene: str
    renderer: str
    samples: int  # per pixel, of each render
    samples_per_second: float  # pixel samples, median
    pace: Pace
    relative_variance: float  # of one sample
    seconds_to_target: float
    rival: str | None  # the renderer it is compared with
    lead: Lead | None  # over the rival


class Contest:
    """glrt and the other renderers that are installed."""

    def __init__(
        self, commands: Mapping[str, Command], size: int, rounds: int, seconds: float
    ) -> None:
        """With renders of `size` x `size` pixels and about `seconds`; `commands` by name."""
        self._commands, self._size = commands, size
        self._rounds, self._seconds = rounds, seconds

    def rows(self, name: str) -> Iterator[Row]:
        """The rows of a scene."""
        scene = scene_of(name)
        entries = [ours(scene, self._size, sampler) for sampler in SAMPLERS]
        level = self._level(entries[0])
        if MITSUBA in self._commands:
            entries.append(self._mitsuba(name, scene, level))
        yield from self._match(name, entries, self._rounds, level)
        if files_of(scene):  # the WGSL version has no meshes
            return
        entries = [entry for entry in alike(scene, self._size) if entry.program in self._commands]
        rounds = max(self._rounds // 3, 2)  # enough, as they differ only in speed
        yield from self._match(name, entries, rounds, level)

    def _match(self, name: str, entries: list[Entry], rounds: int, level: Array) -> Iterator[Row]:
        runs, paces = taking_turns(self._commands, entries, rounds, self._seconds)
        return _rows(name, runs, paces, entries[-1].program != GLRT, level)

    def _level(self, entry: Entry) -> Array:
        with started({GLRT: self._commands[GLRT]}) as peers:
            return level_of(peers, entry, LEVEL_TURNS * self._seconds)

    def _mitsuba(self, name: str, scene: Scene, level: Array) -> Entry:
        known = self._commands, scene, self._size, level, self._seconds
        return best_mitsuba(*known, is_one_sided=name in BACKS_UNSEEN)


def _rows(
    name: str, runs: list[Runs], paces: list[Pace], has_rival: bool, level: Array
) -> Iterator[Row]:
    """A row for each of `runs`; with `has_rival` the last one is the rival of the others."""
    rival = runs[-1] if has_rival else None
    for each, pace in zip(runs, paces, strict=True):
        ahead_of = rival if each is not rival else None
        yield Row(
            scene=name,
            renderer=each.renderer,
            samples=each.samples,
            samples_per_second=float(np.median(each.rates)),
            pace=pace,
            relative_variance=float(each.variances(level).mean()),
            seconds_to_target=seconds_to(TARGET_ERROR, each, level),
            rival=ahead_of.renderer if ahead_of else None,
            lead=lead_of(each, ahead_of, level) if ahead_of else None,
        )


def table(rows: list[Row]) -> Iterator[str]:
    """The rows as Markdown; gains are the factors of `Lead`."""
    columns = ["scene", "renderer", "samples", "million samples/s", "in turns / alone"]
    columns += ["variance", "to 2 %", "time gain", "rate gain", "variance gain"]
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for row in rows:
        lead = [str(factor) for factor in row.lead] if row.lead else [""] * 3
        yield (
            f"| {row.scene} | {row.renderer} | {row.samples} "
            f"| {row.samples_per_second / 1e6:.2f} | {row.pace} | {row.relative_variance:.3g} "
            f"| {row.seconds_to_target:.3g} s | {' | '.join(lead)} |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.rivals`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> int:
    versions = installed(PEERS)
    place = machine(*versions.values())
    work = (
        f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} rounds, "
        f"turns of about {parsed.seconds:g} s"
    )
    print(f"{place}, {work}\n")
    commands = {name: PEERS[name] for name in versions}
    contest = Contest(commands, parsed.size, parsed.rounds, parsed.seconds)
    rows: list[Row] = []
    for name in parsed.scenes:
        print(f"{name} ...", file=sys.stderr)
        rows += contest.rows(name)
    print("\n".join(table(rows)))
    names = [f"{row.scene}, {row.renderer}" for row in rows]
    found = list(complaints(names, [row.pace for row in rows], parsed.seconds))
    print("\n" + verdict(found))
    first = starts(PROGRAMS, ROUNDS_OF_STARTS)
    print("\n" + "\n".join(starts_table(first)))
    if parsed.json:
        figures = {
            "place": place,
            "work": work,
            "complaints": found,
            "rows": [_plain(row) for row in rows],
            "first pictures": {name: start._asdict() for name, start in first.items()},
        }
        files.write_text(parsed.json, json.dumps(figures, indent=1) + "\n")
    return 1 if found else 0


def _plain(row: Row) -> dict[str, Any]:
    lead = (
        {name: factor._asdict() for name, factor in row.lead._asdict().items()}
        if row.lead
        else None
    )
    return {**asdict(row), "pace": row.pace._asdict(), "lead": lead}


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("rivals", __doc__)
    add = parser.add_argument
    add("--scenes", nargs="+", choices=[*SCENES, *MESHES], metavar="NAME", default=SCENES)
    add_rounds(parser, size=256, rounds=16)
    add("--seconds", type=float, default=1.5, metavar="S", help="time of a turn (default: 1.5)")
    add("--json", type=Path, metavar="FILE", help="file for the figures as JSON")
    return parser


if __name__ == "__main__":
    sys.exit(main())
