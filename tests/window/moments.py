"""`glrt view` that is ended at a chosen moment: `python -m tests.window.moments MOMENT`.

Each moment is brought about in the window itself, which then gets a signal, or is closed as by its
cross. Before that a preference was changed.
"""

import ctypes
import math
import os
import signal
import socket
import sys
from collections.abc import Callable
from ctypes.util import find_library
from itertools import count
from typing import Any

from imgui_bundle import imgui

import glfw  # isort: skip
from glrt.cli.main import main
from glrt.core import files
from glrt.rendering import kernel_switch
from glrt.view import event_wait
from glrt.view.controls import replaced
from glrt.view.window import Window

FRAMES = 12  # with samples, after which the moment is brought about
RESTED = 10  # pauses without a frame
Act = Callable[[Window, int], None]  # what is done in a frame, by its number


sent: list[int] = []


def terminate() -> None:
    """Once: a second signal ends the process at once."""
    if not sent:
        sent.append(signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)


def before(owner: Any, name: str, act: Callable[[], None]) -> None:
    """Let a function act first."""
    inner = getattr(owner, name)

    def outer(*arguments: Any, **options: Any) -> Any:
        act()
        return inner(*arguments, **options)

    setattr(owner, name, outer)


def compiling(_window: Window, frame: int) -> None:
    if frame == 0:
        before(kernel_switch, "compiled", terminate)


def dragging(window: Window, frame: int) -> None:
    left, top, width, height = window.app.rectangle
    io, aside = imgui.get_io(), frame - FRAMES
    if aside >= 0:
        io.add_mouse_pos_event(left + width / 2 + 9 * aside, top + height / 2)
    if aside == 1:
        io.add_mouse_button_event(0, True)
    if aside == 6:
        assert window.app.camera != window.app.session.opened.scene.camera, "it turns"
        terminate()


def choosing(window: Window, frame: int) -> None:
    if frame == FRAMES:
        window.app.files.dialogs.ask_open("Open", ["All files", "*"], window.app.files.open)
    if frame > FRAMES and os.path.exists("dialog.pid"):
        assert window.app.files.dialogs.is_open
        terminate()


def saving(window: Window, frame: int) -> None:
    if frame == FRAMES:
        before(files, "_rename", terminate)
        window.app.files.save_picture("picture.exr")


def saving_when_killed(window: Window, frame: int) -> None:
    if frame == FRAMES:
        before(files, "_rename", lambda: os.kill(os.getpid(), signal.SIGKILL))
        window.app.files.save_picture("picture.exr")


def closing(_window: Window, frame: int) -> None:
    if frame == FRAMES:
        background = imgui.get_style().color_(imgui.Col_.window_bg)
        assert background.x > 0.8, "the theme that is preferred, light, is there from the start"
        glfw.set_window_should_close(glfw.get_current_context(), True)


def closing_with_edits(window: Window, frame: int) -> None:
    """The cross is pressed; the window asks, and goes when the edits are given up."""
    if frame == FRAMES:
        window.app.add("sphere")
        glfw.set_window_should_close(glfw.get_current_context(), True)
    question = window.app.messages.question
    if frame > FRAMES + 3:
        assert question, "it asks, and stays"
        question.answers["do not save"]()


def killed_with_edits(window: Window, frame: int) -> None:
    """As soon as the edit is kept."""
    if frame == FRAMES:
        window.app.add("sphere")
    if frame > FRAMES and window.recovery.file.exists():
        os.kill(os.getpid(), signal.SIGKILL)


def restoring(window: Window, frame: int) -> None:
    """The window after that one: it has the edit when it is terminated."""
    objects = window.app.session.opened.scene.objects
    if frame == FRAMES:
        window.recovery.restore()
        assert len(window.app.session.scene.objects) == len(objects) + 1
        window.app.undo()
        assert window.app.session.scene.objects == objects
        window.app.redo()
        terminate()


def display_lost_with_edits(window: Window, frame: int) -> None:
    """The connection to the X server breaks before the edit is kept."""
    if frame == FRAMES:
        window.app.add("sphere")
        x11 = ctypes.CDLL(find_library("X11"))
        x11.XConnectionNumber.argtypes = [ctypes.c_void_p]
        library: Any = glfw
        with socket.socket(fileno=os.dup(x11.XConnectionNumber(library.get_x11_display()))) as one:
            one.shutdown(socket.SHUT_RDWR)


