"""What probes hold, as balls, in a room and behind a thin wall: docs/pictures/probe-balls.jpg.

`python -m bench.probe_sheet FILE` draws a lit room, and a sealed dark room beside a lit one, 5 EV
brighter, without the test of visibility and with it: their light, and below how far probes see.
"""

import sys
from pathlib import Path
from typing import Any, NamedTuple

import moderngl
import numpy as np

from bench.contact_sheet import Codes, check_sheet, save_sheet
from bench.program import exit_code_of, parser_of
from glrt.analysis.stress.probes import CELL, WITHOUT, house
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.false_colors import VIRIDIS, FalseColors, Scale
from glrt.rendering.screen.probe_balls import ProbeBalls, farthest
from glrt.scene.scene import Scene

SIZE, SAMPLES = 384, 256
THIN = 0.03  # cells


class Room(NamedTuple):
    """A column of the sheet."""

    scene: Scene
    exposure: float = 0.0  # EV
    variant: Variant = PLAIN


def balls_of(room: Room, context: Context, size: int, samples: int) -> tuple[Codes, Codes]:
    """A picture with probes as balls that show their light, and one with their distances."""
    way: dict[str, Any] = {"width": size, "height": size, "samples": samples, "method": "ddgi"}
    ways = {**way, "aov": ("depth",), "sampler": "sobol"}
    renderer = Renderer(room.scene, None, context, variant=room.variant, **ways)
    renderer.render().image()
    with context.gl:
        balls, colors = ProbeBalls(context.gl), FalseColors(context.gl)
        target = context.gl.simple_framebuffer((size, size), 3)
        tracer, depth = renderer.probes.tracer, renderer.aov_mean("depth")
        assert tracer
        assert depth
        light = renderer.weighed(renderer.plan.weights)
        drawn = balls.draw(light, depth, tracer, room.scene.camera)
        radiance = np.frombuffer(drawn.read(), np.float32).reshape(size, size, 4)[..., :3]
        scale = Scale(VIRIDIS, 0.0, farthest(tracer.grid), is_logarithmic=False)
        with context.gl.scope(target, moderngl.NOTHING):
            colors.draw_distances(renderer.film, light, drawn, scale)
        distances = np.frombuffer(target.read(alignment=1), np.uint8).reshape(size, size, 3)[::-1]
        for part in (balls, colors, target):
            part.release()
    renderer.release()
    return expose_and_encode(radiance, room.exposure, "neutral"), distances.copy()


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.probe_sheet`; returns the exit code."""
    parser = parser_of("probe_sheet", __doc__)
    parser.add_argument("file", type=Path, metavar="FILE", help="JPEG or PNG")
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _save(given.file))


def _save(file: Path) -> None:
    check_sheet(file)
    dark = house(THIN * CELL, 1)
    rooms = [Room(load("methods/diffuse")), Room(dark, 5.0, WITHOUT), Room(dark, 5.0)]
    context = open_context()
    sheets = [balls_of(room, context, SIZE, SAMPLES) for room in rooms]
    context.gl.release()
    save_sheet([*(light for light, _ in sheets), *(seen for _, seen in sheets)], file)


if __name__ == "__main__":
    sys.exit(main())
