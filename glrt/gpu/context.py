"""OpenGL contexts without a window: EGL, OSMesa, moderngl's own hidden window.

EGL needs no display server. OSMesa is software, drawn into plain memory.
The hidden window is what Windows, macOS and an X server offer.
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
MOST_DEVICES = 16  # of EGL that are looked at
MOST_FLAGS = 16  # of errors that are looked at: a lost context may raise one for ever
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
    """An open context: moderngl's, the route it came by, and what draws behind it."""

    gl: moderngl.Context
    route: str
    device: int = 0  # of those that the route offers

    @property
    def renderer(self) -> str:
        """The driver's name of the renderer."""
        return str(self.gl.info["GL_RENDERER"])

    @property
    def version(self) -> str:
        """The driver's version of OpenGL."""
        return str(self.gl.info["GL_VERSION"])

    @property
    def has_compute(self) -> bool:
        """Whether there are compute shaders and storage blocks."""
        return self.gl.version_code >= COMPUTE

    @property
    def is_software(self) -> bool:
        """Whether the processor draws."""
        return any(word in self.renderer.lower() for word in _SOFTWARE)

    @cached_property
    def programs(self) -> Programs:
        """The programs that its users share."""
        return Programs()

    def finish(self) -> None:
        """Wait until the driver has done all work. RenderError if it lost this context over it."""
        self.gl.finish()
        if (status := self._reset_status()) in _RESETS:
            raise RenderError(
                f"the driver reset the graphics device {_RESETS[status]}: all that it held is "
                "gone. Another program may have crashed it, or a dispatch took too long; then a "
                "smaller picture, or a --crop, may do."
            )

    def checked(self, what: str) -> AbstractContextManager[None]:
        """`checked` of this context."""
        return checked(self.gl, what)

    @cached_property
    def _reset_status(self) -> Callable[[], int]:
        """glGetGraphicsResetStatus; where a driver does not have it, all is taken to be well."""
        if self.gl.version_code < 450 and "GL_KHR_robustness" not in self.gl.extensions:
            return lambda: 0
        loader = self.gl.mglo._context  # moderngl has no method for it
        address = loader.load_opengl_function("glGetGraphicsResetStatus")
        return ctypes.CFUNCTYPE(ctypes.c_uint)(address) if address else lambda: 0


@contextmanager
def checked(gl: moderngl.Context, what: str) -> Iterator[None]:
    """RenderError where the driver finds an error in what is done inside.

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
    """The flags that are raised; a driver may keep some, and each look lowers one."""
    flags = (gl.error for _ in range(MOST_FLAGS))
    return [*takewhile(lambda flag: flag != "GL_NO_ERROR", flags)]


def open_context(choice: Choice = "auto", pipeline: Pipeline = "auto") -> Context:
    """Open a route, or the best: hardware before software, else the first that works.

    It has OpenGL 4.3 at least if the pipeline is to be compute, else 4.1. Raises ContextError with
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
    """Open one device of a route; ContextError says why it cannot be. Only EGL has several."""
    try:
        return Context(_create_newest(route, device, FRAGMENT), route, device)
    except Exception as error:  # as in _try_route
        raise ContextError(f"{route}: {error}") from error


def _prefer(chosen: Context, other: Context | None) -> Context:
    if other and other is not chosen:
        other.gl.release()
    return chosen


# A process of its own: Xlib ends the process whose X server refuses a request or goes away.
_ASK_WINDOW = """
from glrt.gpu.context import open_device
print("software" if open_device("window").is_software else "hardware")
"""
PATIENCE = 10.0  # seconds for a hidden window, where there is another context already


@cache
def _window_is_hardware(display: str) -> bool:
    """Whether a hidden window on this display opens, and draws by hardware."""
    if not _has_display() or getattr(sys, "frozen", False):  # then sys.executable is no Python
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
    """Every context that a route offers, one at a time; EGL may offer several devices.

    The first may fail, as a GPU that is closed to this user does, and a later one open.
    """
    has_opened = False
    for device in range(MOST_DEVICES if route == "egl" else 1):
        try:
            gl = _create_newest(route, device, required)
        except Exception as error:  # each backend raises what it likes: it becomes the reason
            if has_opened:
                return  # there are no more
            if device == 0:
                failures.append(f"{route}: {error}")
            continue
        has_opened = True
        yield Context(gl, route, device)


def _create_newest(route: str, device: int, required: int) -> moderngl.Context:
    """With compute shaders, else as new as is required."""
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
