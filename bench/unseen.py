"""The lead over Mitsuba on scenes that nobody has seen: drawn from a hash of the program itself.

Every change of glrt/ or shaders_glsl/ draws other scenes of `bench.landscapes`, so that none can be
tuned for. In each scene glrt and Mitsuba at its best (`bench.entries`) take turns with sixteen
independent renders of their own. glrt has the blocks that `glrt render` takes for the samples to
2 %, of 256 at most, and particles where its pilot finds that they pay, whose time does not count.
Multijittered samples of Mitsuba come in sets at least as large as glrt's blocks.
Errors are relative RMS, about each renderer's own mean. Seconds to 2 % are extrapolated by t^-1/2,
and the slope is checked by sixteen renders each of a quarter of the samples: scenes where one does
not have it are listed apart, and are counted in a mean of their own.
Exit code 1 if a rate in turns is not that of alone.
"""

import argparse
import hashlib
import json
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from bench.contest import (
    Array,
    Factor,
    Redrawn,
    Runs,
    Slope,
    distance,
    over_scenes,
    seconds_to,
    slope_of,
    time_lead_of,
)
from bench.entries import (
    GLRT,
    MITSUBA,
    PEERS,
    TARGET_ERROR,
    best_mitsuba,
    by_default,
    level_of,
    samples_to,
)
from bench.landscapes import landscape
from bench.processes import ROOT
from bench.program import add_rounds, at_least, exit_code_of, machine, parser_of
from bench.turns import (
    Command,
    Entry,
    Pace,
    complaints,
    installed,
    interleaved,
    interleaved_of,
    pace,
    pace_alone,
    started,
    verdict,
)
from glrt.core import files
from glrt.core.errors import RenderError
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh

HASHED = ("glrt", "shaders_glsl")
UNHASHED = ("__pycache__",)
QUARTER = 4  # times as many samples in the renders that count as in those of the slope
SLOPE_SEED = 500  # the first one of the renders of a quarter of the samples
TRIAL_SIZE = 256  # pixels on a side, at most, of Mitsuba's trial: 64 samples of more take minutes
LEVEL_SECONDS = 4.0


class Result(NamedTuple):
    """The figures of a scene; pairs are of glrt and of Mitsuba."""

    seed: int
    about: str
    names: tuple[str, str]
    samples: tuple[int, int]  # per pixel, of each render
    paces: tuple[Pace, Pace]
    slopes: tuple[Slope, Slope]
    seconds: tuple[float, float]  # to TARGET_ERROR
    lead: Redrawn
    distance: float  # relative, between what both converge to

    @property
    def has_slopes(self) -> bool:
        """Whether the error of both may fall as t^-1/2."""
        return all(slope.is_half for slope in self.slopes)


def seed_of(root: Path = ROOT) -> int:
    """The first seed: 32 bits of a hash of all files of HASHED and of their names."""
    digest = hashlib.sha256()
    for path in sorted(path for name in HASHED for path in (root / name).rglob("*")):
        if path.is_file() and not {*path.parts} & {*UNHASHED}:
            name = path.relative_to(root).as_posix()
            digest.update(f"{name} {path.stat().st_size}\n".encode() + path.read_bytes())
    return int(digest.hexdigest()[:8], 16)


def measure(
    commands: Mapping[str, Command], seed: int, size: int, rounds: int, seconds: float
) -> Result:
    """Render a scene by its seed; RenderError if a renderer refuses it."""
    return measure_scene(commands, landscape(seed), "", size, rounds, seconds, seed)


