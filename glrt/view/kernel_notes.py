"""Notes in the user's cache folder on kernels that a driver keeps compiled.

A driver does not say what its cache holds. A note is written once a window has got a kernel in a
moment, and deleted when the driver had to compile the kernel after all.
"""

import hashlib
import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from glrt.core.resources import cache_folder
from glrt.gpu.glsl import Source
from glrt.gpu.struct_arrays import uniform_bytes
from glrt.rendering.history.temporal import Way
from glrt.rendering.passes import Resolved
from glrt.view.state.session import Session

_compiled: set[Path] = set()  # notes on what other processes compiled for this one
SLOW = 1.5  # processor seconds to open a scene: compiling takes 3 and more
_PLACES = (  # variables by which users move a driver's cache, or turn it off
    *("MESA_SHADER_CACHE_DIR", "MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DIR"),
    *("MESA_GLSL_CACHE_DISABLE", "__GL_SHADER_DISK_CACHE", "__GL_SHADER_DISK_CACHE_PATH"),
)


class Driver(NamedTuple):
    """The driver of a window, and how the window uses it."""

    name: str
    pipeline: Resolved
    version: str = ""
    uniform_bytes: int = 1 << 14  # that a uniform block may have: at least this (OpenGL 4.1)
    way: Way = Way("reset")  # of using history, which has programs of its own


def driver_of(session: Session) -> Driver:
    """Return the driver that a session's next scene is compiled by."""
    context, room = session.context, uniform_bytes(session.context.gl)
    return Driver(context.renderer, session.pipeline, context.version, room, session.moving.way)


class Note:
    """The note on one kernel of one driver."""

    def __init__(self, shaders: Sequence[Source], driver: Driver, more: Sequence[str] = ()) -> None:
        """Write and read nothing yet; `more` names other kernels that belong to it."""
        digest = hashlib.blake2b(digest_size=16)
        places = (f"{name}={os.environ.get(name)}" for name in _PLACES)
        words = driver.name, driver.version, driver.way.name, *places, *more
        for word in (*words, *(shader.live.text for shader in shaders)):
            digest.update(word.encode() + b"\0")
        self._path = cache_folder("kernels") / digest.hexdigest()

    @property
    def is_there(self) -> bool:
        """Whether the driver had the kernel when it was needed last."""
        return self._path in _compiled or self._path.exists()

    def compiled(self) -> None:
        """Remember that another process has just compiled the kernel."""
        _compiled.add(self._path)

    def learn(self, seconds: float) -> None:
        """Write or delete the note, by the processor seconds in which the kernel was ready.

        Failures are ignored: without a note, another process compiles before the window does.
        """
        _compiled.discard(self._path)
        with suppress(OSError):
            if seconds < SLOW:
                self._path.parent.mkdir(parents=True, exist_ok=True)
                self._path.touch()
            else:
                self._path.unlink(missing_ok=True)
