"""Time to an error of 2 % with glrt and with other renderers, at 128 x 128 pixels.

Mitsuba 3, on the CPU by LLVM, is configured to its advantage: with light sampling, with roulette or
without, whichever is faster, with one-sided lamps where the other side is not visible, and with
planes of two triangles. The WGSL version, which glrt ports to OpenGL, is compared with the method
`naive`, the only one that it has. Renderers that are not installed are named and left out.
"""

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench.cold_start import PROGRAMS, starts
from bench.cold_start import table as starts_table
from bench.contest import Array, Lead, Runs, lead_of, seconds_to
from bench.efficiency import SCENES, scene_of
from bench.peer import Peer, Request
from bench.program import add_rounds, exit_code_of, machine, parser_of
from glrt import files
from glrt.errors import RenderError
from glrt.gpu.context import Context, open_context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

TARGET_ERROR = 0.02  # relative RMS
ROUNDS_OF_TRIAL = 6  # of the choice of roulette for Mitsuba
ROUNDS_OF_STARTS = 5
LEVEL_SECONDS = 2.0  # for the picture that variances are relative to
MITSUBA, WGSL = "Mitsuba", "WGSL"
PEERS = {
    MITSUBA: [sys.executable, "-m", "tests.mitsuba.serve"],
    WGSL: [sys.executable, "-m", "tests.wgsl.serve"],
}
BACKS_UNSEEN = ("cornell", "room")  # the upper side of their lamp is not visible

Picture = np.ndarray[Any, np.dtype[np.float32]]
Render = Callable[[int, int], tuple[Picture, float]]  # samples, seed -> picture, seconds


@dataclass(frozen=True)
class Contender:
    """A renderer that is ready to render a scene."""

    name: str
    render: Render
    block: int = 1  # numbers of samples are multiples of it


@dataclass(frozen=True)
class Row:
    """The figures of one renderer and scene."""

    scene: str
    renderer: str
    samples_per_second: float  # pixel samples, median
    relative_variance: float  # of one sample
    seconds_to_target: float
    rival: str | None  # the renderer it is compared with
    lead: Lead | None  # over the rival


