"""`python -m tests.mutation`: plant each bug of mutants.csv in a copy of the tree.

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
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from tests.mutation.mutant import Mutant, mutants, plant
from tests.mutation.places import places
from tests.support.slow_share import commit_of

ROOT = Path(__file__).parents[2]
COPIED = ("glrt", "shaders_glsl", "scenes", "tests", "tools", "pyproject.toml")
FOUND = ("assert", "AssertionError", "\nNot equal to tolerance", "ValueError: NaN or infinity")


class Outcome(NamedTuple):
    """The results of the tests named by a mutant."""

    is_fast: bool  # whether they belong to `make test`
    passed: int
    failures: tuple[str, ...]  # their messages
    errors: int  # tests that could not be run at all
    seconds: float

    @property
    def finds_it(self) -> bool:
        """Whether an assertion failed, and nothing else went wrong."""
        good = all(message.lstrip().startswith(FOUND) for message in self.failures)
        return bool(self.failures) and good and not self.errors


def copy_tree(target: Path) -> None:
    """Copy the parts of the tree that the tests need."""
    ignored = shutil.ignore_patterns("__pycache__")
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, target / name, ignore=ignored)
        else:
            shutil.copy(source, target / name)


def hunted(tree: Path, test: str) -> Outcome:
    """Run a test against a bug: its slow cases, too, where the others find nothing."""
    outcome = run_tests(tree, [test], "not slow", "-x")
    return outcome if outcome.failures or outcome.errors else run_tests(tree, [test], "slow", "-x")


def run_tests(tree: Path, tests: Sequence[str], tier: str, *words: str) -> Outcome:
    """Run tests of a tier of the tree in a process of its own."""
    report = tree / "report.xml"
    report.unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-m", tier]
    command += [f"--junitxml={report}", *words, *(f"tests/{test}" for test in tests)]
    start = time.perf_counter()
    environment = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    environment["LP_NUM_THREADS"] = "1"  # of small pictures: more threads wait for each other
    done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if not report.exists():
        raise RuntimeError(f"pytest did not run: {done.stdout}{done.stderr}")
    return _read(report, seconds, tier == "not slow")


def _read(report: Path, seconds: float, is_fast: bool) -> Outcome:
    cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    failures = tuple(f.get("message", "") for case in cases for f in case.iter("failure"))
    errors = sum(1 for case in cases for _ in case.iter("error"))
    skipped = sum(1 for case in cases for _ in case.iter("skipped"))
    passed = len(cases) - len(failures) - errors - skipped
    return Outcome(is_fast, passed, failures, errors, seconds)


def drawn(listed: Sequence[Mutant], count: int, commit: str) -> list[Mutant]:
    """So many of the mutants, others with each commit."""

    def place(mutant: Mutant) -> bytes:
        return hashlib.sha256(f"{commit} {mutant.bug}".encode()).digest()

    chosen = sorted(listed, key=place)[:count]
    return [mutant for mutant in listed if mutant in chosen]


def survivors(chosen: Sequence[Mutant]) -> list[str]:
    """Plant one after the other, printing a table; the bugs that were not found."""
    alive = []
    with tempfile.TemporaryDirectory(prefix="glrt-mutants-") as folder:
        tree = Path(folder)
        copy_tree(tree)
        known = places(tree)
        tests = sorted({mutant.test for mutant in chosen})
        fast, slow = (run_tests(tree, tests, tier) for tier in ("not slow", "slow"))
        if fast.failures or fast.errors or slow.failures or slow.errors:
            raise RuntimeError(f"tests fail without any bug: {fast.failures + slow.failures}")
        print("| bug | found by | tier | seconds |\n|---|---|---|---|", flush=True)
        for mutant in chosen:
            file, before = plant(mutant, known)
            outcome = hunted(tree, mutant.test)
            file.write_text(before)
            if not outcome.finds_it:
                alive.append(f"{mutant.bug}: {outcome}")
            print(_row(mutant, outcome), flush=True)
    return alive


def _row(mutant: Mutant, outcome: Outcome) -> str:
    file, name = mutant.test.split("::")
    found = f"`{file}`: {re.sub('^test_', '', name).replace('_', ' ')}"
    told = (found if outcome.finds_it else "NOBODY", "fast" if outcome.is_fast else "slow")
    return f"| {mutant.bug} | {' | '.join(told)} | {outcome.seconds:.1f} |"


def main() -> int:
    """Exit code 1 if a bug is not found."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("--drawn", type=int, help="so many mutants, others with each commit")
    parser.add_argument("-k", metavar="WORD", default="", help="only bugs with this word")
    parser.add_argument("--part", default="1/1", help="K/N: the K-th of N parts of the list")
    arguments = parser.parse_args()
    part, parts = map(int, arguments.part.split("/"))
    chosen = [mutant for mutant in mutants()[part - 1 :: parts] if arguments.k in mutant.bug]
    if not chosen:
        parser.error(f"no bug has the word {arguments.k!r}")
    if arguments.drawn:
        chosen = drawn(chosen, arguments.drawn, commit_of(ROOT))
    alive = survivors(chosen)
    print(f"\n{len(chosen) - len(alive)} of {len(chosen)} bugs found.")
    print("\n".join(alive))
    return 1 if alive else 0


if __name__ == "__main__":
    sys.exit(main())
