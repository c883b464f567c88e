"""Frames a second and the load of the machine, as section 3.4 of the thesis reports them.

Each row is a process that draws frames of a scene into a texture, at most 60 a second, as v-sync
does: `thesis` with the settings of the thesis's tracer, `default` with those of the scene and the
kernel of a window at rest. A frame adds one sample to each pixel. The share of the CPU is that of
this process, of all processors. The share of the GPU is that of all programs, as the driver reports
it: NVIDIA's does, by the extra `gpu`. Memory is the peak of the process, not that of the GPU.
"""

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

from bench.load_side import Work
from bench.processes import ROOT
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.core.errors import RenderError
from glrt.image.sources import load

PROGRAM = (sys.executable, "-m", "bench.load_side")
WAYS: dict[str, dict[str, Any]] = {
    "thesis": {"method": "naive", "roulette": False, "sampler": "independent", "tier": "generic"},
    "default": {"tier": "complete"},
}
# The thesis draws one room of spheres and planes: its lamp, its ball of glass (3.4), and a camera
# with a lens (3.2). It names neither the size of the window nor the share of the CPU.
SCENES = ("cornell", "lens")
THESIS = {
    ("cornell", "thesis"): (
        "60, by v-sync; GPU 88 % (Windows 11, DirectX 12) and 80 % (Ubuntu 24.04, Vulkan) on a "
        "Radeon RX 6800 XT with a Ryzen 5800X, 96 % on an Apple M1 (macOS 15.5, Metal)"
    )
}
LIMIT = 60.0  # frames a second: the display of the thesis


class Row(NamedTuple):
    """The load of one scene, drawn in one way."""

    scene: str
    way: str
    found: dict[str, Any]  # the answer of `bench.load_side`


def measure(work: Work) -> dict[str, Any]:
    """Measure in a process of its own; RenderError if that fails."""
    command = [*PROGRAM, json.dumps(asdict(work))]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise RenderError(f"{work.scene}: no frames were drawn: {last}")
    found: dict[str, Any] = json.loads(lines[-1])
    if "error" in found:
        raise RenderError(found["error"])
    return found


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    yield "| scene | way | frames/s | CPU, all cores | GPU | peak memory | thesis |"
    yield "|---|---|---|---|---|---|---|"
    for scene, way, found in rows:
        gpu = "not known" if found["gpu"] is None else percent(found["gpu"])
        cells = [
            scene,
            way,
            f"{found['frames_per_second']:.1f}",
            percent(found["cpu"]),
            gpu,
            f"{found['peak_bytes'] / 2**20:.0f} MiB",
            THESIS.get((scene, way), ""),
        ]
        yield f"| {' | '.join(cells)} |"


def percent(share: float) -> str:
    """A share as whole percents."""
    return f"{100 * share:.0f} %"


def place(rows: Sequence[Row], limit: float) -> str:
    """The machine, the driver and the frame, as a sentence or two."""
    found = rows[0].found
    width, height = found["size"]
    most = f"at most {limit:g} frames a second" if limit else "without a limit of frames"
    lines = [f"{machine(found['renderer'])}; {width} x {height} pixels, {most}."]
    if found["gpu_unknown"]:
        lines.append(f"GPU: {found['gpu_unknown']}.")
    return " ".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.load`; returns the exit code."""
    parser = parser_of("load", __doc__)
    add = parser.add_argument
    add("scenes", nargs="*", default=SCENES, metavar="SCENE", help=f"default: {' '.join(SCENES)}")
    told = "pixels (default: 640 480)"
    add("--size", type=at_least(1), nargs=2, default=(640, 480), metavar=("W", "H"), help=told)
    add("--seconds", type=float, default=10.0, metavar="S", help="of each row (default: 10)")
    told = f"most frames a second, 0 for no limit (default: {LIMIT:g})"
    add("--limit", type=float, default=LIMIT, metavar="N", help=told)
    parsed = parser.parse_args(arguments)
    if not parsed.seconds > 0 or not parsed.limit >= 0:
        parser.error("--seconds must be above 0, and --limit 0 or above")
    return exit_code_of(lambda: _print(parsed.scenes, parsed.size, parsed.seconds, parsed.limit))


def _print(scenes: Sequence[str], size: tuple[int, int], seconds: float, limit: float) -> None:
    for scene in scenes:
        load(scene)  # a wrong name is refused before anything is measured
    rows = []
    for scene in scenes:
        for way, options in WAYS.items():
            wanted = {**options, "width": size[0], "height": size[1]}
            rows.append(Row(scene, way, measure(Work(scene, wanted, seconds, limit))))
    print(f"{place(rows, limit)}\n")
    print("\n".join(table(rows)))


if __name__ == "__main__":
    sys.exit(main())
