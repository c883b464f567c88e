"""Time to the window, to its first picture and to full size after a drag: one Markdown table.

With `--stops` it is the longest stop of each action instead, from frame to frame.
Each row is of a `glrt view` in a process of its own, on a virtual X server, Xvfb. At a second run
the trees and kernels of all scenes come from the caches. The load stands above the table: times of
loaded cores are not those of quiet ones.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from bench.program import exit_code_of, machine, parser_of
from bench.screens import screen
from glrt.core.errors import RenderError

SIZES = "1240x800", "3840x2160"
SIDE = 500  # quads along each side of the large model, of two triangles each
LARGE = "500,000 triangles"
SCENES = "cornell", "scenes/models/cow.glb", LARGE
COLUMNS = "scene", "window", "to the window", "to a picture", "full size after a drag", "frames/s"
STOPS = "scene", "window", "action", "longest stop", "processor seconds of a frame, at most"
PATIENCE = 600.0  # seconds for one row


class Times(NamedTuple):
    """Seconds from the command on, but `full` from the end of a drag on; frames a second."""

    window: float
    picture: float
    full: float
    rate: float  # while the picture gets samples


def main(arguments: list[str] | None = None) -> int:
    """Measure, and print the table; returns the exit code."""
    parser = parser_of("window_times", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, help=f"default: {', '.join(SCENES)}")
    parser.add_argument("--sizes", nargs="+", default=SIZES, help=f"default: {' '.join(SIZES)}")
    told = "the longest stop of each action, in a second window that finds all caches filled"
    parser.add_argument("--stops", action="store_true", help=told)
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> int:
    if not shutil.which("Xvfb"):
        print("glrt: the window's times need Xvfb", file=sys.stderr)
        return 3
    with TemporaryDirectory() as folder:
        large = Path(folder) / "large.ply"
        write_torus(large, SIDE)
        columns = STOPS if parsed.stops else COLUMNS
        print("\n".join(head(os.getloadavg()[0], columns)), flush=True)
        for scene in parsed.scenes:
            for size in parsed.sizes:
                source = str(large) if scene == LARGE else scene
                if parsed.stops:
                    rows = [stop_row(scene, size, *it) for it in stops(source, size, folder)]
                else:
                    rows = [row(scene, size, measured(source, size, Path(folder)))]
                print("\n".join(rows), flush=True)
    return 0


def measured(source: str, size: str, folder: Path) -> Times:
    """Measure a window of a size as "WxH"; RenderError if it fails."""
    words = "bench.window_times_side", str(time.time()), size, source
    return Times(**json.loads(_told_by(*words, size=size, folder=folder)))


def stops(source: str, size: str, folder: str) -> list[tuple[str, float, float]]:
    """Measure the actions of a window: name, seconds, and processor seconds.

    A window before it fills the caches. Raises RenderError if it fails.
    """
    for _ in range(2):
        told = _told_by("bench.window_stops_side", size, source, size=size, folder=Path(folder))
    return [(name, *times) for name, times in json.loads(told).items()]


def _told_by(module: str, *words: str, size: str, folder: Path) -> str:
    """Return the output of a window of a size; its preferences lie in the folder."""
    with screen(size) as name:
        variables = {"DISPLAY": name, "XDG_CONFIG_HOME": str(folder)}
        command = [sys.executable, "-m", module, *words]
        done = subprocess.run(
            command, env={**os.environ, **variables}, capture_output=True, timeout=PATIENCE
        )
    if done.returncode:
        raise RenderError(f"a window failed: {done.stderr.decode()[-500:]}")
    return done.stdout.decode()


def head(load: float, columns: Sequence[str] = COLUMNS) -> Iterator[str]:
    """The lines above the rows; the mean number of processes that wanted a processor before."""
    yield f"{machine()}, load {load:.1f}\n"
    yield f"| {' | '.join(columns)} |"
    yield f"|{'---|' * len(columns)}"


def stop_row(scene: str, size: str, action: str, seconds: float, busy: float) -> str:
    """A row of the table of stops."""
    cells = Path(scene).name, size, action, f"{seconds:.2f} s", f"{busy:.2f} s"
    return f"| {' | '.join(cells)} |"


def row(scene: str, size: str, times: Times) -> str:
    """A row of the table."""
    seconds = [f"{value:.2f} s" for value in times[:3]]
    return f"| {' | '.join([Path(scene).name, size, *seconds, f'{times.rate:.1f}'])} |"


def write_torus(file: Path, side: int) -> None:
    """Write a ring with bumps as a PLY file, of 2 side^2 triangles."""
    angles = np.arange(side) / side * 2 * np.pi
    across, along = np.meshgrid(angles, angles, indexing="ij")
    reach = 0.4 + 0.03 * np.sin(9 * across) * np.sin(11 * along)
    out = 1 + reach * np.cos(along)
    places = [out * np.cos(across), reach * np.sin(along), out * np.sin(across)]
    vertices = np.stack(places, axis=-1).reshape(-1, 3).astype("<f4")
    number = np.arange(side * side).reshape(side, side)
    right, above = np.roll(number, -1, 0), np.roll(number, -1, 1)
    beyond = np.roll(right, -1, 1)
    corners = [(number, beyond, right), (number, above, beyond)]
    rows = np.zeros(2 * side * side, [("count", "u1"), ("corner", "<i4", 3)])
    rows["count"] = 3
    rows["corner"] = np.concatenate([np.stack(some, -1).reshape(-1, 3) for some in corners])
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(rows)}", "property list uchar int vertex_indices", "end_header"]
    file.write_bytes("\n".join([*lines, ""]).encode() + vertices.tobytes() + rows.tobytes())


if __name__ == "__main__":
    raise SystemExit(main())
