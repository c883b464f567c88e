"""Cost and lag of live probes that take turns: a picture updates a share, `probes.per_update`.

`python -m bench.probe_shares` dims all lights of a scene to a quarter and follows its live probes.
It prints a row for each share: rays of an update, its time over that of an update of all probes in
interleaved rounds, and the updates until half of the change of light is in the maps.
"""

import argparse
import sys
import time
from contextlib import ExitStack
from typing import Any, NamedTuple

import numpy as np

from bench.program import add_rounds, exit_code_of, machine, parser_of
from bench.ratios import LEAST_ROUNDS, ratio_of
from glrt.core.errors import RenderError
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.plan.probe_grid import updated_at_once
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.rendering.probe_tracer import RAYS, ProbeTracer
from glrt.rendering.renderer import Renderer
from glrt.scene.probes import Probes
from glrt.scene.scene import Scene, with_lights

SHARES = (1.0, 0.5, 0.25, 0.125)
DIM = 0.25  # of the intensity of all lights
MOST_UPDATES = 2000
TIMED = 8  # updates in a round


class Row(NamedTuple):
    """A share of the probes, with what follows from it."""

    share: float
    length: int  # probes of an update
    to_half: int  # updates until half of the change is there
    seconds: list[float]  # of TIMED updates, for each round


def main(arguments: list[str] | None = None) -> int:
    """Print the table; returns the exit code."""
    parser = parser_of("probe_shares", __doc__)
    parser.add_argument(
        "scene", nargs="?", default="methods/diffuse", help="default: methods/diffuse"
    )
    add_rounds(parser, 16, LEAST_ROUNDS, LEAST_ROUNDS)
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    context = open_context()
    rows = measured(load(parsed.scene), context, parsed.size, parsed.rounds)
    print("| share | probes an update | rays | time over all probes | updates to half | over all |")
    print("|---|---|---|---|---|---|")
    for row in rows:
        ratio, lag = ratio_of(row.seconds, rows[0].seconds), row.to_half / rows[0].to_half
        figures = row.length, row.length * RAYS, ratio, row.to_half, f"{lag:.2f}"
        print(f"| {row.share:g} | {' | '.join(map(str, figures))} |")
    print(f"\n{machine(context.renderer)}; {parsed.scene}, hysteresis {HYSTERESIS:g}")


def measured(scene: Scene, context: Context, size: int, rounds: int) -> list[Row]:
    """Return a row for each of SHARES; RenderError if the light does not follow."""
    with ExitStack() as opened:
        tracers = [_dimmed(scene, share, context, size, opened) for share in SHARES]
        with context.gl:
            lags = [_updates_to_half(tracer) for tracer in tracers]
            times = [_round(tracers) for _ in range(1 + rounds)][1:]  # the first warms up
    lengths = [updated_at_once(_shared(scene, share), tracers[0].grid.probes) for share in SHARES]
    columns = zip(SHARES, lengths, lags, map(list, zip(*times, strict=True)), strict=True)
    return [Row(*column) for column in columns]


def _shared(scene: Scene, share: float) -> Scene:
    table = dict(scene.probes or Probes()) | {"per_update": share}
    return scene.model_copy(update={"probes": Probes(**table)})


def _dimmed(
    scene: Scene, share: float, context: Context, size: int, opened: ExitStack
) -> ProbeTracer:
    """Return probes that hold the light of a scene, and follow a darker one from now on."""
    bright = _shared(scene, share)
    lights = {group: DIM * value for group, value in bright.light_groups.items()}
    way: dict[str, Any] = {"method": "ddgi", "width": size, "height": size}
    renderer = Renderer(bright, context=context, **way)
    opened.callback(renderer.release)
    renderer.render(1)
    renderer.update(with_lights(bright, lights), hysteresis=HYSTERESIS)
    assert renderer.probes.tracer
    return renderer.probes.tracer


def _updates_to_half(tracer: ProbeTracer) -> int:
    half = _light(tracer) * (1 + DIM) / 2
    for number in range(1, MOST_UPDATES + 1):
        tracer.follow(HYSTERESIS)
        if _light(tracer) <= half:
            return number
    raise RenderError(f"after {MOST_UPDATES} updates, half of the change of light is missing")


def _light(tracer: ProbeTracer) -> float:
    """The mean of what the maps hold, up to a factor that depends on their size alone."""
    texels = np.frombuffer(tracer.maps["probe_light"].read(), np.float32).reshape(-1, 4)
    return float(texels[:, :3].mean(dtype=np.float64))


def _round(tracers: list[ProbeTracer]) -> list[float]:
    """The seconds of TIMED updates by each tracer, in turn."""
    taken = []
    for tracer in tracers:
        start = time.perf_counter()
        for _ in range(TIMED):
            tracer.follow(HYSTERESIS)
        taken.append(time.perf_counter() - start)
    return taken


if __name__ == "__main__":
    sys.exit(main())
