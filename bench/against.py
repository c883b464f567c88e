"""Measure whether this checkout is slower than another commit, in interleaved renders.

Each side is a process that imports glrt from its own files and renders on request; both use the
same seeds. It compiles once per scene with empty caches. Each round starts both processes again, as
equal programs differ by 2 % from one start to the next, and no interval over the rounds of one
start contains that. A ratio is the time of this checkout over that of the other in the same round,
until the picture is read back; `bench.ratios` describes the intervals. The exit code is 1 if this
checkout is slower over all scenes together, else 0; one in twenty intervals of single scenes does
not contain the true ratio.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass
from itertools import count
from pathlib import Path
from typing import Any, get_args

from bench.checkouts import commit_of, exported, state_of
from bench.processes import ROOT, Process, environment_of
from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.ratios import LEAST_ROUNDS, Ratio, ratio_of, ratio_over
from glrt.core import files
from glrt.core.errors import RenderError
from glrt.scene.scenefile.catalog import find
from glrt.settings import MAX_SAMPLES, Method

SCENES = ("cornell", "lamps", "lens", "metals", "sky", "weekend")
PROGRAM = Path(__file__).with_name("against_side.py")
TRIAL_SEEDS = 1 << 31  # the first seed of trials; those of rounds start at 1
WARM_UP = 4  # a new process first renders one WARM_UP-th of the samples of a run
LEAST_TRIAL = 1 / 2  # least time of a trial, relative to that of a run


class Side:
    """The process of one checkout."""

    def __init__(self, name: str, start: Callable[[], Process]) -> None:
        """Start the process, and read where it imports glrt from."""
        self.name, self._start = name, start
        self._begin()

    def restart(self) -> None:
        """End the process and start a new one, with the same caches of drivers."""
        self.end()
        self._begin()

    def _begin(self) -> None:
        self._process = self._start()
        try:
            self.glrt = Path(self._named(self._process.answer)["glrt"])
        except RenderError:
            self.end()
            raise

    def end(self) -> None:
        """End the process."""
        self._process.close()

    def ask(self, do: str, **words: Any) -> dict[str, Any]:
        """Send a request and return the answer; RenderError names the side that failed."""
        return self._named(lambda: self._process.ask({"do": do, **words}))

    def _named(self, answer: Any) -> dict[str, Any]:
        """The result of `answer`; errors are prefixed with the name of the side."""
        try:
            found: dict[str, Any] = answer()
            return found
        except RenderError as error:
            raise RenderError(f"{self.name}: {error}") from None


@dataclass(frozen=True)
class Row:
    """The measurements of one scene, of this checkout and of the other."""

    scene: str
    samples: int  # per pixel, of each run
    these: list[float]  # seconds, one per round
    others: list[float]
    compile_seconds: tuple[float, float]
    peak_bytes: tuple[int, int]  # peak memory of the processes of the last round
    equal: bool  # whether all pictures have the same bits

    @property
    def ratio(self) -> Ratio:
        """The ratio of the times."""
        return ratio_of(self.these, self.others)


@contextmanager
def sides(commit: str, threads: int | None) -> Iterator[tuple[Side, Side]]:
    """Start a process for this checkout and one for a commit; end both afterwards."""
    with ExitStack() as stack:
        other = stack.enter_context(exported(commit))
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="glrt-against-")))
        this = _started(stack, "this checkout", ROOT, folder / "this", threads)
        yield this, _started(stack, commit, other, folder / "other", threads)


def _started(
    stack: ExitStack, name: str, checkout: Path, folder: Path, threads: int | None
) -> Side:
    folder.mkdir()
    environment = environment_of(checkout, folder)
    if threads:
        environment["LP_NUM_THREADS"] = str(threads)
    # -P: modules next to the program must not shadow those of the standard library.
    command = [sys.executable, "-P", str(PROGRAM)]
    side = Side(name, lambda: Process(command, folder / "log", environment))
    stack.callback(side.end)
    if not side.glrt.is_relative_to(checkout):
        raise RenderError(f"{name}: it imports {side.glrt}, which is not in {checkout}.")
    return side


def measure(
    both: tuple[Side, Side], scene: str, rounds: int, seconds: float, **settings: Any
) -> tuple[Row, str]:
    """Measure one scene in interleaved runs of about `seconds`; also return the renderer's name.

    `settings` are what `bench.against_side` opens the scene with.
    """
    settings = {"scene": str(find(scene).resolve()), **settings}
    opened = [side.ask("open", **settings) for side in both]
    samples = samples_for(both, seconds)
    runs = [_round(both, number, samples, settings) for number in range(rounds)]
    closed = [side.ask("close") for side in both]
    row = Row(
        scene=scene,
        samples=samples,
        these=[this["seconds"] for this, _ in runs],
        others=[other["seconds"] for _, other in runs],
        compile_seconds=(opened[0]["compile_seconds"], opened[1]["compile_seconds"]),
        peak_bytes=(closed[0]["peak_bytes"], closed[1]["peak_bytes"]),
        equal=all(this["sha256"] == other["sha256"] for this, other in runs),
    )
    return row, opened[0]["renderer"]


def _round(
    both: tuple[Side, Side], number: int, samples: int, settings: Mapping[str, Any]
) -> tuple[Any, Any]:
    """One run of each side in a new process; which one is first alternates between rounds."""
    order = both if number % 2 == 0 else both[::-1]
    for side in order:
        side.restart()
        side.ask("open", **settings)
        side.ask("render", samples=max(1, samples // WARM_UP), seed=TRIAL_SEEDS)
    first, second = (side.ask("render", samples=samples, seed=1 + number) for side in order)
    return (first, second) if number % 2 == 0 else (second, first)


def samples_for(both: Sequence[Side], seconds: float) -> int:
    """The samples per pixel that take the slower side about `seconds`; also warms up."""
    samples, seeds = 1, count(TRIAL_SEEDS)

    def trial(side: Side) -> float:
        """Seconds of the faster of two runs, as the first includes warm-up."""
        runs = [side.ask("render", samples=samples, seed=next(seeds)) for _ in range(2)]
        return min(float(run["seconds"]) for run in runs)

    while (taken := max(map(trial, both))) < LEAST_TRIAL * seconds and samples < MAX_SAMPLES:
        samples *= 2
    return max(1, min(round(samples * seconds / taken), MAX_SAMPLES))


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown, with a last one over all scenes."""
    yield "| scene | samples | time, this / other | this | other | compile | pictures | verdict |"
    yield "|---|---|---|---|---|---|---|---|"
    for row in rows:
        run = [f"{sorted(times)[len(times) // 2]:.3f} s" for times in (row.these, row.others)]
        compiled = "{:.2f} s / {:.2f} s".format(*row.compile_seconds)
        yield (
            f"| {row.scene} | {row.samples} | {row.ratio} | {' | '.join(run)} | {compiled} "
            f"| {_alike(row.equal)} | {row.ratio.verdict} |"
        )
    whole = overall(rows)
    seconds = zip(*(row.compile_seconds for row in rows), strict=True)
    compiled = "{:.2f} s / {:.2f} s".format(*map(sum, seconds))
    yield (
        f"| all | | {whole} | | | {compiled} | {_alike(all(row.equal for row in rows))} "
        f"| {whole.verdict} |"
    )


