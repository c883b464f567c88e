"""How often a whole run of picture tests alarms falsely, as the pytest plugin judges it.

A run has fifty pictures: the scenes that come with glrt, then random ones of `bench.scenes`. Each
is rendered with a new seed and compared with a new reference of four times the samples, at the
chance of the run divided by the number of pictures. Every alarm is false, since both show the same
scene. Runs share no renders; rows share the runs. Intervals are of binomial shares (Wilson).
"""

import sys
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from bench.false_alarms import markdown, wilson
from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.scenes import random_scene
from glrt.comparison.verdict import compare
from glrt.core.resources import folder
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.testing.pictures import SAMPLES, TIMES

PICTURES = 50  # of a run
ALPHAS = (1e-3, 1e-2, 1e-1)  # chances of a run; the first is the plugin's own
HEAD = ["chance stated", "runs with an alarm", "95 % interval", "pictures called different"]

Alarms = NDArray[np.bool_]


def scenes_of(count: int = PICTURES) -> Iterator[Scene]:
    """The scenes of a run: the gallery of glrt, scenes that separate methods, random ones."""
    methods = sorted(file.stem for file in (folder("scenes") / "methods").glob("*.toml"))
    names = [*scene_names(), *(f"methods/{name}" for name in methods)]
    for number in range(count):
        if number < len(names):
            yield load(names[number])
        else:
            yield random_scene(number - len(names))


def alarms_of(
    scenes: Sequence[Scene], runs: int, size: int, context: Context, samples: int = SAMPLES
) -> Alarms:
    """Which pictures are called different, (ALPHAS, runs, scenes)."""
    found = np.zeros((len(ALPHAS), runs, len(scenes)), bool)
    for place, scene in enumerate(scenes):
        renderer = Renderer(scene, context=context, width=size, height=size)
        for run in range(runs):
            renderer.update(seed=2 * run)
            image = renderer.render(samples).image()
            renderer.update(seed=2 * run + 1)
            reference = renderer.render(TIMES * samples).image()
            for level, alpha in enumerate(ALPHAS):
                verdict = compare(image, reference, alpha / len(scenes)).verdict
                found[level, run, place] = verdict == "different"
        renderer.release()
        print(f"{place + 1} of {len(scenes)}: {scene.title}", file=sys.stderr)
    return found


def rows_of(found: Alarms) -> Iterator[list[str]]:
    """A row for each of ALPHAS, under HEAD."""
    _, runs, scenes = found.shape
    for alpha, alarms in zip(ALPHAS, found, strict=True):
        hits = int(alarms.any(axis=1).sum())
        low, high = wilson(hits, runs)
        yield [
            f"{100 * alpha:g} %",
            f"{hits} of {runs}",
            f"{100 * low:.1f} to {100 * high:.1f} %",
            f"{int(alarms.sum())} of {runs * scenes}",
        ]


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.picture_runs`; returns the exit code."""
    parser = parser_of("picture_runs", __doc__)
    add_rounds(parser, size=24, rounds=40)
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.rounds, parsed.size))


def _print(runs: int, size: int) -> None:
    context = open_context()
    found = alarms_of([*scenes_of()], runs, size, context)
    print(f"{machine(context.renderer)}, {PICTURES} pictures of {size} x {size} pixels\n")
    print(markdown(HEAD, [*rows_of(found)]))


if __name__ == "__main__":
    sys.exit(main())
