"""Ctrl-C and SIGTERM at any moment: one line, the promised exit code, and nothing left behind."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from glrt.gpu.glsl import Source
from glrt.gpu.program import Kernel, drawing
from glrt.process import signals
from tests.support.kernel_text import written_for

SAYS = "glrt: interrupted\n"
NOTHING_RENDERED = "glrt: interrupted before anything was rendered\n"
both = pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["INT", "TERM"]
)

# Stands in for a slow import or a slow step: says where it is, and waits to be interrupted there.
WAITS = "import time, pathlib; pathlib.Path({mark!r}).touch(); time.sleep(60)\n"


def interrupted_in(
    folder: Path, module: str, number: signal.Signals, *arguments: str
) -> "tuple[int, str]":
    """Exit code and stderr of `glrt`, sent a signal while it imports a module."""
    mark = folder / "there"
    (folder / "modules").mkdir()
    (folder / "modules" / f"{module}.py").write_text(WAITS.format(mark=str(mark)))
    path = os.pathsep.join([str(folder / "modules"), os.environ.get("PYTHONPATH", "")])
    process = subprocess.Popen(
        [sys.executable, "-m", "glrt", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
    )
    while not mark.exists() and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(number)
    _, stderr = process.communicate(timeout=250)
    return process.returncode, stderr


@both
@pytest.mark.parametrize("module", ["secrets", "argparse", "pydantic"])
def test_while_modules_load(tmp_path: Path, module: str, number: signal.Signals, code: int) -> None:
    """secrets is among the first imports of any command, pydantic among the last of this one."""
    assert interrupted_in(tmp_path, module, number, "schema") == (code, SAYS)


@both
def test_before_the_render_watches_for_it(
    tmp_path: Path, number: signal.Signals, code: int
) -> None:
    """OpenEXR is imported when a picture is read as a scene: the command runs, nothing is saved."""
    (tmp_path / "a.exr").write_bytes(b"\x76\x2f\x31\x01")
    line = f"render {tmp_path}/a.exr -o {tmp_path}/b.png".split()
    assert interrupted_in(tmp_path, "OpenEXR", number, *line) == (code, NOTHING_RENDERED)
    assert not (tmp_path / "b.png").exists()


@both
@pytest.mark.parametrize("line", ["compare {0}/a.exr {0}/a.exr", "inspect {0}/a.exr"])
def test_a_command_that_renders_no_picture_is_only_interrupted(
    tmp_path: Path, line: str, number: signal.Signals, code: int
) -> None:
    (tmp_path / "a.exr").write_bytes(b"\x76\x2f\x31\x01")
    words = line.format(tmp_path).split()
    assert interrupted_in(tmp_path, "OpenEXR", number, *words) == (code, SAYS)


def test_a_signal_that_is_ignored_stays_ignored(tmp_path: Path) -> None:
    """It is ignored under nohup, or in the background of a script."""
    command = (
        "import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_IGN); "
        "from glrt.process import signals; s = signals.handled(signals.interrupt); s.__enter__(); "
        "os.kill(os.getpid(), signal.SIGINT); print('goes on')"
    )
    done = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "goes on\n", "")


def test_a_program_that_imports_glrt_keeps_its_own_handlers() -> None:
    command = (
        "import signal; before = [signal.getsignal(n) for n in (2, 15)]; import glrt; glrt.load; "
        "print(before == [signal.getsignal(n) for n in (2, 15)])"
    )
    done = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True)
    assert done.stdout == "True\n"


class Compiler:
    """Stands for moderngl, which runs Python while it makes a program: Ctrl-C comes meanwhile."""

    def __init__(self) -> None:
        self.is_done = False

    def program(self, **_shaders: str) -> None:
        signal.raise_signal(signal.SIGINT)
        self.is_done = True

    def compute_shader(self, _text: str) -> None:
        self.program()


@pytest.mark.parametrize(
    "compiled",
    [
        lambda gl: Kernel(gl, Source("trace.comp", texts=written_for())),
        lambda gl: drawing(
            gl,
            Source("trace.vert", texts=written_for()),
            Source("trace.frag", texts=written_for()),
        ),
    ],
    ids=["compute", "fragment"],
)
def test_it_waits_while_a_program_is_made(compiled: Callable[[Any], Any]) -> None:
    gl = Compiler()
    with pytest.raises(KeyboardInterrupt):
        compiled(gl)
    assert gl.is_done
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def fail(number: int | None) -> None:
    with signals.postponed():
        if number is not None:
            signal.raise_signal(number)
        raise ZeroDivisionError


def test_it_comes_after_a_block_that_fails() -> None:
    with pytest.raises(KeyboardInterrupt):
        fail(signal.SIGINT)
    with pytest.raises(ZeroDivisionError):
        fail(None)