def overall(rows: Sequence[Row]) -> Ratio:
    """The ratio over all scenes."""
    return ratio_over([(row.these, row.others) for row in rows])


def _alike(equal: bool) -> str:
    return "equal to the bit" if equal else "differ"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.against`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> int:
    for scene in parsed.scenes:
        find(scene)  # fails for an unknown scene before anything starts
    commit = commit_of(parsed.commit)
    versions = f"this: {state_of()}; other: {commit}"
    found = _measured(parsed, commit)
    rows, renderer = [row for row, _ in found], found[0][1]
    threads = f", LP_NUM_THREADS={parsed.threads}" if parsed.threads else ""
    size, run = f"{parsed.size} x {parsed.size} pixels", f"about {parsed.seconds:g} s"
    work = f"{size}, {parsed.method}, {parsed.tier} kernels, {parsed.rounds} rounds of {run}"
    place = machine(renderer) + threads
    print(f"{place}, {work}\n{versions}\n")
    print("\n".join(table(rows)))
    peaks = [
        f"{max(peaks) / 2**20:.0f} MiB" for peaks in zip(*(r.peak_bytes for r in rows), strict=True)
    ]
    verdict = overall(rows).verdict
    print(f"\npeak memory: this {peaks[0]}, other {peaks[1]}\n{verdict}")
    if parsed.json:
        _save(parsed.json, rows, place=place, work=work, versions=versions, verdict=verdict)
    return int(verdict == "slower")


def _measured(parsed: argparse.Namespace, commit: str) -> list[tuple[Row, str]]:
    found = []
    settings = {name: getattr(parsed, name) for name in ("size", "method", "tier")}
    with sides(commit, parsed.threads) as both:
        for scene in parsed.scenes:
            print(f"{scene} ...", file=sys.stderr)
            found.append(measure(both, scene, parsed.rounds, parsed.seconds, **settings))
    return found


def _save(file: Path, rows: Sequence[Row], **words: str) -> None:
    scenes = [{**asdict(row), "ratio": row.ratio._asdict()} for row in rows]
    figures = {**words, "ratio": overall(rows)._asdict(), "rows": scenes}
    files.write_text(file, json.dumps(figures, indent=1) + "\n")


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("against", __doc__)
    add = parser.add_argument
    add("commit", metavar="COMMIT", help="a hash, a branch or a tag")
    add("--scenes", nargs="+", metavar="NAME", default=SCENES)
    add("--method", choices=get_args(Method), default="mis")
    told = "kernels of glrt render, or of the window while shapes are edited (default: fastest)"
    add("--tier", choices=("fastest", "generic"), default="fastest", help=told)
    add_rounds(parser, size=256, rounds=30, least_rounds=LEAST_ROUNDS)
    add("--seconds", type=float, default=1.0, metavar="S", help="time of a run (default: 1)")
    add("--threads", type=int, metavar="N", help="LP_NUM_THREADS of both (default: unchanged)")
    add("--json", type=Path, metavar="FILE", help="file for the figures as JSON")
    return parser


if __name__ == "__main__":
    sys.exit(main())
