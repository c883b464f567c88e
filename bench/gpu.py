"""Check and time every route, pipeline and tier on this machine, with or without a GPU.

Every combination renders the same scenes with the same two seeds, each in a process of its own
with empty driver caches, so that a crash or a hang becomes a row of the table. Its pictures are
right if they equal those of the first combination that works, bit for bit, or if the RMS difference
over pixels and channels is below 1 % of that between the two seeds. The exit code is 1 if one fails
or is not right. Memory is that of the process, not of the GPU.
"""

import argparse
import json
import re
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, get_args

import numpy as np

from bench.gpu_way import Work
from bench.processes import ROOT, environment_of
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.core import files
from glrt.doctor.report import examine_all, findings
from glrt.image.image import Pixels
from glrt.rendering.passes import Resolved
from glrt.rendering.pipelines import Tier

SCENES = ("cornell", "lamps", "lens", "metals", "sky", "weekend")
TIERS: tuple[Tier, ...] = ("generic", "complete")
PATIENCE = 300.0  # seconds for one combination and scene
RIGHT = 0.01  # largest difference, relative to the RMS difference between the two seeds
PROGRAM = (sys.executable, "-m", "bench.gpu_way")
QUICK = {"size": 48, "samples": 16, "seconds": 0.0}
FULL = {"size": 512, "samples": 256, "seconds": 1.0}


@dataclass(frozen=True)
class Row:
    """The result of one combination and scene."""

    work: Work
    found: dict[str, Any]  # the answer of `bench.gpu_way`, or only the error
    difference: float | None = None  # 0 for the same bits; None for the first one and failures

    @property
    def verdict(self) -> str:
        """The result in a few words; relative difference in percent of the noise."""
        if "error" in self.found:
            return "fails"
        if self.difference is None:
            return "first"
        if self.difference == 0:
            return "same bits"
        share = f"{100 * self.difference:.2g} %"
        return share if self.difference < RIGHT else f"WRONG: {share}"

    @property
    def is_right(self) -> bool:
        """Whether it rendered the same pictures as the first combination."""
        return "error" not in self.found and (self.difference is None or self.difference < RIGHT)


def ways(routes: Sequence[tuple[str, int]], scenes: Sequence[str], **much: Any) -> Iterator[Work]:
    """Every route, pipeline and tier, scene by scene; `much` has size, samples and seconds."""
    for scene in scenes:
        for route, device in routes:
            for pipeline in get_args(Resolved):
                for tier in TIERS:
                    yield Work(route, device, pipeline, tier, scene, **much)


def tried(work: Work, pictures: Path, patience: float = PATIENCE) -> dict[str, Any]:
    """Measure one combination in a process of its own; return its result, or the error."""
    with tempfile.TemporaryDirectory(prefix="glrt-gpu-") as caches:
        environment = environment_of(ROOT, Path(caches))
        arguments = [*PROGRAM, json.dumps(asdict(work)), str(pictures)]
        try:
            done = subprocess.run(
                arguments, env=environment, capture_output=True, text=True, timeout=patience
            )
        except subprocess.TimeoutExpired:
            return {"error": f"no answer within {patience:g} s; it was stopped"}
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        return {"error": _end_of(done)}
    found: dict[str, Any] = json.loads(lines[-1])
    return found


def _end_of(done: "subprocess.CompletedProcess[str]") -> str:
    """How a process without an answer ended."""
    last = (done.stderr.strip().splitlines() or ["no message"])[-1]
    if done.returncode < 0:
        return f"it crashed ({signal.Signals(-done.returncode).name}): {last}"
    return f"it ended with exit code {done.returncode}: {last}"


def difference(first: Pixels, pictures: Pixels) -> float:
    """RMS difference from the first combination, relative to that between its two seeds.

    Both arrays are (2, H, W, 3). Exactly 0 for the same bits.
    """
    if first.tobytes() == pictures.tobytes():
        return 0.0
    a, b = first.astype(np.float64), pictures.astype(np.float64)
    return float(np.sqrt(np.mean(np.square(a - b)) / np.mean(np.square(a[0] - a[1]))))


