"""The process of a window with a hand on it, as the tests see it: without imgui."""

import json
import os
import re
import shutil
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from tempfile import mkdtemp

ROOT = Path(__file__).parents[2]
SOURCES = ("glrt", "shaders_glsl", "scenes", "tests")


def names_of_checks() -> list[str]:
    """Read from the text: to import them takes imgui, which not every machine can load."""
    files = sorted(Path(__file__).parent.glob("check_*.py"))
    return [name for file in files for name in re.findall(r"@check\ndef (\w+)", file.read_text())]


class CheckedWindow:
    """A window that does checks, one after the other; after one that failed, a fresh one."""

    def __init__(self, display: str, folder: Path, **variables: str) -> None:
        """Nothing is opened yet. Each window has a folder of its own, in this one."""
        self._folder, self._log = folder, folder / "log.txt"
        self._environment = {**os.environ, "DISPLAY": display, **variables}
        self._process: subprocess.Popen[str] | None = None

    def trouble(self, check: str) -> str:
        """The problem that a check found, or "" for none."""
        process = self._process = self._process or self._opened()
        found = "interrupted"
        try:
            found = _answer(process, check)
        finally:
            if found:
                self.close()
        return found and f"{found}\n{self._log.read_text()[-4000:]}"

    def close(self) -> int:
        """End the process, if there is one, and return its exit code."""
        process, self._process = self._process, None
        if process is None:
            return 0
        try:
            process.communicate(timeout=250)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
        return process.returncode

    def _opened(self) -> "subprocess.Popen[str]":
        """A window that works on a copy of the sources: checks break its shaders."""
        folder = Path(mkdtemp(dir=self._folder))
        for name in SOURCES:
            skipped = shutil.ignore_patterns("__pycache__")
            shutil.copytree(ROOT / name, folder / name, ignore=skipped)
        places = {
            "XDG_CONFIG_HOME": str(folder / "config"),
            "XDG_STATE_HOME": str(folder / "state"),
            "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
        }
        with self._log.open("w") as log:
            return subprocess.Popen(
                [sys.executable, "-W", "error", "-m", "tests.window"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                cwd=folder,
                env={**self._environment, **places},
            )


def _answer(process: "subprocess.Popen[str]", check: str) -> str:
    assert process.stdin
    assert process.stdout
    with suppress(BrokenPipeError):
        print(check, file=process.stdin, flush=True)
    told = process.stdout.readline()
    return str(json.loads(told)) if told else "the window is gone"
