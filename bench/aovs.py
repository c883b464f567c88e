"""What AOVs cost: renders with all of surfaces, with two, with bounces, and with none, in turns."""

import sys
import time
from collections.abc import Mapping
from typing import get_args

from bench.program import exit_code_of, machine, parser_of
from bench.ratios import ratio_of
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import OF_PATHS, Aov

SCENES = "cornell", "lamps", "lens", "metals", "sky", "weekend"
SIZE = 256  # pixels
SAMPLES = 64  # per pixel
FIVE: tuple[Aov, ...] = tuple(aov for aov in get_args(Aov) if aov not in OF_PATHS)
CHOICES: dict[str, tuple[Aov, ...]] = {
    "albedo, normal": ("albedo", "normal"),
    "all five": FIVE,
    "bounces": OF_PATHS,
}


def times_of(scene: Scene, context: Context, rounds: int) -> dict[str, list[float]]:
    """Seconds of each round of renders with each choice of AOVs, "" for none."""
    choices = {"": (), **CHOICES}
    renderers = {
        name: Renderer(
            scene, context=context, tier="baked", width=SIZE, height=SIZE, samples=SAMPLES, aov=aov
        )
        for name, aov in choices.items()
    }
    return seconds_in_turns(renderers, rounds)


def seconds_in_turns(renderers: Mapping[str, Renderer], rounds: int) -> dict[str, list[float]]:
    """Seconds of each round of renders by renderers in turns, which are released."""
    times: dict[str, list[float]] = {name: [] for name in renderers}
    for turn in range(rounds + 1):  # the first one warms up
        for name, renderer in renderers.items():
            renderer.restart()
            start = time.perf_counter()
            renderer.render().image()
            if turn:
                times[name].append(time.perf_counter() - start)
    for renderer in renderers.values():
        renderer.release()
    return times


def row(name: str, scene: Scene, context: Context, rounds: int) -> str:
    """A row of the table: ratios of times, with 95 % intervals."""
    times = times_of(scene, context, rounds)
    ratios = (str(ratio_of(times[choice], times[""])) for choice in CHOICES)
    return f"| {name} | {' | '.join(ratios)} |"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.aovs`; returns the exit code."""
    parser = parser_of("aovs", __doc__)
    parser.add_argument("--rounds", type=int, default=12, help="renders of each choice")
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(given.rounds))


def _print(rounds: int) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {SIZE} x {SIZE} pixels, {SAMPLES} samples, `mis`\n")
    print(f"| scene | {' | '.join(CHOICES)} |\n|---|{'---|' * len(CHOICES)}")
    for name in SCENES:
        print(row(name, load(name), context, rounds), flush=True)


if __name__ == "__main__":
    sys.exit(main())
