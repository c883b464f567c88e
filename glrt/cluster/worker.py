"""A worker's job: unpacked once, and kept between tasks with its OpenGL context and program."""

import hashlib
import pickle
from typing import Any, Protocol

from glrt.core.errors import ContextError, GlrtError, RenderError
from glrt.core.files import UNTOLD, reason
from glrt.gpu.context import open_context


class Work(Protocol):
    """A job that has begun."""

    def do(self, number: int) -> Any:
        """Return the value of a task; raises `GlrtError`."""

    def release(self) -> None:
        """Release OpenGL."""


class Job(Protocol):
    """The common part of all tasks; it can be pickled."""

    def begin(self) -> Work:
        """Return the work, without having done any."""


def packed(job: Job) -> tuple[bytes, str]:
    """Return a job with the contents of its files as bytes, and their SHA-256 in hex."""
    parcel = pickle.dumps(job, protocol=pickle.HIGHEST_PROTOCOL)
    return parcel, hashlib.sha256(parcel).hexdigest()


class _Kept:
    """Driver and work, which stay in the process of a worker between tasks."""

    drivers: dict[str, str] = {}  # noqa: RUF012 - names of OpenGL drivers, by --context
    digest = ""
    work: Work | None = None


def result(
    parcel: bytes, digest: str, number: int | None, renderer: str, context: str
) -> dict[str, Any]:
    """Return what `entry.do` adds to its answer."""
    try:
        found = _driver(context)
    except ContextError as error:
        return {"unfit": str(error)}
    told = {"renderer": found}
    if renderer and found != renderer:
        return {**told, "unfit": f"its driver is {found}, and the bits of {renderer} are wanted"}
    try:
        value = None if number is None else _work(parcel, digest).do(number)
    except GlrtError as error:
        return {**told, "problem": (str(error), error.exit_code)}
    except (MemoryError, OSError) as error:
        text = f"the worker failed: {reason(error, UNTOLD)}"
        return {**told, "problem": (text, RenderError.exit_code)}
    return {**told, "value": value}


def _driver(context: str) -> str:
    """Return the name of the OpenGL driver of this process; raises `ContextError`."""
    if context not in _Kept.drivers:
        opened = open_context(context)  # type: ignore[arg-type]
        _Kept.drivers[context] = opened.renderer
        opened.gl.release()
    return _Kept.drivers[context]


def _work(parcel: bytes, digest: str) -> Work:
    """Return the work of a job, begun once for all its tasks; raises `RenderError`."""
    if _Kept.work is None or digest != _Kept.digest:
        if hashlib.sha256(parcel).hexdigest() != digest:
            raise RenderError("the scene arrived damaged at a worker; try again.")
        if _Kept.work:
            _Kept.work.release()
        _Kept.work = None
        job: Job = pickle.loads(parcel)
        _Kept.work, _Kept.digest = job.begin(), digest
    return _Kept.work