def terminated_with_edits(window: Window, frame: int) -> None:
    """A signal is not asked back."""
    if frame == FRAMES:
        window.app.add("sphere")
        terminate()


def starting(window: Window, frame: int) -> None:
    """Without a scene, nothing is compiled before one is chosen; undo knows no scene before."""
    app = window.app
    if frame == 0:
        assert app.shows_start
        assert not app.files.recent
    if frame == FRAMES:
        assert app.session.renderer is None
        app.files.ask_open("lamps")
    if frame > FRAMES and app.session.samples:
        assert app.files.source == "lamps"
        assert not app.shows_start
        assert not app.session.history.can_undo
        assert app.files.recent == ("lamps",)
        terminate()


def leaving_the_start(window: Window, frame: int) -> None:
    """Escape goes on with the scene that comes first, small enough for a quick picture."""
    if frame == FRAMES:
        imgui.get_io().add_key_event(imgui.Key.escape, True)
    if frame == FRAMES + 1:
        imgui.get_io().add_key_event(imgui.Key.escape, False)
    if frame > FRAMES + 2:
        assert window.app.files.source == "cornell"
        assert not window.app.shows_start
        terminate()


def exporting_when_killed(window: Window, frame: int) -> None:
    """As soon as the other process has reported how far it is."""
    exports = window.app.exports
    if frame == FRAMES:
        exports.toggle()
        exports.wish.samples, exports.wish.picture = "1000000", "long.png"
        exports.ask_begin()
    if exports.job and exports.job.share > 0:
        assert exports.job._process
        with open("export.pid", "w") as file:
            print(exports.job._process.pid, file=file)
        os.kill(os.getpid(), signal.SIGKILL)


naps: list[float] = []  # since the last frame


def nap() -> None:
    """A pause at rest. After some the mouse moves: that is answered by a frame."""
    naps.append(event_wait.SLICE)
    if len(naps) == RESTED:
        move_mouse()
    if len(naps) == 50 * RESTED:
        os._exit(1)


def resting(window: Window, frame: int) -> None:
    if frame == FRAMES:
        event_wait.LONGEST = math.inf
        before(window._wait, "_pause", nap)
    if len(naps) >= RESTED:
        terminate()  # which is heard at rest, too
        return
    naps.clear()


def move_mouse() -> None:
    """Move the mouse as a hand does: the X server reports it."""
    x11 = ctypes.CDLL(find_library("X11"))
    x11.XOpenDisplay.restype = x11.XDefaultRootWindow.restype = ctypes.c_void_p
    display = ctypes.c_void_p(x11.XOpenDisplay(None))
    root = ctypes.c_void_p(x11.XDefaultRootWindow(display))
    x11.XWarpPointer(display, None, root, 0, 0, 0, 0, 300, 300)
    x11.XCloseDisplay(display)


MOMENTS: dict[str, Act] = {
    act.__name__: act
    for act in (
        compiling,
        dragging,
        choosing,
        saving,
        saving_when_killed,
        resting,
        closing,
        closing_with_edits,
        killed_with_edits,
        exporting_when_killed,
        restoring,
        display_lost_with_edits,
        terminated_with_edits,
        starting,
        leaving_the_start,
    )
}
WITHOUT_SCENE = ("starting", "leaving_the_start")


def run(moment: str) -> int:
    """The window, with the moment in it."""
    act, frames = MOMENTS[moment], count()
    opened, made = Window._open, Window._params

    def open_and_act(window: Window) -> None:
        opened(window)
        window.app.prefer(replaced(window.app.preferences, mode="fly"))
        act(window, next(frames))

    def swapped(window: Window) -> None:
        if window.app.session.samples or window.app.shows_start:
            act(window, next(frames))

    def params(window: Window) -> Any:
        result = made(window)
        result.callbacks.after_swap = lambda: swapped(window)
        result.callbacks.post_init = lambda: open_and_act(window)
        return result

    Window._params = params  # type: ignore[assignment,method-assign]
    scene = ["cornell", "--width", "32", "--height", "32"]
    return main(["view", *([] if moment in WITHOUT_SCENE else scene)])


if __name__ == "__main__":
    sys.exit(run(sys.argv[1]))
