"""A run of tests counts the programs that it compiles, and fails above its budget."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
INI = "[pytest]\nmarkers = slow\ntestpaths = .\n"
CONFTEST = """
from tests.support import budget
budget.MOST_PROGRAMS, budget.MOST_SECONDS = 2, 0.5
pytest_plugins = ["tests.support.budget"]
"""
TESTS = """
import time
import pytest
from glrt.core.errors import RenderError
from glrt.gpu.context import open_context
from glrt.gpu.evaluate import Probe
from glrt.gpu.program import Kernel

@pytest.mark.parametrize("number", [1, 2, 3, 3])
def test_compiling(number: int) -> None:
    context = open_context("auto")
    with context.gl as gl:
        assert Probe(f"{number}.0").run(gl) == number
        with pytest.raises(RenderError):
            Probe("undeclared").run(gl)

def test_working() -> None:
    start = time.process_time()
    while time.process_time() < start + 0.7:
        pass
"""


@pytest.mark.slow
@pytest.mark.parametrize("processes", ["0", "2"])
def test_programs_and_seconds_of_all_processes_are_judged(tmp_path: Path, processes: str) -> None:
    for name, text in (("pytest.ini", INI), ("conftest.py", CONFTEST), ("test_it.py", TESTS)):
        (tmp_path / name).write_text(text)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}

    def run(*words: str) -> tuple[int, list[str]]:
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-n", processes]
        command += ["-m", "not slow", *words]
        done = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=250
        )
        return done.returncode, done.stdout.splitlines()

    code, lines = run()
    assert code == 1
    assert any(line.startswith("3 programs were compiled, in ") for line in lines)
    assert "over the budget: more than 2 programs were compiled" in lines
    code, lines = run("--budget")
    assert any(
        line.startswith("over the budget: test_it.py::test_working took 0.") for line in lines
    )
    code, lines = run("-k", "working", "--budget")
    assert code == 0, "a part of the tests is not judged"
