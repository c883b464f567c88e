"""`glrt stress`: run stress cases; write a table and charts, return an exit code."""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from glrt.analysis.outputs import Outputs, prepare_outputs
from glrt.cli.export import save_whole, with_settings
from glrt.cli.options import add_context
from glrt.core.errors import UsageError
from glrt.core.files import make_folder, write_text
from glrt.core.text import counted, nearest, quoted
from glrt.gpu.context import open_context
from glrt.lab import report
from glrt.lab.cases import CASES
from glrt.lab.sweep import Case, Finding, Lab
from glrt.lab.truths import truths
from glrt.settings import settings_for

DESCRIPTION = (
    "Vary one parameter after the other to where path tracers fail, and compare glrt with a "
    "naive implementation: charts, a table, and a verdict for each case."
)
EPILOG = (
    "Exit codes: 0 all guarantees hold, 1 one is broken, 2 wrong usage, 3 no usable OpenGL, 4 "
    "the render failed."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    add = parser.add_argument
    add("cases", metavar="CASE", nargs="*", help="case to run (default: all)")
    add("-o", dest="folder", metavar="DIR", type=Path, help="output folder")
    add(
        "--html",
        metavar="FILE",
        help="a .html file with charts that can be read, values and pictures; without -o, only "
        "this is written",
    )
    add("--quick", action="store_true", help="an eighth of the samples")
    add(
        "--scenes",
        metavar="DIR",
        type=Path,
        help="write the scenes of cases whose mean radiance is known in closed form, and run "
        "none: .toml; .xml and .pbrt where the format holds the scene wholly; truths.json",
    )
    add("--list", action="store_true", help="list the cases and run none")
    add("--json", action="store_true", help="print figures as one line of JSON")
    add_context(parser)


BROKEN = 1
_TRUTHS = "truths.json"
QUICK = 0.125  # share of the rows and samples of a full run


def run(arguments: argparse.Namespace) -> int:
    """Run the cases and write their charts; return 1 if a guarantee is broken."""
    cases = known_cases(arguments.cases)
    if arguments.list:
        print("\n".join(f"{case.name:<10} {case.title}" for case in cases))
        return 0
    if arguments.scenes:
        return _write_scenes(arguments.scenes, {case.name for case in cases})
    outputs = _prepared(arguments, cases)
    context = open_context(arguments.context, "compute")
    lab = Lab(context, QUICK if arguments.quick else 1.0, [] if outputs.page else None)
    findings = [_run(case, lab) for case in cases]
    if outputs.folder:
        report.save(findings, outputs.folder, context.renderer)
    if outputs.page:
        report.save_page(findings, outputs.page, context.renderer)
    summary = json.dumps(report.summary(findings))
    print(summary if arguments.json else report.table(findings, context.renderer), flush=True)
    context.gl.release()
    return 0 if all(finding.holds for finding in findings) else BROKEN


def _write_scenes(folder: Path, names: set[str]) -> int:
    """Write the scenes of cases with a closed form, and truths.json; return 0."""
    known = [truth for truth in truths() if truth.name.partition("-")[0] in names]
    if not known:
        have = dict.fromkeys(truth.name.partition("-")[0] for truth in truths())
        raise UsageError(f"no scene of these cases has a closed form; these do: {', '.join(have)}.")
    make_folder(folder, _TRUTHS)
    told = {}
    for truth in known:
        settings = settings_for(truth.scene.render, **truth.settings)
        scene = with_settings(truth.scene, settings)
        scene.save(folder / f"{truth.name}.toml")
        wanted = [f"{truth.name}{suffix}" for suffix in (".xml", ".pbrt")]
        files = [name for name in wanted if save_whole(scene, settings, folder / name)]
        told[truth.name] = {
            "files": [f"{truth.name}.toml", *files],
            "radiance": truth.radiance,
            "formula": truth.formula,
            **truth.settings,
        }
    write_text(folder / _TRUTHS, json.dumps(told, indent=2) + "\n")
    print(f"Wrote {counted(len(known), 'scene')} and {_TRUTHS} to {folder}.")
    return 0


def known_cases(names: Sequence[str]) -> list[Case]:
    """Return the cases of these names, each once, or all; an unknown one is a `UsageError`."""
    for name in names:
        if name not in CASES:
            near = nearest(name, tuple(CASES))
            question = f"; did you mean {quoted(near)}?" if near else "."
            raise UsageError(f"unknown case {quoted(name)}{question} Cases: {', '.join(CASES)}.")
    return [CASES[name] for name in dict.fromkeys(names)] or list(CASES.values())


def _prepared(arguments: argparse.Namespace, cases: Sequence[Case]) -> Outputs:
    """Create the output folder and check that outputs are writable, before anything is measured."""
    charts = [f"{case.name}.svg" for case in cases]
    names = [report.TABLE, report.FIGURES, report.OVERVIEW, *charts]
    return prepare_outputs(arguments.folder, arguments.html, names)


def _run(case: Case, lab: Lab) -> Finding:
    start = time.perf_counter()
    own = lab if lab.rendered is None else replace(lab, rendered=[])  # its pictures alone
    sweep = case.run(own)
    finding = Finding(case, sweep, time.perf_counter() - start, own.rendered or ())
    if sys.stderr.isatty():
        print(f"{case.name}: {finding.verdict}, {finding.seconds:.1f} s", file=sys.stderr)
    return finding
