"""Variance and time per sample with one setting changed, and their efficiency.

The efficiency is 1 / (variance x time), relative to the defaults. Every round renders each variant
once, with its own seed. The variance is measured over pictures of different seeds, not taken from
their own standard errors, and is relative to the radiance that the other pictures have: of all
variants, weighted by how little they vary.
"""

import argparse
import statistics
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench import mesh_sizes
from bench.program import add_rounds, at_least, exit_code_of, machine, parser_of
from bench.shader_edits import Edit, edited
from glrt.analysis.method_choice.caustics import CHOICES
from glrt.error.estimate import DARK
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.plan.facts import SceneFacts
from glrt.plan.particle_refusals import refusal
from glrt.rendering.renderer import Renderer
from glrt.scene.materials.kinds import Material
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Object
from glrt.settings import settings_for


class Way(NamedTuple):
    """How a variant differs from the defaults of a scene."""

    settings: Mapping[str, Any]
    edits: Sequence[Edit] = ()  # of shader sources


_PARTICLES = ("particles", "aimed particles", "linked particles")  # what a pilot tries
SWITCHES = {
    "defaults": Way({}),
    "independent": Way({"sampler": "independent"}),
    "no roulette": Way({"roulette": False}),
    "nee": Way({"method": "nee"}),
    "naive": Way({"method": "naive"}),
    **{
        name: Way({"caustics": "on", **choice})
        for name, choice in zip(_PARTICLES, CHOICES, strict=True)
    },
}
SCENES = ("cornell", "room", "lamps", "sky", "metals", "lens")
SAMPLES = 32  # per pixel of a run, by default: two blocks of Sobol' points


class Row(NamedTuple):
    """The figures of one variant; ratios are relative to the first variant of the scene."""

    scene: str
    variant: str
    variance: float  # relative, of one sample
    uncertainty: float  # relative standard error of the variance
    microseconds: float  # per pixel sample, median
    fewer_samples: float  # variance of the first variant over this variance
    slower: float  # time over that of the first variant: median over the rounds
    efficiency: float  # fewer_samples / slower


class Runs:
    """The runs of one variant."""

    def __init__(self, renderer: Renderer, samples: int) -> None:
        """Without runs yet; each will have so many `samples` a pixel."""
        self.renderer = renderer
        self.samples = samples
        self.seconds: list[float] = []
        self.pictures: list[NDArray[np.float32]] = []

    def add(self, seed: int) -> None:
        """Render once more, from an empty film."""
        self.renderer.update(seed=seed)
        start = time.perf_counter()
        self.renderer.render(self.samples)
        self.seconds.append(time.perf_counter() - start)
        self.pictures.append(self.renderer.image().radiance)

    def variances(self, level: NDArray[np.float64], weight: float) -> NDArray[np.float64]:
        """An estimate of the relative variance of one sample from each picture.

        In `level`, the mean of these pictures has this weight. Each picture is taken out of the
        level that it is relative to: a pixel that met a rare bright path is too bright, and would
        count too little.
        """
        mean = np.mean(self.pictures, axis=0, dtype=np.float64)
        count = len(self.pictures)
        squares = []
        for picture in self.pictures:
            others = level + weight * (mean - picture) / (count - 1)
            scale = np.square(others) + DARK * others.mean() ** 2
            squares.append(np.mean(np.square(picture - mean) / scale))
        return np.array(squares) * self.samples * count / (count - 1)


def measure(
    context: Context,
    name: str,
    size: int,
    rounds: int,
    ways: Mapping[str, Way] = SWITCHES,
    samples: int = SAMPLES,
) -> list[Row]:
    """Measure the variants of a named scene in interleaved rounds, at `size` x `size` pixels."""
    return measure_scene(context, name, scene_of(name), size, rounds, ways, samples)


def measure_scene(
    context: Context,
    name: str,
    scene: Scene,
    size: int,
    rounds: int,
    ways: Mapping[str, Way],
    samples: int = SAMPLES,
) -> list[Row]:
    """The same for any scene; `name` is its name in the rows. Refused variants are left out."""
    runs = {
        label: Runs(renderer_of(scene, way, size, context), samples)
        for label, way in ways.items()
        if not refusal(SceneFacts(scene), settings_for(scene.render, **way.settings))
    }
    for number in range(rounds + 1):  # the first one is warm-up
        for place, one in enumerate(runs.values()):
            one.add(seed=1 + number * len(runs) + place)
    for one in runs.values():
        del one.seconds[0], one.pictures[0]
        one.renderer.release()
    return list(_rows(name, runs))


def renderer_of(scene: Scene, way: Way, size: int, context: Context) -> Renderer:
    """A renderer, baked where possible; raises `KeyError` if an edit does not apply."""
    settings = settings_for(scene.render, width=size, height=size, **way.settings)
    return Renderer(scene, settings, context, "complete", variant=edited(*way.edits))


