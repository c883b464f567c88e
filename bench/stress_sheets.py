"""The sheets of charts in docs/results/stress.md: `python -m bench.stress_sheets [NAME...]`.

All cases of `glrt stress` are run once, in some 20 minutes on two cores. Each sheet shows the
cases from one on, up to the first of the next sheet.
"""

import argparse
import io
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from bench.contact_sheet import MOST_BYTES, write_bytes
from bench.program import exit_code_of, parser_of
from glrt.analysis.plot import save_sheet
from glrt.core.errors import RenderError
from glrt.gpu.context import open_context
from glrt.lab import report
from glrt.lab.cases import CASES
from glrt.lab.sweep import Case, Finding, Lab

COLORS = (255, 128, 64, 32)  # of a file: the most that make it small enough
FIRST = {"stress": "distance", "stress-more": "denoised", "stress-third": "sun"}  # case, by sheet


def main(arguments: list[str] | None = None) -> int:
    """Write the sheets and print the table; returns the exit code."""
    parser = parser_of("stress_sheets", __doc__)
    told = f"sheets, default: {', '.join(FIRST)}"
    parser.add_argument("names", nargs="*", choices=[[], *FIRST], metavar="NAME", help=told)
    parser.add_argument("-o", dest="folder", type=Path, default=Path("docs/pictures"))
    parser.add_argument("--quick", action="store_true", help="an eighth of the samples")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def cases_of_sheets() -> Iterator[tuple[str, list[Case]]]:
    """Yield each sheet with its cases, in the order of `glrt stress`."""
    order = list(CASES)
    starts = [*(order.index(case) for case in FIRST.values()), len(order)]
    for name, (start, end) in zip(FIRST, pairwise(starts), strict=True):
        yield name, [CASES[case] for case in order[start:end]]


def write_small(file: Path, drawn: Path) -> None:
    """Write a PNG file again with so few colours that docs may hold it; RenderError if none do."""
    from PIL import Image

    with Image.open(drawn) as sheet:
        plain = sheet.convert("RGB")
    for colors in COLORS:
        encoded = io.BytesIO()
        plain.quantize(colors, dither=Image.Dither.NONE).save(encoded, "PNG", optimize=True)
        if len(encoded.getvalue()) < MOST_BYTES:
            write_bytes(file, encoded.getvalue())
            return
    raise RenderError(f"{file} has more than {MOST_BYTES} bytes. Show fewer cases in it.")


def _run(parsed: argparse.Namespace) -> None:
    parsed.folder.mkdir(parents=True, exist_ok=True)
    context, findings = open_context("auto", "compute"), []
    lab = Lab(context, 0.125 if parsed.quick else 1.0, None)
    for name, cases in cases_of_sheets():
        if parsed.names and name not in parsed.names:
            continue
        found = [_finding(case, lab) for case in cases]
        with tempfile.TemporaryDirectory() as folder:
            drawn = Path(folder) / "sheet.png"
            save_sheet([finding.small_chart() for finding in found], drawn, report.title(found))
            write_small(parsed.folder / f"{name}.png", drawn)
        findings += found
    print(report.table(findings, context.renderer))
    context.gl.release()


def _finding(case: Case, lab: Lab) -> Finding:
    start = time.perf_counter()
    sweep = case.run(lab)
    finding = Finding(case, sweep, time.perf_counter() - start, ())
    print(f"{case.name}: {finding.verdict}, {finding.seconds:.1f} s", file=sys.stderr, flush=True)
    return finding


if __name__ == "__main__":
    sys.exit(main())
