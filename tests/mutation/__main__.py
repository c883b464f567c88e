"""`python -m tests.mutation`: plant each bug of mutants.py in a copy of the tree.

The test that is named there must fail.

First all these tests must pass without a bug. A test finds a bug by an assertion that fails: a
shader that does not compile, a timeout or a warning is no discovery. Exit code 1 if a bug lives.
"""

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from tests.mutation.mutant import Edit, Mutant
from tests.mutation.mutants import MUTANTS
from tests.support.slow_share import commit_of

ROOT = Path(__file__).parents[2]
COPIED = ("glrt", "shaders_glsl", "scenes", "tests", "tools", "pyproject.toml")
FOUND = ("assert", "AssertionError", "\nNot equal to tolerance", "ValueError: NaN or infinity")


class Outcome(NamedTuple):
    """What the tests named by a mutant did."""

    passed: int
    failures: tuple[str, ...]  # their messages
    errors: int  # tests that could not be run at all
    seconds: float

    @property
    def finds_it(self) -> bool:
        """Whether an assertion failed, and nothing else went wrong."""
        good = all(message.lstrip().startswith(FOUND) for message in self.failures)
        return bool(self.failures) and good and not self.errors

    @property
    def is_clean(self) -> bool:
        return self.passed > 0 and not self.failures and not self.errors


def copy_tree(target: Path) -> None:
    """What the tests need of the tree."""
    ignored = shutil.ignore_patterns("__pycache__")
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, target / name, ignore=ignored)
        else:
            shutil.copy(source, target / name)


def planted(text: str, edits: Iterable[Edit]) -> str:
    """The text with all edits; ValueError if the old text does not stand there exactly once."""
    for edit in edits:
        found = text.count(edit.old)
        if found != 1:
            raise ValueError(f"{edit.file} has {found} times: {edit.old!r}")
        text = text.replace(edit.old, edit.new)
    return text


def plant(tree: Path, mutant: Mutant) -> dict[Path, str]:
    """Change the files of the tree; returns their texts as they were."""
    before = {tree / edit.file: (tree / edit.file).read_text() for edit in mutant.edits}
    for path, text in before.items():
        edits = [edit for edit in mutant.edits if tree / edit.file == path]
        path.write_text(planted(text, edits))
    return before


def run_tests(tree: Path, tests: Sequence[str], stop_early: bool) -> Outcome:
    """Run tests of the tree in a process of its own."""
    report = tree / "report.xml"
    report.unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-m", "not slow"]
    command += [f"--junitxml={report}", *(["-x"] if stop_early else [])]
    command += [f"tests/{test}" for test in tests]
    start = time.perf_counter()
    environment = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    environment["LP_NUM_THREADS"] = "1"  # of small pictures: more threads wait for each other
    done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if not report.exists():
        raise RuntimeError(f"pytest did not run: {done.stdout}{done.stderr}")
    return _read(report, seconds)


def _read(report: Path, seconds: float) -> Outcome:
    cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    failures = tuple(f.get("message", "") for case in cases for f in case.iter("failure"))
    errors = sum(1 for case in cases for _ in case.iter("error"))
    skipped = sum(1 for case in cases for _ in case.iter("skipped"))
    return Outcome(len(cases) - len(failures) - errors - skipped, failures, errors, seconds)


def drawn(mutants: Sequence[Mutant], count: int, commit: str) -> list[Mutant]:
    """So many of the mutants, others with each commit."""

    def place(mutant: Mutant) -> bytes:
        return hashlib.sha256(f"{commit} {mutant.bug}".encode()).digest()

    chosen = sorted(mutants, key=place)[:count]
    return [mutant for mutant in mutants if mutant in chosen]


def survivors(mutants: Sequence[Mutant]) -> list[str]:
    """Plant one after the other, printing a table; the bugs that were not found."""
    alive = []
    with tempfile.TemporaryDirectory(prefix="glrt-mutants-") as folder:
        tree = Path(folder)
        copy_tree(tree)
        clean = run_tests(tree, sorted({mutant.test for mutant in mutants}), stop_early=False)
        if not clean.is_clean:
            raise RuntimeError(f"the tests fail without any bug: {clean.failures}")
        print("| bug | found by | seconds |\n|---|---|---|", flush=True)
        for mutant in mutants:
            before = plant(tree, mutant)
            outcome = run_tests(tree, [mutant.test], stop_early=True)
            for path, text in before.items():
                path.write_text(text)
            if not outcome.finds_it:
                alive.append(f"{mutant.bug}: {outcome}")
            print(_row(mutant, outcome), flush=True)
    return alive


def _row(mutant: Mutant, outcome: Outcome) -> str:
    file, name = mutant.test.split("::")
    found = f"`{file}`: {re.sub('^test_', '', name).replace('_', ' ')}"
    return f"| {mutant.bug} | {found if outcome.finds_it else 'NOBODY'} | {outcome.seconds:.1f} |"


def main() -> int:
    """Exit code 1 if a bug is not found."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("--drawn", type=int, help="so many mutants, others with each commit")
    parser.add_argument("-k", metavar="WORD", default="", help="only bugs with this word")
    arguments = parser.parse_args()
    mutants = [mutant for mutant in MUTANTS if arguments.k in mutant.bug]
    if arguments.drawn:
        mutants = drawn(mutants, arguments.drawn, commit_of(ROOT))
    alive = survivors(mutants)
    print(f"\n{len(mutants) - len(alive)} of {len(mutants)} bugs found.")
    print("\n".join(alive))
    return 1 if alive else 0


if __name__ == "__main__":
    sys.exit(main())
