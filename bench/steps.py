"""The bias of ray marching by the length of its steps: `python -m bench.steps`.

A scene with a grid is rendered by the method `march` with steps of 1, 2, 4 and more voxels, and by
`mis`. A row has the root of the mean square of their relative difference, without what noise
explains. `-o FILE.jpg` writes the picture of docs: some of the lengths, and `mis`.
"""

import argparse
import sys
from typing import Any

import numpy as np

from bench.effects import DARK
from bench.program import add_picture, exit_code_of, parser_of
from bench.sheets import in_rows, titled, write_sheet
from glrt.core.errors import UsageError
from glrt.core.files import check_writable
from glrt.core.text import counted
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.plan.facts import SceneFacts
from glrt.rendering.renderer import Renderer
from glrt.scene.grids import edges_of_voxels
from glrt.scene.scene import Scene

VOXELS = (1, 2, 4, 8, 16, 32)  # lengths of steps
SHOWN = (2, 8, 32)


def main(arguments: list[str] | None = None) -> int:
    """Print the table and write the picture; returns the exit code."""
    parser = parser_of("steps", __doc__)
    add_picture(parser, "smoke", 1024, 128, "height")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    if parsed.file:
        check_writable(parsed.file)
    context, scene = open_context(), load(parsed.scene)
    grids = SceneFacts(scene).media.grids
    if not grids:
        raise UsageError(f"{parsed.scene} has no medium with a grid, so no steps. Name another.")
    edge = max(max(edges_of_voxels(scene, name)) for name in grids)
    render = scene.render
    width = max(1, round(parsed.size * render.width / render.height))
    size: dict[str, Any] = {"width": width, "height": parsed.size, "samples": parsed.samples}
    truth = _rendered(context, scene, **size, method="mis", seed=1)
    print("| step, voxels | scene units | distance from `mis` |")
    print("|---|---|---|")
    cells = []
    for voxels in VOXELS:
        image = _rendered(context, scene, **size, method="march", march_step=voxels * edge)
        print(f"| {voxels} | {voxels * edge:.3g} | {_bias(image, truth):.2g} |", flush=True)
        if voxels in SHOWN:
            cells.append(titled(f"steps of {counted(voxels, 'voxel')}", image.radiance))
    if parsed.file:
        cells.append(titled("mis", truth.radiance))
        write_sheet(parsed.file, in_rows(cells, len(cells)))


def _rendered(context: Context, scene: Scene, **settings: Any) -> Image:
    renderer = Renderer(scene, context=context, tier="complete", **settings)
    try:
        return renderer.render().image()
    finally:
        renderer.release()


def _bias(image: Image, truth: Image) -> float:
    """Return the relative distance of two pictures, their noise taken off."""
    square = np.square(truth.radiance.astype(np.float64))
    scale = square + DARK * np.square(truth.radiance.mean(dtype=np.float64))
    away = np.square(image.radiance.astype(np.float64) - truth.radiance)
    noise = np.square(image.stderr.astype(np.float64)) + np.square(truth.stderr)
    return float(np.sqrt(max(((away - noise) / scale).mean(), 0.0)))


if __name__ == "__main__":
    sys.exit(main())
