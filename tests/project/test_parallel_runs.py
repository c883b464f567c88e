"""A run of tests in several processes reports and judges the same as in one."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
INI = "[pytest]\nmarkers = slow\n"
CONFTEST = 'pytest_plugins = ["tests.support.slow_share", "tests.support.alarms"]\n'
# One of them stays below the limit, both together exceed it.
BOOKING = """
import pytest
from tests.support.alarms import ALPHA, LIMIT, book

@pytest.mark.slow
@pytest.mark.parametrize("number", range(2))
def test_booking(number: int) -> None:
    book(round(0.75 * LIMIT / ALPHA))

@pytest.mark.slow
@pytest.mark.timeout(601)
def test_too_long_for_a_share() -> None:
    raise AssertionError
"""


def run_of_tests(folder: Path, processes: str, share: str) -> tuple[int, list[str]]:
    """Exit code and output of the tests in a folder."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    command += ["-n", processes, "--dist", "load", "--slow-share", share]
    search = {"PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    environment = {**os.environ, **search}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=250
    )
    return done.returncode, done.stdout.splitlines()


@pytest.mark.slow
def test_chances_of_false_alarms_and_slow_tests_are_those_of_the_whole_run(tmp_path: Path) -> None:
    for name, text in (("pytest.ini", INI), ("conftest.py", CONFTEST), ("test_it.py", BOOKING)):
        (tmp_path / name).write_text(text)
    code, lines = run_of_tests(tmp_path, "2", "1/1")
    assert "2 of 3 slow tests drawn" in lines
    chance = "chance of a false alarm with other seeds: 1.5e-04, which is above 0.0001"
    assert chance in lines
    assert lines[-1].startswith("2 passed in ")
    assert code == 1, "each process alone would have passed"
    code, lines = run_of_tests(tmp_path, "1", "0/1")
    assert "0 of 3 slow tests drawn" in lines
    assert code == 0
