"""OpenGL contexts without a window: EGL, OSMesa, moderngl's own hidden window.

EGL needs no display server. OSMesa is software, drawn into plain memory. Windows, macOS and an X
server offer the hidden window.
"""

import ctypes
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import cache, cached_property, partial
from itertools import takewhile
from typing import Any, Literal

import glcontext  # type: ignore[import-untyped]
import moderngl

from glrt.core.errors import ContextError, RenderError
from glrt.gpu.context_turns import TurnTaker
from glrt.gpu.osmesa import OSMesa
from glrt.gpu.programs import Programs

Choice = Literal["auto", "egl", "osmesa", "window"]
Pipeline = Literal["auto", "compute", "fragment"]
ROUTES = ("egl", "window", "osmesa")  # in this order: the last is never hardware
MOST_DEVICES = 16  # devices of EGL that are tried
MOST_FLAGS = 16  # error flags that are read: a lost context may raise one forever
COMPUTE, FRAGMENT = 430, 410  # the versions of OpenGL that the two pipelines need
_RESETS = {  # values of glGetGraphicsResetStatus: whose fault it was
    0x8253: "over this render",
    0x8254: "over another program's work",
    0x8255: "for a reason of its own",
}
_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "swiftshader", "basic render", "gdi")
ADVICE = (
    "On Debian or Ubuntu install libgl1 libegl1 libegl-mesa0 libgl1-mesa-dri (software OpenGL is "
    "among them), or the driver of your GPU; `glrt doctor` tries every route."
)


@dataclass(frozen=True)
class Context:
    """An open OpenGL context, and the route and device by which it was opened."""

    gl: moderngl.Context
    route: str
    device: int = 0  # its number among the devices of the route

    @property
    def renderer(self) -> str:
        """Name of the renderer, as the driver gives it."""
        return str(self.gl.info["GL_RENDERER"])

    @property
    def version(self) -> str:
        """Version of OpenGL, as the driver gives it."""
        return str(self.gl.info["GL_VERSION"])

    @property
    def has_compute(self) -> bool:
        """Whether compute shaders and storage blocks are available."""
        return self.gl.version_code >= COMPUTE

    @property
    def is_software(self) -> bool:
        """Whether a software driver draws, on the processor."""
        return any(word in self.renderer.lower() for word in _SOFTWARE)

    @cached_property
    def programs(self) -> Programs:
        """Compiled programs that the users of this context share."""
        return Programs()

    def finish(self) -> None:
        """Wait until the driver has done all work; RenderError if it lost this context over it."""
        self.gl.finish()
        if (status := self._reset_status()) in _RESETS:
            raise RenderError(
                f"the driver reset the graphics device {_RESETS[status]}: all that it held is "
                "gone. Another program may have crashed it, or a dispatch took too long; then a "
                "smaller picture, or a --crop, may do."
            )

    def checked(self, what: str) -> AbstractContextManager[None]:
        """Return the context manager `checked` for this context; `what` names the work inside."""
        return checked(self.gl, what)

    @cached_property
    def _reset_status(self) -> Callable[[], int]:
        """The function glGetGraphicsResetStatus; one that returns 0 if the driver lacks it."""
        if self.gl.version_code < 450 and "GL_KHR_robustness" not in self.gl.extensions:
            return lambda: 0
        loader = self.gl.mglo._context  # moderngl has no method for it
        address = loader.load_opengl_function("glGetGraphicsResetStatus")
        return ctypes.CFUNCTYPE(ctypes.c_uint)(address) if address else lambda: 0


@contextmanager
def checked(gl: moderngl.Context, what: str) -> Iterator[None]:
    """Raise RenderError if the driver finds an error in what is done inside; `what` names it.

    Errors that others left in this context are dropped first.
    """
    _take_errors(gl)
    try:
        yield
    except moderngl.Error as error:
        raise RenderError(f"the driver refuses {what}: {error}. {_SMALLER}") from error
    if errors := _take_errors(gl):
        raise RenderError(f"the driver refuses {what}: {', '.join(errors)}. {_SMALLER}")


_SMALLER = "It may be out of memory, or at its limits: a smaller picture, or a --crop, takes less."


