"""Standard streams as shells leave them: a reader that has gone, a full disk, a closed stream."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

FULL = Path("/dev/full")
needs_full = pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")


def shell(arguments: str, redirections: str) -> "subprocess.CompletedProcess[str]":
    """`glrt` in a shell; the exit code is glrt's own, whatever it is piped into.

    A user's Python keeps short texts until it exits: the tests' own environment may not.
    """
    command = f'"{sys.executable}" -m glrt {arguments} {redirections}; exit ${{PIPESTATUS[0]}}'
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONUNBUFFERED"}
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment)


@pytest.mark.parametrize("arguments", ["--version", "--help", "render --help", "schema"])
def test_a_reader_that_has_gone_is_no_error(arguments: str) -> None:
    done = shell(arguments, "| true")
    assert (done.returncode, done.stderr) == (0, "")


@needs_full
@pytest.mark.parametrize("arguments", ["--version", "render --help", "schema"])
def test_a_full_disk_behind_stdout_exits_4_in_one_paragraph(arguments: str) -> None:
    done = shell(arguments, "> /dev/full")
    assert done.returncode == 4
    assert done.stderr == "glrt: the command failed: No space left on device\n"


@needs_full
def test_a_full_disk_behind_stderr_leaves_the_exit_code() -> None:
    assert shell("rendr", "2> /dev/full").returncode == 2


@pytest.mark.slow
def test_closed_streams_leave_the_exit_code() -> None:
    done = shell("--version", ">&-")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = shell("rendr", "2>&-")
    assert (done.returncode, done.stdout) == (2, "")


def test_a_picture_does_not_get_the_number_of_a_closed_stream() -> None:
    """Otherwise a driver's messages on stderr would be written into the picture."""
    probe = (
        f'"{sys.executable}" -c "import os; from glrt.process.command import open_missing; '
        "open_missing(); "
        "print(os.open('/dev/null', os.O_RDONLY))\" <&- 2>&-"
    )
    done = subprocess.run(["bash", "-c", probe], capture_output=True, text=True)
    assert int(done.stdout) > 2
