"""The lead over Mitsuba in volumes: fog, coloured fog, smoke of a grid, milk in a glass.

The scenes are those of `tests/crosscheck/test_mitsuba_media.py`, in which both show the same.
They are measured as in `bench.unseen`: in turns, each with independent renders of its own, by
seconds to 2 %, whose slope is checked. Mitsuba follows light by `volpathmis`. Exit code 1 if a rate
in turns is not that of alone. The gate of volumes is a lead of 1 or more on each, at `--size 512`.
"""

import argparse
import json
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

from bench.entries import GLRT, MITSUBA, PEERS
from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.turns import Command, complaints, installed, verdict
from bench.unseen import Result, measure_scene, plain, report
from glrt.core import files
from glrt.core.errors import RenderError
from glrt.scene.scene import Scene
from tests.mitsuba.media import SCENES


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.volumes_rivals`; returns the exit code."""
    parser = parser_of("volumes_rivals", __doc__)
    add = parser.add_argument
    add(
        "--scenes",
        nargs="+",
        choices=SCENES,
        default=[*SCENES],
        metavar="NAME",
        help="default: all",
    )
    add_rounds(parser, size=128, rounds=8)
    add("--seconds", type=float, default=1.5, metavar="S", help="time of a turn (default: 1.5)")
    add("--json", type=Path, metavar="FILE", help="file for the figures, written after each scene")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def scene_of(name: str) -> Scene:
    """A scene by its name in SCENES, with its limit of bounces."""
    make, medium, bounces = SCENES[name]
    scene = make(medium)
    limited = scene.render.model_copy(update={"bounces": bounces})
    return scene.model_copy(update={"render": limited})


def _results(parsed: argparse.Namespace, commands: Mapping[str, Command]) -> Iterator[Result]:
    for name in parsed.scenes:
        start = time.monotonic()
        measures = parsed.size, parsed.rounds, parsed.seconds
        found = measure_scene(commands, scene_of(name), name, *measures)
        print(f"{name}: {found.lead.factor}, {time.monotonic() - start:.0f} s", file=sys.stderr)
        yield found


def _print(parsed: argparse.Namespace) -> int:
    commands = {name: PEERS[name] for name in (GLRT, MITSUBA)}
    versions = installed(commands)
    if len(versions) < len(commands):
        raise RenderError("glrt is compared with Mitsuba here: it needs both.")
    place = machine(*versions.values())
    work = (
        f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} renders of each, "
        f"turns of about {parsed.seconds:g} s"
    )
    results: list[Result] = []
    for found in _results(parsed, commands):
        results.append(found)
        if parsed.json:
            figures = {"place": place, "work": work, "scenes": [*map(plain, results)]}
            files.write_text(parsed.json, json.dumps(figures, indent=1) + "\n")
    print(f"{place}, {work}\n")
    print("\n".join(report(results)))
    names = [f"{found.about}, {name}" for found in results for name in found.names]
    paces = [pace for found in results for pace in found.paces]
    wrong = list(complaints(names, paces, parsed.seconds))
    print("\n" + verdict(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
