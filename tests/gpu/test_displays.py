"""Commands and programs work whatever DISPLAY says, and contexts of several routes take turns."""

import os
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes.util import find_library
from pathlib import Path
from typing import Any

import pytest

from bench.screens import screen
from glrt.core.errors import RenderError
from glrt.gpu import context, context_turns
from glrt.gpu.context_turns import TurnTaker
from tests.support.processes import glrt
from tests.support.system_packages import needs_package

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="of X servers")
SMALL = ("--width", "8", "--height", "8", "--samples", "1", "--caustics", "off")
RENDER = "import glrt; print(glrt.render(glrt.load('sky'), samples=1, width=8, height=8).samples)"


def python(code: str, **environment: str) -> str:
    """Output of a program, which must succeed and print nothing on stderr."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, **environment},
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return done.stdout.strip()


@contextmanager
def broken_server(answer: bytes) -> Iterator[str]:
    """A display whose server answers each client so, and hangs up."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        # A display's number is that of its port above 6000.
        number = server.getsockname()[1] - 6000

        def serve() -> None:
            while True:
                try:
                    client, _ = server.accept()
                except OSError:
                    return
                with client:
                    client.recv(4096)
                    client.sendall(answer)

        threading.Thread(target=serve, daemon=True).start()
        yield f"127.0.0.1:{number}"
        server.shutdown(socket.SHUT_RDWR)


def test_commands_render_with_a_display_that_draws_by_software(
    display: str, tmp_path: Path
) -> None:
    """The hidden window is asked for a GPU, and EGL renders."""
    picture = tmp_path / "a.exr"
    done = glrt("render", "cornell", "-o", picture, *SMALL, DISPLAY=display)
    assert done.returncode == 0, done.stderr
    assert picture.stat().st_size > 100
    for line in (["inspect", "sky", "--kernel"], ["paths", "sky", "--pixel", "1", "1"]):
        done = glrt(*line, DISPLAY=display, WAYLAND_DISPLAY="wayland-9")
        assert done.returncode == 0, done.stderr
    assert python(RENDER, DISPLAY=display) == "1"


@pytest.mark.parametrize("name", [":4242", "nonsense"])
def test_a_display_that_is_not_there_changes_nothing(name: str) -> None:
    assert python(RENDER, DISPLAY=name, WAYLAND_DISPLAY="wayland-9") == "1"


@pytest.mark.parametrize("answer", [b"", b"\0\x05\x0b\0\0\0\x02\0Sorry\0\0\0"])
def test_a_server_that_hangs_up_or_refuses_changes_nothing(answer: bytes) -> None:
    """A program of another user gets a refusal, for want of that user's key."""
    with broken_server(answer) as name:
        assert python(RENDER, DISPLAY=name) == "1"


def test_a_display_without_opengl_changes_nothing() -> None:
    needs_package(bool(shutil.which("Xvfb")), "xvfb")
    with screen("64x64", "-extension", "GLX") as name:
        assert python(RENDER, DISPLAY=name) == "1"


def test_a_server_that_goes_away_while_it_is_asked_is_no_gpu(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Xlib ends the process that asks: it is not the one that renders."""
    context._window_is_hardware.cache_clear()
    monkeypatch.setattr(context, "_has_display", lambda: True)
    for ends in ("raise SystemExit(1)", "import time; time.sleep(100)"):
        monkeypatch.setattr(context, "_ASK_WINDOW", f"print('hardware', flush=True); {ends}")
        monkeypatch.setattr(context, "PATIENCE", 1.0)
        assert not context._window_is_hardware(ends)


@pytest.mark.parametrize("answer", ["hardware", "software"])
def test_the_answer_of_a_window_counts(monkeypatch: pytest.MonkeyPatch, answer: str) -> None:
    context._window_is_hardware.cache_clear()
    monkeypatch.setattr(context, "_has_display", lambda: True)
    monkeypatch.setattr(context, "_ASK_WINDOW", f"print({answer!r})")
    assert context._window_is_hardware(answer) == (answer == "hardware")


OUTLIVES = """
import os
from bench.screens import screen
from glrt.gpu.context import open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer

server = screen()
os.environ["DISPLAY"] = server.__enter__()
opened = open_context("window")
renderer = Renderer(load("sky"), context=opened, width=8, height=8)
renderer.step(2)
before = renderer.image().radiance
server.__exit__(None, None, None)
renderer.step(2)
image = renderer.image()
print(image.samples, image.radiance.any(), (image.radiance != before).any())
renderer.release()
opened.gl.release()
"""


def test_a_render_by_a_hidden_window_outlives_its_server() -> None:
    needs_package(bool(shutil.which("Xvfb")), "xvfb")
    needs_package(bool(find_library("X11")), "libx11-6")
    path = os.pathsep.join([str(Path(__file__).parents[2]), *sys.path])
    assert python(OUTLIVES, PYTHONPATH=path) == "4 True True"


TURNS = """
from glrt.gpu.context import open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer

names = "egl", "window", "egl", "window"
opened = [open_context(name) for name in names]
renderers = [Renderer(load("sky"), context=each, width=8, height=8) for each in opened]
for samples in (2, 1):
    with opened[1].gl:
        for renderer in renderers:
            renderer.step(samples)
    with opened[0].gl:
        pictures = [renderer.image().radiance.tobytes() for renderer in renderers[::-1]]
    assert len(set(pictures)) == 1 or not all(each.is_software for each in opened)
for renderer, each in zip(renderers, opened):
    renderer.release()
    each.gl.release()
print(open_context("auto").has_compute)
"""


def test_contexts_of_egl_and_windows_take_turns_in_one_process(display: str) -> None:
    assert python(TURNS, DISPLAY=display) == "True"


FOREIGN = """
import ctypes
from imgui_bundle import imgui
import glfw
import glrt

glfw.init()
glfw.window_hint(glfw.VISIBLE, glfw.FALSE)
window = glfw.create_window(16, 16, "mine", None, None)
glfw.make_context_current(window)
glx = ctypes.CDLL("libGL.so.1")
glx.glXGetCurrentContext.restype = ctypes.c_void_p
mine = glx.glXGetCurrentContext()
samples = glrt.render(glrt.load("sky"), samples=1, width=8, height=8).samples
print(samples, mine is not None and glx.glXGetCurrentContext() == mine)
"""


def test_the_window_of_a_program_stays_current_after_a_render(display: str) -> None:
    assert python(FOREIGN, DISPLAY=display, WAYLAND_DISPLAY="") == "1 True"


def test_a_context_that_does_not_get_current_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Calls would reach no context, and a picture would be black."""
    answers = iter([True, False])
    monkeypatch.setattr(context_turns, "_is_current", lambda: next(answers))
    loader: Any = open_nothing()
    taker = TurnTaker(lambda: loader)
    with pytest.raises(RenderError, match="has the display gone"), taker:
        pass


def open_nothing() -> Any:
    """A loader whose context never gets current."""

    class Nothing:
        def __enter__(self) -> None:
            pass

    return Nothing()
