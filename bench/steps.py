"""What each step gives that leads from plain light sampling to glrt's defaults.

`steps` adds them in turn, `alone` takes one back from the defaults or adds one that is not among
them, `roulette` lets it start elsewhere. A step is taken back by a setting, or by a text in the
shaders as it was before: a text that has gone is a KeyError, so no row measures nothing.
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
    """Survival is min(throughput / threshold, 1), from so many scatterings on."""
    edits = [Edit("integrators/path.glsl", "4.0 * CHANCES", f"CHANCES / {threshold}")]
    if bounce:
        call = "if (ROULETTE && {}roulette_ends("
        late = call.format(f"path.depth >= {bounce} && ")
        edits.append(Edit("integrators/path.glsl", call.format(""), late))
    return edits


BEFORE = roulette("1.0", 3)
BY_FLUX = [  # and one lamp costs a random number
    Edit("lights/choice.glsl", "max(dot(away, away), cluster.reach2)", "1.0"),
    Edit("lights/sampling.glsl", "if (CLUSTERS > 1) choice.x", "choice.x"),
]
STRIPS = [  # points on quads by solid angle, as in `nee`
    Edit("lights/sampling.glsl", "if (QUADS_BY_AREA) {", "if (false) {"),
    Edit("lights/sampling.glsl", "!QUADS_BY_AREA", "true"),
]
STEPS = {
    "plain: independent numbers, lamps by flux, roulette below 1 from bounce 3": Way(
        {"sampler": INDEPENDENT}, [*BY_FLUX, *BEFORE]
    ),
    "+ lamps by flux / distance^2, one lamp not chosen": Way({"sampler": INDEPENDENT}, BEFORE),
    "+ roulette below 1/4, at any bounce": Way({"sampler": INDEPENDENT}),
    "+ Sobol's points: the defaults": Way({}),
}
ALONE = {
    "defaults": Way({}),
    "lamps by flux": Way({}, BY_FLUX),
    "roulette below 1 from bounce 3": Way({}, BEFORE),
    "points on quads by strips in `mis` too": Way({}, STRIPS),
    "`nee`, by strips": Way({"method": "nee"}),
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
    """The rows of `roulette` as Markdown: efficiency with Sobol's points, in brackets without."""
    efficiency = {(row.scene, row.variant): row.efficiency for row in rows}
    scenes = list(dict.fromkeys(row.scene for row in rows))
    yield f"| start | {' | '.join(scenes)} | mean (geometric, Sobol) |"
    yield "|---" * (len(scenes) + 2) + "|"
    for start in STARTS:
        pairs = [[efficiency[s, f"{start}, {n}"] for n in (SOBOL, INDEPENDENT)] for s in scenes]
        cells = " | ".join(f"{even:.2f} ({independent:.2f})" for even, independent in pairs)
        mean = statistics.geometric_mean(even for even, _ in pairs)
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