def measure(all_ways: Sequence[Work], patience: float = PATIENCE) -> Iterator[Row]:
    """Measure one after the other; the first that works for a scene is the reference."""
    first: dict[str, Pixels] = {}
    with tempfile.TemporaryDirectory(prefix="glrt-gpu-") as folder:
        file = Path(folder, "pictures.npy")
        for work in all_ways:
            row = Row(work, tried(work, file, patience))
            if "error" in row.found:
                yield row
                continue
            pictures = np.load(file)
            if work.scene in first:
                row = replace(row, difference=difference(first[work.scene], pictures))
            yield row
            first.setdefault(work.scene, pictures)


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown, with the errors below them."""
    yield "| scene | route | pipeline | tier | picture | compile | longest dispatch | rate | peak |"
    yield "|---|---|---|---|---|---|---|---|---|"
    errors = []
    for row in rows:
        work, found = row.work, row.found
        tier = found.get("tier", work.tier)  # scenes of many shapes are never baked
        named = work.tier if tier == work.tier else f"{tier} for {work.tier}"
        where = f"| {work.scene} | {_route(work)} | {work.pipeline} | {named} | {row.verdict}"
        if "error" in found:
            errors.append(f"- {_name(work)}: {found['error']}")
            yield f"{where} | | | | |"
        else:
            yield f"{where} | {_figures(found)} |"
    if errors:
        yield from ("", *errors)


def _route(work: Work) -> str:
    return f"{work.route} {work.device}" if work.device else work.route


def _name(work: Work) -> str:
    return ", ".join((work.scene, _route(work), work.pipeline, work.tier))


def _figures(found: dict[str, Any]) -> str:
    rate = f"{found['samples_per_second'] / 1e6:.3g} million samples/s"
    peak = f"{found['peak_bytes'] / 2**20:.0f} MiB"
    compiled, dispatch = found["compile_seconds"], found["longest_dispatch"]
    return f"{compiled:.2f} s | {1e3 * dispatch:.3g} ms | {rate} | {peak}"


def summary(rows: Sequence[Row]) -> str:
    """The number of renders by verdict, in one line."""
    failed = sum("error" in row.found for row in rows)
    same = sum(row.difference == 0 for row in rows)
    wrong = sum(not row.is_right for row in rows) - failed
    first = sum(row.verdict == "first" for row in rows)
    near = len(rows) - failed - same - wrong - first
    return (
        f"{len(rows)} renders: {first} first, {same} with the same bits, {near} within "
        f"1 % of the noise, {wrong} WRONG, {failed} failed"
    )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.gpu`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> int:
    files.make_folder(parsed.folder, "gpu.md", "gpu.json")
    much = {**(QUICK if parsed.quick else FULL), **_given(parsed, "size", "samples")}
    routes, notes = ([("auto", 0)], []) if parsed.auto or parsed.quick else _routes()
    rows: list[Row] = []
    try:
        for row in measure(list(ways(routes, parsed.scenes, **much)), parsed.patience):
            print(f"{_name(row.work)}: {row.verdict}", file=sys.stderr)
            rows.append(row)
    finally:  # after Ctrl-C and SIGTERM, too: the time on a machine may be short
        _report(parsed.folder, rows, notes, much)
    return int(not all(row.is_right for row in rows))


def _report(folder: Path, rows: Sequence[Row], notes: Sequence[str], much: dict[str, Any]) -> None:
    """Print and write the table and the figures of the rows so far."""
    renderers = sorted({str(row.found["renderer"]) for row in rows if "renderer" in row.found})
    work = "{size} x {size} pixels, {samples} samples".format(**much)
    lines = [f"{machine(*renderers)}, {work}", "", *notes, *table(rows), "", summary(rows)]
    print("\n".join(lines))
    figures = {"machine": machine(*renderers), "rows": [_plain(row) for row in rows]}
    files.write_text(folder / "gpu.md", "\n".join(lines) + "\n")
    files.write_text(folder / "gpu.json", json.dumps(figures, indent=1) + "\n")


def _given(parsed: argparse.Namespace, *names: str) -> dict[str, Any]:
    return {name: value for name in names if (value := getattr(parsed, name)) is not None}


def _plain(row: Row) -> dict[str, Any]:
    return {
        **asdict(row.work),
        "found": row.found,
        "difference": row.difference,
        "is_right": row.is_right,
    }


def _routes() -> tuple[list[tuple[str, int]], list[str]]:
    """The routes that open on this machine, and lines about their drivers."""
    routes, lines = [], []
    for one in examine_all():
        name = f"{one.route} {one.device}" if one.device else one.route
        if not one.opens:
            error = str(one.found.get("open", {}).get("error", one.end))
            lines += [f"- {name} does not open: {error.removeprefix(f'{one.route}: ')}"]
            continue
        routes.append((one.route, one.device))
        opening = one.found["open"]
        lines += [f"- {name}: {opening['renderer']}, OpenGL {opening['version']}"]
        lines += [f"  - {_item(line)}" for line in findings(one.found.get("self_test"))]
    return routes, [*lines, ""]


def _item(line: str) -> str:
    """A line of the doctor, with its columns joined by a colon."""
    return re.sub(r"\s{2,}", ": ", line.strip(), count=1)


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("gpu", __doc__)
    add = parser.add_argument
    folder = Path("build", "gpu")
    add("-o", dest="folder", type=Path, metavar="DIR", default=folder, help=f"default: {folder}")
    add("--quick", action="store_true", help="small pictures on the best route: about a minute")
    add("--auto", action="store_true", help="only the route that `auto` chooses")
    add("--scenes", nargs="+", metavar="NAME", default=SCENES)
    told = f"pixels a side (default: {FULL['size']}, or {QUICK['size']})"
    add("--size", type=at_least(1), metavar="N", help=told)
    told = f"samples per pixel (default: {FULL['samples']}, or {QUICK['samples']})"
    add("--samples", type=at_least(1), metavar="N", help=told)
    told = f"seconds for one combination and scene (default: {PATIENCE:g})"
    add("--patience", type=float, metavar="S", default=PATIENCE, help=told)
    return parser


if __name__ == "__main__":
    sys.exit(main())
