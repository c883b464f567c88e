"""Contexts of EGL, GLX and OSMesa that take turns in one thread.

A thread has one current context. EGL refuses a context while GLX has one: later calls would reach
the wrong context. In the opposite case, GLX answers with an X error, which ends the process. OSMesa
takes over, and EGL does not notice.
"""

import ctypes
from collections.abc import Callable
from functools import cache, partial
from threading import local
from typing import Any

from glrt.core.errors import RenderError
from glrt.gpu.xlib import outlive

_DRAW, _READ = 0x3059, 0x305A  # EGL_DRAW, EGL_READ


class _Entered(local):
    """The loaders that this thread has entered, the current one last."""

    def __init__(self) -> None:
        self.loaders: list[Any] = []


_entered = _Entered()


class TurnTaker:
    """A function loader for moderngl whose context is current only while it is entered.

    By themselves, glcontext's loaders and OSMesa do not restore the context of another interface.
    """

    def __init__(self, create: Callable[[], Any]) -> None:
        """Make the inner loader by `create`; its context is not current afterwards."""
        back = leave()
        try:
            self._loader = create()
            self._is_visible = _is_current()  # false for OSMesa's context
            if _glx_context():
                outlive(_glx().glXGetCurrentDisplay())
        finally:
            leave()
            back()
        self._backs: list[Callable[[], object]] = []

    def load_opengl_function(self, name: str) -> int:
        """Return the address of an OpenGL function, 0 if there is none."""
        return int(self._loader.load_opengl_function(name))

    def __enter__(self) -> "TurnTaker":
        """Make the context current; RenderError if the driver does not."""
        back = leave()
        self._loader.__enter__()
        if self._is_visible and not _is_current():
            back()
            raise RenderError("the driver does not make its context current: has the display gone?")
        self._backs.append(back)
        _entered.loaders.append(self._loader)
        return self

    def __exit__(self, *_: object) -> None:
        """Make the previous context current again, if there was one."""
        _entered.loaders.pop()
        leave()
        self._backs.pop()()

    def release(self) -> None:
        """Destroy the context."""
        back = leave()
        self._loader.release()
        if self._loader not in _entered.loaders:
            back()


def leave() -> Callable[[], object]:
    """Make no context of EGL or GLX current; return a function that restores the last one.

    The context may belong to another part of the program, such as a window around glrt.
    """
    ways = [way for way in (_leave_egl(), _leave_glx()) if way]
    if _entered.loaders:
        return _entered.loaders[-1].__enter__  # type: ignore[no-any-return]
    return ways[0] if ways else lambda: None


def _is_current() -> bool:
    """Return whether EGL or GLX has a current context."""
    return bool(_egl_context() or _glx_context())


def _egl_context() -> int | None:
    egl = _egl()
    return egl.eglGetCurrentContext() if egl else None


def _glx_context() -> int | None:
    glx = _glx()
    return glx.glXGetCurrentContext() if glx else None


def _leave_egl() -> Callable[[], object] | None:
    if not (context := _egl_context()):
        return None
    egl = _egl()
    display, *surfaces = egl.eglGetCurrentDisplay(), *map(egl.eglGetCurrentSurface, (_DRAW, _READ))
    egl.eglMakeCurrent(ctypes.c_void_p(display), None, None, None)
    return partial(egl.eglMakeCurrent, *map(ctypes.c_void_p, (display, *surfaces, context)))


def _leave_glx() -> Callable[[], object] | None:
    if not (context := _glx_context()):
        return None
    glx = _glx()
    display, drawable = glx.glXGetCurrentDisplay(), glx.glXGetCurrentDrawable()
    glx.glXMakeCurrent(ctypes.c_void_p(display), None, None)
    return partial(glx.glXMakeCurrent, *map(ctypes.c_void_p, (display, drawable, context)))


def _egl() -> Any:
    return _library("libEGL.so.1", "eglGetCurrent", ("Context", "Display", "Surface"))


def _glx() -> Any:
    return _library("libGL.so.1", "glXGetCurrent", ("Context", "Display", "Drawable"))


@cache
def _library(name: str, prefix: str, things: tuple[str, ...]) -> Any:
    """Load a library, and let functions of these names return pointers; None if it lacks them."""
    try:
        library = ctypes.CDLL(name)
        for thing in things:
            getattr(library, prefix + thing).restype = ctypes.c_void_p
    except (OSError, AttributeError):
        return None
    return library
