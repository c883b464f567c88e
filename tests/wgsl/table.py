"""The tables of docs/results/crosscheck.md: `python -m tests.wgsl.table`.

Scene by stage, the share of pixels that are the same in every bit, and the largest difference: in
ulps, in the display pass of 255. `--macos`: what each suspicion explains.
"""

import argparse
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from glrt.core.errors import GlrtError
from glrt.gpu.context import Choice, Context, open_context
from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.mixed_scene import everything
from tests.wgsl.crosscheck import Agreement, Record, WgslVersion, agreements, glsl_record
from tests.wgsl.device import Device, describe, open_device
from tests.wgsl.findings import SUSPICIONS, symptoms
from tests.wgsl.text import Fault
from tests.wgsl.tracer import naive

SCENES = ("cornell", "lamps", "lens", "metals", "sky", "weekend", "mixture")
COMPILER_AT_LIBERTY = Fault(
    "exact", "return bitcast<f32>(bitcast<u32>(x) ^ settings.zero);", "return x;"
)


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code."""
    parsed = _parser().parse_args(arguments)
    try:
        device = open_device()
        lines = _findings(device) if parsed.macos else _stages(device, parsed.size, parsed.scenes)
        for line in lines:
            print(line, flush=True)
    except GlrtError as error:
        print(f"glrt: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code
    return 0


def _stages(device: Device, size: int, scenes: Sequence[str]) -> Iterator[str]:
    with _route("egl") as egl, _route("osmesa") as osmesa:
        versions: dict[str, Callable[[Scene, Settings], Record]] = {
            "WGSL": WgslVersion(device).record,
            "WGSL without `exact`": WgslVersion(device, COMPILER_AT_LIBERTY).record,
            "OSMesa": partial(glsl_record, osmesa),
        }
        rows: dict[str, list[list[Agreement]]] = {title: [] for title in versions}
        for name in scenes:
            scene = everything() if name == "mixture" else load(name)
            settings = naive(scene, width=size, height=size)
            kernel = glsl_record(egl, scene, settings)
            for title, record in versions.items():
                rows[title].append(list(agreements(record(scene, settings), kernel)))
        yield f"WGSL: {describe(device)}. {size} x {size} pixels."
    for title, found in rows.items():
        yield f"\n{title} against EGL:\n"
        yield from _table(scenes, found)


@contextmanager
def _route(name: Choice) -> Iterator[Context]:
    context = open_context(name)
    print(f"{name}: {context.renderer}, OpenGL {context.version}")
    try:
        yield context
    finally:
        context.gl.release()


def _table(scenes: Iterable[str], rows: Sequence[list[Agreement]]) -> Iterator[str]:
    yield f"| scene | {' | '.join(each.stage for each in rows[0])} |"
    yield "|---" * (1 + len(rows[0])) + "|"
    for scene, row in zip(scenes, rows, strict=True):
        yield f"| {scene} | {' | '.join(map(_cell, row))} |"


def _cell(agreement: Agreement) -> str:
    _, identical, distance = agreement
    return "100 %" if identical == 1 else f"{100 * identical:.2f} %, {distance}"


def _findings(device: Device) -> Iterator[str]:
    healthy = symptoms(device)
    yield "| suspicion | brightness | shadow | green dots | explains |"
    yield "|---|---|---|---|---|"
    yield f"| none | {healthy.brightness:.0f} | {healthy.shadow:.2f} | {healthy.green_dots} | |"
    for name, suspicion in SUSPICIONS.items():
        found = symptoms(device, suspicion)
        explained = ", ".join(sorted(found.beside(healthy))) or "nothing"
        figures = f"{found.brightness:.0f} | {found.shadow:.2f} | {found.green_dots}"
        yield f"| {name} | {figures} | {explained} |"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.wgsl.table", description=__doc__)
    parser.add_argument("--macos", action="store_true", help="suspicions about macOS instead")
    parser.add_argument("--size", type=int, default=64, metavar="N", help="pixels a side")
    parser.add_argument("--scenes", nargs="+", default=SCENES, metavar="NAME")
    return parser


if __name__ == "__main__":
    sys.exit(main())