class Contest:
    """glrt and the other renderers that are installed."""

    def __init__(self, context: Context, peers: dict[str, Peer], size: int, rounds: int) -> None:
        """With renders of `size` x `size` pixels; `peers` by name."""
        self._context, self._peers = context, peers
        self._size, self._rounds = size, rounds

    def rows(self, name: str, seconds: float) -> Iterator[Row]:
        """The rows of a scene, from renders of about `seconds` each."""
        scene = scene_of(name)
        with ExitStack() as stack:
            ours = [
                stack.enter_context(self._glrt(scene, "mis", sampler=sampler))
                for sampler in ("independent", "sobol")
            ]
            level = _level(ours[1], LEVEL_SECONDS)
            rivals = []
            if MITSUBA in self._peers:
                rivals = [self._mitsuba(name, scene, level, seconds)]
            runs = interleaved([*ours, *rivals], self._rounds, seconds)
            yield from _rows(name, runs, bool(rivals), level)
            alike: dict[str, Any] = {"roulette": False, "sampler": "independent"}
            ours = [stack.enter_context(self._glrt(scene, "naive", **alike))]
            rivals = [self._peer(WGSL, scene, WGSL)] if WGSL in self._peers else []
            rounds = max(self._rounds // 3, 2)  # enough, as they differ only in speed
            runs = interleaved([*ours, *rivals], rounds, seconds)
            yield from _rows(name, runs, bool(rivals), level)

    @contextmanager
    def _glrt(self, scene: Scene, method: str, **settings: Any) -> Iterator[Contender]:
        settings |= {"method": method, "width": self._size, "height": self._size}
        renderer = Renderer(scene, context=self._context, tier="baked", **settings)

        def render(samples: int, seed: int) -> tuple[Picture, float]:
            renderer.update(seed=seed)
            renderer.restart()  # also for the seed of the last render
            start = time.perf_counter()
            image = renderer.render(samples).image()
            return image.radiance, time.perf_counter() - start

        sampler = f", {renderer.settings.sampler}" if method == "mis" else ""
        try:
            yield Contender(f"glrt {method}{sampler}", render, renderer.settings.block)
        finally:
            renderer.release()

    def _mitsuba(self, name: str, scene: Scene, level: Array, seconds: float) -> Contender:
        """Mitsuba with or without roulette, whichever is faster in a first trial."""
        asked = {"one_sided": name in BACKS_UNSEEN, "finite": True}
        both = [
            self._peer(MITSUBA, scene, f"Mitsuba, {text}", roulette=roulette, **asked)
            for text, roulette in (("roulette", True), ("no roulette", False))
        ]
        runs = interleaved(both, ROUNDS_OF_TRIAL, seconds)
        times = [seconds_to(TARGET_ERROR, each, level) for each in runs]
        return both[times.index(min(times))]

    def _peer(self, peer: str, scene: Scene, name: str, **asked: Any) -> Contender:
        settings = {"width": self._size, "height": self._size, "bounces": scene.render.bounces}

        def render(samples: int, seed: int) -> tuple[Picture, float]:
            request = Request.of(scene, samples=samples, seed=seed, **settings, **asked)
            image, seconds = self._peers[peer].render(request)
            return image.radiance, seconds

        return Contender(name, render)


def _rows(name: str, runs: list[Runs], has_rival: bool, level: Array) -> Iterator[Row]:
    """A row for each of `runs`; with `has_rival` the last one is the rival of the others."""
    rival = runs[-1] if has_rival else None
    for each in runs:
        ahead_of = rival if each is not rival else None
        yield Row(
            scene=name,
            renderer=each.renderer,
            samples_per_second=float(np.median(each.rates)),
            relative_variance=float(each.variances(level).mean()),
            seconds_to_target=seconds_to(TARGET_ERROR, each, level),
            rival=ahead_of.renderer if ahead_of else None,
            lead=lead_of(each, ahead_of, level) if ahead_of else None,
        )


def interleaved(contenders: list[Contender], rounds: int, seconds: float) -> list[Runs]:
    """Interleaved renders of all contenders, about `seconds` each."""
    samples = [_samples_for(each, seconds) for each in contenders]
    renders: list[list[tuple[Picture, float]]] = [[] for _ in contenders]
    for seed in range(1, rounds + 1):
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


def _level(contender: Contender, seconds: float) -> Array:
    """A picture with little noise, (H, W, 3), to which variances are relative."""
    return contender.render(_samples_for(contender, seconds), 0)[0].astype(np.float64)


def _samples_for(contender: Contender, seconds: float) -> int:
    """The samples that take `seconds`, in whole blocks; the first render is warm-up."""
    samples = 16
    contender.render(samples, 0)
    taken = contender.render(samples, 0)[1]
    return max(round(seconds / taken * samples / contender.block), 1) * contender.block


def table(rows: list[Row]) -> Iterator[str]:
    """The rows as Markdown; gains are the factors of `Lead`."""
    gains = ["time gain", "rate gain", "variance gain"]
    yield f"| scene | renderer | million samples/s | variance | to 2 % | {' | '.join(gains)} |"
    yield "|---|---|---|---|---|---|---|---|"
    for row in rows:
        lead = [str(factor) for factor in row.lead] if row.lead else [""] * 3
        yield (
            f"| {row.scene} | {row.renderer} | {row.samples_per_second / 1e6:.2f} "
            f"| {row.relative_variance:.3g} | {row.seconds_to_target:.3g} s | {' | '.join(lead)} |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.rivals`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    with ExitStack() as stack:
        peers = dict(_started(stack))
        context = open_context()
        place = machine(context.renderer, *(peer.name for peer in peers.values()))
        work = f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} rounds"
        print(f"{place}, {work}\n")
        contest = Contest(context, peers, parsed.size, parsed.rounds)
        rows: list[Row] = []
        for name in parsed.scenes:
            print(f"{name} ...", file=sys.stderr)
            rows += contest.rows(name, parsed.seconds)
    print("\n".join(table(rows)))
    first = starts(PROGRAMS, ROUNDS_OF_STARTS)
    print("\n" + "\n".join(starts_table(first)))
    if parsed.json:
        figures = {
            "place": place,
            "work": work,
            "rows": [_plain(row) for row in rows],
            "first pictures": {name: start._asdict() for name, start in first.items()},
        }
        files.write_text(parsed.json, json.dumps(figures, indent=1) + "\n")


def _started(stack: ExitStack) -> Iterator[tuple[str, Peer]]:
    for name, command in PEERS.items():
        try:
            peer = Peer(command)
        except RenderError as error:
            print(f"Without {name}: {error}", file=sys.stderr)
        else:
            stack.callback(peer.close)
            yield name, peer


def _plain(row: Row) -> dict[str, Any]:
    lead = (
        {name: factor._asdict() for name, factor in row.lead._asdict().items()}
        if row.lead
        else None
    )
    return {**asdict(row), "lead": lead}


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("rivals", __doc__)
    add = parser.add_argument
    add("--scenes", nargs="+", choices=SCENES, metavar="NAME", default=SCENES)
    add_rounds(parser, size=128, rounds=30)
    add("--seconds", type=float, default=0.16, metavar="S", help="time of a render (default: 0.16)")
    add("--json", type=Path, metavar="FILE", help="file for the figures as JSON")
    return parser


if __name__ == "__main__":
    sys.exit(main())
