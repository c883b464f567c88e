"""The function that workers run.

It reaches workers as code, not as a name. So a worker without glrt, or with another version, can
answer what is wrong with it. Answers are plain dictionaries for the same reason. Imports stand
inside, since this module must not need glrt to be there.
"""

from typing import Any


def same(content: bytes) -> bytes:
    """Return what a worker is to hold for tasks."""
    return content


def do(
    number: int | None, parcel: bytes, digest: str, version: str, renderer: str, context: str
) -> dict[str, Any]:
    """Return the answer to a task of a job, or what keeps this worker from it.

    `parcel` holds the job, and `digest` is its SHA-256; `number` is that of the task, and None asks
    for the driver alone. The job needs this `version` of glrt and this `renderer`; an empty one is
    any. Keys of the answer: `worker`, `address`, `renderer`, and one of `unfit` (why
    the worker cannot take part), `problem` (a message and its exit code) and `value`.
    """
    from distributed import get_worker

    me = get_worker()
    name = me.address if me.name == me.address else f"{me.name} ({me.address})"
    answer: dict[str, Any] = {"worker": name, "address": me.address, "renderer": ""}
    try:
        from glrt.core.version import VERSION
    except ImportError:
        return answer | {"unfit": f"it has no glrt: install glrt {version} there"}
    if version != VERSION:
        return answer | {"unfit": f"it has glrt {VERSION}: install glrt {version} there"}
    if me.state.nthreads != 1:
        return answer | {
            "unfit": f"it has {me.state.nthreads} threads, and OpenGL needs one: start it with "
            "`dask worker --nthreads 1`, and more of them with `--nworkers`"
        }
    from glrt.cluster.worker import result

    return answer | result(parcel, digest, number, renderer, context)