def scene_of(name: str) -> Scene:
    """A scene by name; `room` is `cornell` with a white sphere instead of glass: no caustic.

    `ground` is `methods/gap` with ground glass and rough metal, `downwards` with a lamp that sends
    no light into the gap above it. `mesh_K` is a displaced ball of 20 * 4^K triangles, `clutter` a
    room of 102,400 in many meshes (`bench.mesh_sizes`).
    """
    if name == "clutter":
        return mesh_sizes.cluttered()
    if name.startswith("mesh_"):
        return mesh_sizes.of_steps(int(name.removeprefix("mesh_")))
    if name == "room":
        cornell = load("cornell")
        return _with_materials(cornell, glass=cornell.materials["white"])
    if name == "ground":
        gap = load("methods/gap")
        rough = {"glass": 0.15, "mirror": 0.25}
        return _with_materials(gap, **{it: _roughened(gap, it, rough[it]) for it in rough})
    if name == "downwards":
        gap = load("methods/gap")
        things = [_one_sided(it) if it.material == "lamp" else it for it in gap.objects]
        return gap.model_copy(update={"objects": things})
    return load(name)


def _with_materials(scene: Scene, **materials: Material) -> Scene:
    return scene.model_copy(update={"materials": {**scene.materials, **materials}})


def _roughened(scene: Scene, name: str, roughness: float) -> Material:
    return scene.materials[name].model_copy(update={"roughness": roughness})


def _one_sided(lamp: Object) -> Object:
    return lamp.model_copy(update={"emission_side": "front"})


def _rows(name: str, runs: Mapping[str, Runs]) -> Iterator[Row]:
    weights = _weights([one.pictures for one in runs.values()])
    means = [np.mean(one.pictures, axis=0, dtype=np.float64) for one in runs.values()]
    level = np.average(means, axis=0, weights=weights)
    first, *_ = runs.values()
    base = first.variances(level, weights[0]).mean()
    for (label, one), weight in zip(runs.items(), weights, strict=True):
        found = one.variances(level, weight)
        ratios = [a / b for a, b in zip(one.seconds, first.seconds, strict=True)]
        slower = statistics.median(ratios)
        yield Row(
            scene=name,
            variant=label,
            variance=float(found.mean()),
            uncertainty=float(found.std(ddof=1) / np.sqrt(len(found)) / found.mean()),
            microseconds=statistics.median(one.seconds) / (one.samples * level[..., 0].size) * 1e6,
            fewer_samples=float(base / found.mean()),
            slower=slower,
            efficiency=float(base / found.mean()) / slower,
        )


def _weights(pictures: Sequence[Sequence[NDArray[np.float32]]]) -> list[float]:
    """The weight of each variant in the mean of all, from its variance; the sum is 1."""
    spreads = [float(np.var(of_one, axis=0, dtype=np.float64).mean()) for of_one in pictures]
    inverses = [1 / max(spread, 1e-300) for spread in spreads]
    return [inverse / sum(inverses) for inverse in inverses]


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    columns = ["variance per sample", "us per sample", "1 / variance", "time", "efficiency"]
    yield f"| scene | variant | {' | '.join(columns)} |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        variance = f"{row.variance:.3g} +- {100 * row.uncertainty:.0f} %"
        yield (
            f"| {row.scene} | {row.variant} | {variance} | {row.microseconds:.3f} "
            f"| {row.fewer_samples:.2f} | {row.slower:.2f} | {row.efficiency:.2f} |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.efficiency`; returns the exit code."""
    parser = parser_of("efficiency", __doc__)
    parser.add_argument("--scenes", nargs="+", metavar="NAME", default=SCENES)
    add_rounds(parser, size=64, rounds=20)
    others = [name for name in SWITCHES if name != "defaults"]
    parser.add_argument(
        "--variants",
        nargs="+",
        metavar="NAME",
        choices=others,
        default=others,
        help="beside defaults",
    )
    told = f"of a pixel in a run (default: {SAMPLES})"
    parser.add_argument("--samples", type=at_least(1), metavar="N", default=SAMPLES, help=told)
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(asked: argparse.Namespace) -> None:
    context = open_context()
    ways = {name: SWITCHES[name] for name in ("defaults", *asked.variants)}
    rows: list[Row] = []
    for name in asked.scenes:
        print(f"{name} ...", file=sys.stderr)
        rows += measure(context, name, asked.size, asked.rounds, ways, asked.samples)
    how = f"{asked.size} x {asked.size} pixels, {asked.rounds} rounds of {asked.samples} samples"
    print(f"{machine(context.renderer)}, {how}\n")
    print("\n".join(table(rows)))


if __name__ == "__main__":
    sys.exit(main())
