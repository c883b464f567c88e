"""Survive the loss of an X server: Xlib would end the process, though a hidden window draws on."""

import ctypes
from functools import cache
from typing import Any

_IO_HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
_EXIT_HANDLER = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
_displays: set[int] = set()  # addresses of displays that the process may outlive
_before: list[Any] = []  # the handler that was set before, for all other displays
_stay = _EXIT_HANDLER(lambda _display, _data: None)


def outlive(display: int) -> None:
    """Let the process go on if this display's server goes away; needs libX11 1.7 or newer."""
    library = _library()
    if library:
        _displays.add(display)
        library.XSetIOErrorExitHandler(ctypes.c_void_p(display), _stay, None)


@cache
def _library() -> Any:
    """Load Xlib with a handler for lost servers; other displays keep the earlier handler."""
    try:
        library = ctypes.CDLL("libX11.so.6")
        _ = library.XSetIOErrorExitHandler
    except (OSError, AttributeError):
        return None
    library.XSetIOErrorHandler.restype = ctypes.c_void_p
    if address := library.XSetIOErrorHandler(_lost):
        _before.append(_IO_HANDLER(address))
    return library


def _handle_loss(display: int) -> int:
    if display not in _displays:
        for handler in _before:
            handler(display)
    return 0


_lost = _IO_HANDLER(_handle_loss)
