"""`glrt stress`: cases in; table, charts and an exit code out."""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from glrt import files
from glrt.context import open_context
from glrt.errors import UsageError
from glrt.lab.plot import check_matplotlib
from glrt.lab.stress import report
from glrt.lab.stress.cases import CASES
from glrt.lab.stress.sweep import Case, Finding, Lab
from glrt.scene import nearest, quoted

BROKEN = 1
QUICK = 0.125  # of the rows and samples of a full run


def stress(arguments: argparse.Namespace) -> int:
    """The exit code: 1 when a guarantee is broken."""
    cases = known_cases(arguments.cases)
    if arguments.list:
        print("\n".join(f"{case.name:<10} {case.title}" for case in cases))
        return 0
    folder = _prepared(arguments.folder, cases)
    context = open_context(arguments.context, "compute")
    lab = Lab(context, QUICK if arguments.quick else 1.0)
    findings = [_run(case, lab) for case in cases]
    report.save(findings, folder, context.renderer)
    summary = json.dumps(report.summary(findings))
    print(summary if arguments.json else report.table(findings, context.renderer), flush=True)
    context.gl.release()
    return 0 if all(finding.holds for finding in findings) else BROKEN


def known_cases(names: Sequence[str]) -> list[Case]:
    """The cases of these names, each once, or all; `UsageError` lists them for an unknown one."""
    for name in names:
        if name not in CASES:
            near = nearest(name, tuple(CASES))
            question = f"; did you mean {quoted(near)}?" if near else "."
            raise UsageError(f"unknown case {quoted(name)}{question} Cases: {', '.join(CASES)}.")
    return [CASES[name] for name in dict.fromkeys(names)] or list(CASES.values())


def _prepared(folder: Path | None, cases: Sequence[Case]) -> Path:
    """The folder, made and tried before anything is measured."""
    if folder is None:
        raise UsageError("say where to put table and charts: glrt stress -o DIR.")
    check_matplotlib()
    charts = [f"{case.name}.svg" for case in cases]
    files.make_folder(folder, report.TABLE, report.FIGURES, report.OVERVIEW, *charts)
    return folder


def _run(case: Case, lab: Lab) -> Finding:
    start = time.perf_counter()
    finding = Finding(case, case.run(lab), time.perf_counter() - start)
    if sys.stderr.isatty():
        print(f"{case.name}: {finding.verdict}, {finding.seconds:.1f} s", file=sys.stderr)
    return finding
