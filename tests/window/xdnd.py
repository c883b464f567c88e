"""Drop a file on a window, as a file manager does: `python -m tests.window.xdnd WINDOW FILE`.

The source of the protocol XDND, version 5, by Xlib alone: Enter, Position, Drop, and the path as
text/uri-list when the window asks for it. Exit code 0 once the window has said Finished; 1 if it
takes no drop, or does not answer.
"""

import ctypes
import sys
import time
from ctypes import POINTER, byref, c_char_p, c_int, c_long, c_uint, c_ulong, c_void_p
from ctypes.util import find_library
from pathlib import Path
from typing import Any

VERSION = 5
SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33
REPLACE = 0  # what the property held
PATIENCE = 60.0  # seconds for an answer
_TYPE = "text/uri-list"
_NAMES = (
    *("XdndEnter", "XdndPosition", "XdndStatus", "XdndDrop", "XdndFinished"),
    *("XdndSelection", "XdndActionCopy", _TYPE),
)


class ClientMessage(ctypes.Structure):
    """XClientMessageEvent with data of 32 bits."""

    _fields_ = (
        ("type", c_int),
        ("serial", c_ulong),
        ("send_event", c_int),
        ("display", c_void_p),
        ("window", c_ulong),
        ("message_type", c_ulong),
        ("format", c_int),
        ("data", c_long * 5),
    )


class SelectionRequest(ctypes.Structure):
    """XSelectionRequestEvent."""

    _fields_ = (
        ("type", c_int),
        ("serial", c_ulong),
        ("send_event", c_int),
        ("display", c_void_p),
        ("owner", c_ulong),
        ("requestor", c_ulong),
        ("selection", c_ulong),
        ("target", c_ulong),
        ("property", c_ulong),
        ("time", c_ulong),
    )


class SelectionNotify(ctypes.Structure):
    """XSelectionEvent."""

    _fields_ = (
        ("type", c_int),
        ("serial", c_ulong),
        ("send_event", c_int),
        ("display", c_void_p),
        ("requestor", c_ulong),
        ("selection", c_ulong),
        ("target", c_ulong),
        ("property", c_ulong),
        ("time", c_ulong),
    )


class Event(ctypes.Union):
    """XEvent."""

    _fields_ = (
        ("type", c_int),
        ("client", ClientMessage),
        ("request", SelectionRequest),
        ("notify", SelectionNotify),
        ("pad", c_long * 24),
    )


def library() -> Any:
    """Xlib, with the types of what is called."""
    x11: Any = ctypes.CDLL(find_library("X11") or "libX11.so.6")
    x11.XOpenDisplay.restype = c_void_p
    x11.XDefaultRootWindow.restype = x11.XCreateSimpleWindow.restype = c_ulong
    x11.XInternAtom.restype = c_ulong
    x11.XInternAtom.argtypes = (c_void_p, c_char_p, c_int)
    x11.XDefaultRootWindow.argtypes = x11.XFlush.argtypes = x11.XPending.argtypes = (c_void_p,)
    sizes = (c_int, c_int, c_uint, c_uint, c_uint)
    x11.XCreateSimpleWindow.argtypes = (c_void_p, c_ulong, *sizes, c_ulong, c_ulong)
    x11.XSetSelectionOwner.argtypes = (c_void_p, c_ulong, c_ulong, c_ulong)
    x11.XSendEvent.argtypes = (c_void_p, c_ulong, c_int, c_long, POINTER(Event))
    x11.XNextEvent.argtypes = (c_void_p, POINTER(Event))
    of_property = (c_void_p, c_ulong, c_ulong, c_ulong, c_int, c_int, c_char_p, c_int)
    x11.XChangeProperty.argtypes = of_property
    return x11


class Source:
    """A window of its own that offers one file to another window."""

    def __init__(self, target: int, file: Path) -> None:
        """SystemExit where there is no display."""
        self._x11, self._target = library(), target
        self._uri = f"{file.absolute().as_uri()}\r\n".encode()
        self._display = self._x11.XOpenDisplay(None) or sys.exit("no display")
        root = self._x11.XDefaultRootWindow(self._display)
        self._window = self._x11.XCreateSimpleWindow(self._display, root, 0, 0, 1, 1, 0, 0, 0)
        self._atoms = {
            name: self._x11.XInternAtom(self._display, name.encode(), 0) for name in _NAMES
        }

    def drop(self, x: int, y: int) -> bool:
        """Drop at a place of the screen, and return whether the window took it."""
        atoms, listed = self._atoms, self._atoms[_TYPE]
        self._x11.XSetSelectionOwner(self._display, atoms["XdndSelection"], self._window, 0)
        self._send("XdndEnter", VERSION << 24, listed)
        self._send("XdndPosition", 0, x << 16 | y, 0, atoms["XdndActionCopy"])
        status = self._answer("XdndStatus")
        if not status or not status[1] & 1:
            return False
        self._send("XdndDrop", 0, 0)
        finished = self._answer("XdndFinished")
        return bool(finished and finished[1])  # GLFW says how many bytes it got, not a flag

    def _send(self, name: str, *data: int) -> None:
        event = Event()
        event.client.type, event.client.window = CLIENT_MESSAGE, self._target
        event.client.message_type, event.client.format = self._atoms[name], 32
        event.client.data[:] = (self._window, *data, *[0] * (4 - len(data)))
        self._x11.XSendEvent(self._display, self._target, 0, 0, byref(event))
        self._x11.XFlush(self._display)

    def _answer(self, name: str) -> list[int]:
        """The data of a message to this window; nothing if it does not come."""
        deadline, event = time.monotonic() + PATIENCE, Event()
        while time.monotonic() < deadline:
            if not self._x11.XPending(self._display):
                time.sleep(0.01)
                continue
            self._x11.XNextEvent(self._display, byref(event))
            if event.type == SELECTION_REQUEST:
                self._give(event.request)
            is_message = event.type == CLIENT_MESSAGE
            if is_message and event.client.message_type == self._atoms[name]:
                return list(event.client.data)
        return []

    def _give(self, request: SelectionRequest) -> None:
        """The path, where the window wants it."""
        self._x11.XChangeProperty(
            *(self._display, request.requestor, request.property, request.target),
            *(8, REPLACE, self._uri, len(self._uri)),
        )
        event = Event()
        event.notify.type = SELECTION_NOTIFY
        for field in ("requestor", "selection", "target", "property", "time"):
            setattr(event.notify, field, getattr(request, field))
        self._x11.XSendEvent(self._display, request.requestor, 0, 0, byref(event))
        self._x11.XFlush(self._display)


def main(window: str, file: str) -> int:
    """Exit code 0 if the window took the file."""
    return 0 if Source(int(window), Path(file)).drop(100, 100) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
