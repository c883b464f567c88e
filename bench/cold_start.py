"""Time and memory of a process from its start to its first picture.

Each program renders `cornell` at 512 x 512 pixels and 1 sample, timed from the start of Python to
the written file. Rounds are interleaved; the first one, which fills the driver caches, is not
counted.
"""

import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

PROGRAMS = {
    "glrt": [sys.executable, "-m", "glrt", "render"],
    "Mitsuba": [sys.executable, "-m", "tests.mitsuba"],
    "WGSL": [sys.executable, "-m", "tests.wgsl"],
}
WORK = ["cornell", "--width", "512", "--height", "512", "--samples", "1"]


class Start(NamedTuple):
    """Time and memory of one process."""

    seconds: float
    peak: float  # bytes resident


def starts(programs: Mapping[str, Sequence[str]], rounds: int) -> dict[str, Start]:
    """Medians over the rounds for each program; programs that fail are left out."""
    turns = [{n: start_of(command) for n, command in programs.items()} for _ in range(rounds + 1)]
    found = {}
    for name in programs:
        counted = [start for turn in turns[1:] if (start := turn[name])]
        if len(counted) == rounds:
            found[name] = Start(*map(statistics.median, zip(*counted, strict=True)))
    return found


# Run by a small process: ru_maxrss of a process includes the memory of its parent before exec.
LAUNCH = """
import os, subprocess, sys, time
begin, quiet = time.perf_counter(), subprocess.DEVNULL
process = subprocess.Popen(sys.argv[1:], stdin=quiet, stdout=quiet, stderr=quiet)
_, status, usage = os.wait4(process.pid, 0)
print(time.perf_counter() - begin, usage.ru_maxrss * 1024)
sys.exit(os.waitstatus_to_exitcode(status) != 0)
"""


def start_of(program: Sequence[str], work: Sequence[str] = WORK) -> Start | None:
    """Run a program to its end; None if it fails."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder, "first.exr")
        command = [sys.executable, "-S", "-c", LAUNCH, *program, *work, "-o", str(output)]
        done = subprocess.run(command, env=_environment(), capture_output=True, text=True)
        if done.returncode or not output.exists():
            return None
    return Start(*map(float, done.stdout.split()))


def _environment() -> dict[str, str]:
    """The environment of this process, with bytecode caching as in an installed package."""
    return {name: v for name, v in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def table(found: Mapping[str, Start]) -> Iterator[str]:
    """A row for each program, as Markdown."""
    yield "| program | first picture | peak memory |"
    yield "|---|---|---|"
    for name, start in found.items():
        yield f"| {name} | {start.seconds:.2f} s | {start.peak / 2**20:.0f} MiB |"