def measure_scene(
    commands: Mapping[str, Command],
    scene: Scene,
    about: str,
    size: int,
    rounds: int,
    seconds: float,
    seed: int = 0,
) -> Result:
    """Render a scene called `about`; RenderError if a renderer refuses it, or if it is black."""
    own, small = by_default(scene, size), min(size, TRIAL_SIZE)
    with started({GLRT: commands[GLRT]}) as peers:
        level = trial_level = level_of(peers, own, LEVEL_SECONDS)
        if not level.any():
            raise RenderError("its picture is black: no light reaches the camera.")
        if small < size:
            trial_level = level_of(peers, by_default(scene, small), LEVEL_SECONDS)
        own = by_default(scene, size, samples_to(TARGET_ERROR, peers, own, level))
    rival = best_mitsuba(commands, scene, small, trial_level)
    sets = max(rival.block, own.block) if rival.block > 1 else 1  # as many that belong together
    rival = replace(rival, request=replace(rival.request, width=size, height=size), block=sets)
    alone = [pace_alone(commands, entry, seconds) for entry in (own, rival)]
    few, many = _runs(commands, (own, rival), rounds, seconds)
    return result(seed, about or _about(scene), few, many, alone, level)


def _runs(
    commands: Mapping[str, Command], entries: Sequence[Entry], rounds: int, seconds: float
) -> tuple[list[Runs], list[Runs]]:
    """Renders in turns: of a quarter of the samples, and of all."""
    with started(commands) as peers:
        contenders = [entry.contender(peers) for entry in entries]
        many = interleaved(contenders, rounds, seconds, multiple=QUARTER)
        quarters = [each.samples // QUARTER for each in many]
        return interleaved_of(contenders, quarters, rounds, SLOPE_SEED), many


def result(
    seed: int,
    about: str,
    few: Sequence[Runs],
    many: Sequence[Runs],
    alone: Sequence[float],
    level: Array,
) -> Result:
    """The figures of a scene, from renders of glrt and of Mitsuba, in this order."""
    (own, rival), (own_few, rival_few) = many, few
    return Result(
        seed=seed,
        about=about,
        names=(own.renderer, rival.renderer),
        samples=(own.samples, rival.samples),
        paces=(pace(own, alone[0]), pace(rival, alone[1])),
        slopes=(slope_of(own_few, own, level), slope_of(rival_few, rival, level)),
        seconds=(seconds_to(TARGET_ERROR, own, level), seconds_to(TARGET_ERROR, rival, level)),
        lead=time_lead_of(own, rival, level),
        distance=distance(own, rival, level),
    )


def _about(scene: Scene) -> str:
    """The contents of a scene, in a few words."""
    lamps = sum(any(scene.emission_of(item)) for item in scene.objects)
    kinds = {scene.materials[item.material].type for item in scene.objects}
    names = {"metal": "metal", "dielectric": "glass"}
    words = [f"{len(scene.objects)} shapes", f"{lamps} lamps"]
    words += [name for kind, name in names.items() if kind in kinds]
    words += ["lens"] * bool(scene.camera.defocus_angle)
    meshes = [item for item in scene.objects if isinstance(item, Mesh)]
    triangles = sum(len(item.triangles.faces) for item in meshes)
    words += [f"{triangles:,} triangles"] * bool(meshes)
    words += ["clear sky"] * bool(scene.background.sky)
    return ", ".join(words + ["image of the sky"] * bool(scene.background.image))


def table(results: Sequence[Result]) -> Iterator[str]:
    """The scenes as Markdown; pairs are of glrt and of Mitsuba."""
    columns = ["seed", "scene", "glrt with", "Mitsuba with", "samples", "million samples/s"]
    columns += ["in turns / alone", "slope of glrt", "of Mitsuba", "to 2 %", "lead", "means apart"]
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for found in results:
        rates = ", ".join(f"{pace.in_turns / 1e6:.2f}" for pace in found.paces)
        ways = (found.names[0].removeprefix("glrt, "), found.names[1].removeprefix("Mitsuba, "))
        cells = [found.seed, found.about, *ways]
        cells += ["{}, {}".format(*found.samples), rates, "{}, {}".format(*found.paces)]
        cells += [*found.slopes, "{:.3g} s, {:.3g} s".format(*found.seconds)]
        cells += [found.lead.factor, f"{100 * found.distance:.1f} %"]
        yield f"| {' | '.join(map(str, cells))} |"


def report(results: Sequence[Result]) -> Iterator[str]:
    """Both tables, and what is over all scenes."""
    with_slopes = [found for found in results if found.has_slopes]
    without = [found for found in results if not found.has_slopes]
    yield from table(with_slopes)
    if without:
        yield "\nThe error of one renderer does not fall as t^-1/2 here (99 % intervals):\n"
        yield from table(without)
    yield ""
    if with_slopes:
        yield f"Scenes with the slope of t^-1/2: {_summary(with_slopes)}"
    if without:
        yield f"All scenes: {_summary(results)}"


def _summary(results: Sequence[Result]) -> str:
    leads = [found.lead for found in results]
    factors: list[Factor] = sorted(lead.factor for lead in leads)
    return (
        f"{len(leads)}; lead of glrt over Mitsuba, geometric mean {over_scenes(leads)}, "
        f"worst {factors[0]}, best {factors[-1]}."
    )


def measured(
    parsed: argparse.Namespace, commands: Mapping[str, Command], first: int
) -> Iterator[Result]:
    """The scenes one after the other, as long as there is time for one more."""
    begin, longest = time.monotonic(), 0.0
    for seed in range(first, first + parsed.scenes):
        start = time.monotonic()
        if seed > first and start - begin + longest > 60 * parsed.minutes:
            print(f"{seed - first} scenes of {parsed.scenes}: no time for more", file=sys.stderr)
            return
        try:
            found = measure(commands, seed, parsed.size, parsed.rounds, parsed.seconds)
        except RenderError as error:
            print(f"seed {seed} is left out: {error}", file=sys.stderr)
            continue
        longest = max(longest, time.monotonic() - start)
        print(f"seed {seed}: {found.lead.factor}, {longest:.0f} s", file=sys.stderr)
        yield found


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.unseen`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> int:
    commands = {name: PEERS[name] for name in (GLRT, MITSUBA)}
    versions = installed(commands)
    if len(versions) < len(commands):
        raise RenderError("glrt is compared with Mitsuba here: it needs both.")
    first = seed_of() if parsed.seed is None else parsed.seed
    place = machine(*versions.values())
    work = (
        f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} renders of each, "
        f"turns of about {parsed.seconds:g} s, seeds from {first} on"
    )
    results: list[Result] = []
    for found in measured(parsed, commands, first):
        results.append(found)
        if parsed.json:
            figures = {"place": place, "work": work, "scenes": [*map(plain, results)]}
            files.write_text(parsed.json, json.dumps(figures, indent=1) + "\n")
    if not results:
        raise RenderError("no scene was rendered.")
    print(f"{place}, {work}\n")
    print("\n".join(report(results)))
    names = [f"seed {found.seed}, {name}" for found in results for name in found.names]
    paces = [pace for found in results for pace in found.paces]
    wrong = list(complaints(names, paces, parsed.seconds))
    print("\n" + verdict(wrong))
    return 1 if wrong else 0


def plain(found: Result) -> dict[str, Any]:
    """Its figures for JSON."""
    return {**found._asdict(), "lead": found.lead.factor._asdict()}


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("unseen", __doc__)
    add = parser.add_argument
    add("--scenes", type=at_least(1), default=24, metavar="N", help="at most (default: 24)")
    told = "the first one (default: from the hash); for the scenes of a printed table"
    add("--seed", type=at_least(0), metavar="SEED", help=told)
    told = "no scene begins that would end later (default: 55)"
    add("--minutes", type=float, default=55, metavar="M", help=told)
    add_rounds(parser, size=256, rounds=16)
    add("--seconds", type=float, default=1.5, metavar="S", help="time of a turn (default: 1.5)")
    add("--json", type=Path, metavar="FILE", help="file for the figures, written after each scene")
    return parser


if __name__ == "__main__":
    sys.exit(main())