def _take_errors(gl: moderngl.Context) -> list[str]:
    """Read up to MOST_FLAGS raised flags; a driver may keep several, and each read lowers one."""
    flags = (gl.error for _ in range(MOST_FLAGS))
    return [*takewhile(lambda flag: flag != "GL_NO_ERROR", flags)]


def open_context(choice: Choice = "auto", pipeline: Pipeline = "auto") -> Context:
    """Open a context by one route, or by the best: hardware before software, else the first.

    It has at least OpenGL 4.3 for the compute pipeline, else at least 4.1. Raises ContextError with
    the reason of every route that failed.
    """
    failures: list[str] = []
    required = COMPUTE if pipeline == "compute" else FRAGMENT
    software: Context | None = None
    for route in ROUTES if choice == "auto" else (choice,):
        if software and not (route == "window" and _window_is_hardware(_display())):
            break
        for context in _try_route(route, failures, required):
            if choice != "auto" or not context.is_software:
                return _prefer(context, software)
            software = _prefer(software or context, context)
    if software:
        return software
    raise ContextError(f"no usable OpenGL {required / 100}: {'; '.join(failures)}. {ADVICE}")


def open_device(route: str, device: int = 0) -> Context:
    """Open one device of a route; ContextError if that fails. Only EGL has several devices."""
    try:
        return Context(_create_newest(route, device, FRAGMENT), route, device)
    except Exception as error:  # as in _try_route
        raise ContextError(f"{route}: {error}") from error


def _prefer(chosen: Context, other: Context | None) -> Context:
    if other and other is not chosen:
        other.gl.release()
    return chosen


# Runs in a process of its own: Xlib ends a process if its X server refuses a request or goes away.
_ASK_WINDOW = """
from glrt.gpu.context import open_device
print("software" if open_device("window").is_software else "hardware")
"""
PATIENCE = 10.0  # seconds to wait for a hidden window if another context works


@cache
def _window_is_hardware(display: str) -> bool:
    """Return whether a hidden window on this display opens, and draws by hardware."""
    if not _has_display() or getattr(sys, "frozen", False):  # sys.executable is no Python then
        return False
    command = [sys.executable, "-P", "-c", _ASK_WINDOW]
    paths = {"PYTHONPATH": os.pathsep.join(sys.path)}
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=PATIENCE,
            env={**os.environ, **paths},
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0 and done.stdout.strip() == b"hardware"


def _has_display() -> bool:
    return sys.platform in ("win32", "darwin") or bool(_display())


def _display() -> str:
    return os.environ.get("DISPLAY", "")


def _try_route(route: str, failures: list[str], required: int = FRAGMENT) -> Iterator[Context]:
    """Yield every context that a route offers, one at a time; EGL may offer several devices.

    The first may fail, such as a GPU that this user may not open, and a later one open.
    """
    has_opened = False
    for device in range(MOST_DEVICES if route == "egl" else 1):
        try:
            gl = _create_newest(route, device, required)
        except Exception as error:  # each backend raises what it likes: it becomes the reason
            if has_opened:
                return  # there are no more devices
            if device == 0:
                failures.append(f"{route}: {error}")
            continue
        has_opened = True
        yield Context(gl, route, device)


def _create_newest(route: str, device: int, required: int) -> moderngl.Context:
    """Create a context with compute shaders, else one of the required version."""
    try:
        return _create(route, device, COMPUTE)
    except Exception:
        if required == COMPUTE:
            raise
        return _create(route, device, required)


def _create(route: str, device: int, required: int) -> moderngl.Context:
    if route == "window" and not _has_display():
        raise ContextError("there is no display (DISPLAY is not set)")
    loader: Any = TurnTaker(partial(_loader, route, device, required))
    try:
        with loader:
            gl = moderngl.create_context(require=required, context=loader)
            assert gl.info  # read while the context is current; moderngl keeps it
            return gl
    except Exception:
        loader.release()
        raise


def _loader(route: str, device: int, required: int) -> Any:
    if route == "osmesa":
        return OSMesa(5 if required == COMPUTE else 1)
    options: dict[str, Any] = {"mode": "standalone", "glversion": required}
    if route == "egl":
        return glcontext.get_backend_by_name("egl")(device_index=device, **options)
    return glcontext.default_backend()(**options)
