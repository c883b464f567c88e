"""A last save when the connection to the X server is lost, which ends the process."""

import ctypes
import os
import sys
from collections.abc import Callable
from typing import Any

from imgui_bundle import imgui  # noqa: F401 - first: glfw then is the library that it brings

import glfw  # isort: skip

_NO_WINDOW = 3  # exit code
_HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)  # XIOErrorHandler of Xlib.h
_set: list[Any] = []  # Xlib calls it until the process ends


def handle_lost_display(last_words: Callable[[], str]) -> None:
    """Print what `last_words` returns when the X server is gone, and end with exit code 3.

    Xlib ends the process after its handler; its own prints one line and ends with 1. Nothing is
    changed on other systems, and if there is no Xlib.
    """
    platform = getattr(glfw, "get_platform", None)  # GLFW 3.3, which has none, knows X11 alone
    if sys.platform != "linux" or (platform and platform() != glfw.PLATFORM_X11):
        return

    def handle(_display: object) -> int:
        try:
            os.write(2, f"glrt: {last_words()}\n".encode("utf-8", "backslashreplace"))
        finally:
            os._exit(_NO_WINDOW)

    try:
        library = ctypes.CDLL("libX11.so.6")
    except OSError:
        return
    _set[:] = [_HANDLER(handle)]
    library.XSetIOErrorHandler(_set[0])
