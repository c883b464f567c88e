"""A terminal that is closed, and Ctrl-C in the first moments of the process."""

import os
import pty
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from glrt.image.image import Image
from tests.cli.test_signals import SAYS, interrupted_in
from tests.support.processes import start_render
from tests.support.system_packages import needs

pytestmark = pytest.mark.usefixtures("as_in_a_terminal")

OWN_TERMINAL = (
    "import fcntl, sys, termios; fcntl.ioctl(2, termios.TIOCSCTTY, 0); "
    "from glrt.cli.main import main; sys.exit(main())"
)


@pytest.fixture
def as_in_a_terminal() -> Iterator[None]:
    """Under `nohup`, processes ignore SIGHUP, and so do processes that they start."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)


@pytest.mark.slow
def test_a_terminal_that_is_closed_costs_no_picture(tmp_path: Path) -> None:
    """SIGHUP comes, and the progress bar can be drawn no more."""
    try:
        terminal, end = pty.openpty()
    except OSError as error:
        needs(False, f"a terminal, which a chroot without /dev/pts cannot have ({error})")
    picture = tmp_path / "a.exr"
    options = f"--width 16 --height 16 --samples 1048576 -o {picture}".split()
    command = [sys.executable, "-c", OWN_TERMINAL, "render", "cornell", *options]
    process = subprocess.Popen(command, stdin=end, stdout=end, stderr=end, start_new_session=True)
    os.close(end)
    seen = b""
    while b"to go" not in seen and process.poll() is None:
        seen += os.read(terminal, 4096)
    os.close(terminal)
    assert process.wait(timeout=250) == 129, seen
    assert 0 < Image.load(picture).samples < 1048576


@pytest.mark.slow
def test_further_hangups_do_not_end_the_save(tmp_path: Path) -> None:
    """One comes of the shell, and one of the system when the shell ends."""
    picture = tmp_path / "a.exr"
    size = ("--width", "16", "--height", "16", "--samples", "1048576")
    process = start_render("cornell", "-o", picture, *size)
    while process.poll() is None:
        process.send_signal(signal.SIGHUP)
        time.sleep(0.001)
    _, stderr = process.communicate()
    assert process.returncode in (129, -signal.SIGHUP), "the latter while Python itself ends"
    assert "Traceback" not in stderr
    assert 0 < Image.load(picture).samples < 1048576


def test_a_hangup_while_modules_load(tmp_path: Path) -> None:
    assert interrupted_in(tmp_path, "pydantic", signal.SIGHUP, "schema") == (129, SAYS)


# Sends SIGINT when a number of modules have been asked for since glrt's own code began to run.
INTERRUPTS = """
import os, signal, sys
asked = []
def hook(event, arguments):
    if event == "import":
        asked.append(arguments[0])
        own = "glrt.process.command"
        if own in asked and len(asked) == asked.index(own) + {count}:
            os.kill(os.getpid(), signal.SIGINT)
sys.addaudithook(hook)
"""
SCRIPT = "import sys; from glrt.cli.main import main; sys.exit(main())"


@pytest.mark.parametrize("count", [1, 2, 3, 5, 9, 16, 30])
def test_no_traceback_from_the_first_import_on(count: int, tmp_path: Path) -> None:
    """The test counts imports, not time. Before the first one is only Python's own start."""
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTS.format(count=count))
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    how = ["-m", "glrt"] if count % 2 else ["-c", SCRIPT]
    done = subprocess.run(
        [sys.executable, *how, "schema"],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
        timeout=250,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", SAYS)


def test_nothing_is_imported_before_ctrl_c_is_seen_to() -> None:
    """Imports by Python itself or by the command's script are excepted."""
    code = (
        "import re, sys; before = set(sys.modules); import glrt.cli.main; "
        "print(*sorted(set(sys.modules) - before))"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    packages = {"glrt", "glrt.cli", "glrt.core", "glrt.process"}
    modules = {"glrt.cli.main", "glrt.process.early", "glrt.core.version"}
    assert set(told.stdout.split()) <= packages | modules | {"signal"}
