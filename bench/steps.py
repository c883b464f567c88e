"""Variance and time of each step from plain light sampling to glrt's defaults.

The table `steps` adds one step after the other, `alone` removes one from the defaults or adds one
that is not among them, `roulette` varies threshold and first bounce of Russian roulette. A step is
removed by a setting or by an edit of the shader sources; an edit that does not apply raises
KeyError, so that no row silently measures the defaults.
"""

import statistics
import sys
from collections.abc import Iterator, Mapping, Sequence

from bench.efficiency import Row, Way, measure, table
from bench.program import add_rounds, add_tables, exit_code_of, machine, parser_of
from bench.shader_edits import Edit
from glrt.gpu.context import open_context

SCENES = ("cornell", "room", "lamps", "metals")
INDEPENDENT, SOBOL = "independent", "sobol"


def roulette(threshold: str, bounce: int = 0) -> list[Edit]:
    """Edits for a survival probability of min(throughput / threshold, 1), from `bounce` on."""
    edits = [
        Edit("integrators/path.glsl", "throughput, 4.0, rng", f"throughput, 1.0 / {threshold}, rng")
    ]
    if bounce:
        call = "if (ROULETTE && !resamples && {}roulette_ends("
        late = call.format(f"path.depth >= {bounce} && ")
        edits.append(Edit("integrators/path.glsl", call.format(""), late))
    return edits


BEFORE = roulette("1.0", 3)
BY_FLUX = [  # also draws a random number to choose a single lamp
    Edit("lights/choice.glsl", "max(dot(away, away), cluster.reach2)", "1.0"),
    Edit("lights/sampling.glsl", "if (CLUSTERS > 1) choice.x", "choice.x"),
]
STRIPS = [  # samples quads by solid angle, as `nee` does
    Edit("lights/sampling.glsl", "if (QUADS_BY_AREA) {", "if (false) {"),
    Edit("lights/sampling.glsl", "!QUADS_BY_AREA", "true"),
]
STEPS = {
    "plain: independent numbers, lamps by flux, roulette below 1 from bounce 3": Way(
        {"sampler": INDEPENDENT}, [*BY_FLUX, *BEFORE]
    ),
    "+ lamps by flux / distance^2, no choice of a single lamp": Way(
        {"sampler": INDEPENDENT}, BEFORE
    ),
    "+ roulette below 1/4, at any bounce": Way({"sampler": INDEPENDENT}),
    "+ Sobol' points: the defaults": Way({}),
}
ALONE = {
    "defaults": Way({}),
    "lamps by flux": Way({}, BY_FLUX),
    "roulette below 1 from bounce 3": Way({}, BEFORE),
    "quads by solid angle in `mis`, too": Way({}, STRIPS),
    "`nee`, quads by solid angle": Way({"method": "nee"}),
}
STARTS = {
    "below 1/4, any bounce": Way({}),
    "below 1/4, from bounce 3": Way({}, roulette("0.25", 3)),
    "below 1/2, from bounce 3": Way({}, roulette("0.5", 3)),
    "below 1, from bounce 3": Way({}, BEFORE),
    "below 1/2, any bounce": Way({}, roulette("0.5")),
    "below 1/8, any bounce": Way({}, roulette("0.125")),
    "none": Way({"roulette": False}),
}
ROULETTE = {
    f"{start}, {sampler}": Way({**way.settings, "sampler": sampler}, way.edits)
    for sampler in (INDEPENDENT, SOBOL)
    for start, way in STARTS.items()
}
TABLES: Mapping[str, Mapping[str, Way]] = {"steps": STEPS, "alone": ALONE, "roulette": ROULETTE}


def by_start(rows: Sequence[Row]) -> Iterator[str]:
    """The rows of `roulette` as Markdown: efficiency with Sobol' points (independent numbers)."""
    efficiency = {(row.scene, row.variant): row.efficiency for row in rows}
    scenes = list(dict.fromkeys(row.scene for row in rows))
    yield f"| start | {' | '.join(scenes)} | mean (geometric, Sobol) |"
    yield "|---" * (len(scenes) + 2) + "|"
    for start in STARTS:
        pairs = [[efficiency[s, f"{start}, {n}"] for n in (SOBOL, INDEPENDENT)] for s in scenes]
        cells = " | ".join(f"{sobol:.2f} ({independent:.2f})" for sobol, independent in pairs)
        mean = statistics.geometric_mean(sobol for sobol, _ in pairs)
        yield f"| {start} | {cells} | {mean:.2f} |"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.steps`; returns the exit code."""
    parser = parser_of("steps", __doc__)
    add_tables(parser, TABLES)
    parser.add_argument("--scenes", nargs="+", metavar="NAME", default=SCENES)
    add_rounds(parser, size=128, rounds=12)
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.tables, parsed.scenes, parsed.size, parsed.rounds))


def _print(names: Sequence[str], scenes: Sequence[str], size: int, rounds: int) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {size} x {size} pixels, {rounds} rounds")
    for name in names:
        rows: list[Row] = []
        for scene in scenes:
            print(f"{name}, {scene} ...", file=sys.stderr)
            rows += measure(context, scene, size, rounds, TABLES[name])
        lines = by_start(rows) if name == "roulette" else table(rows)
        print("\n" + "\n".join(lines), flush=True)


if __name__ == "__main__":
    sys.exit(main())
