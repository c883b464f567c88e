"""Open a cluster of Dask's `distributed`, or start processes of this machine as one."""

import logging
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from glrt.cluster.addresses import Address
from glrt.core.errors import RenderError, UsageError
from glrt.core.install import install
from glrt.core.text import quoted

PATIENCE = 10  # seconds to reach a scheduler
DEATHS = 10  # workers that one task may lose before it counts as failed
_CONFIG = {
    "logging": {"distributed": "critical"},
    "distributed.scheduler.allowed-failures": DEATHS,
    "distributed.admin.large-graph-warning-threshold": "1TB",  # a scene with its files is large
    "distributed.comm.retry.count": 0,
}


def check_installed() -> None:
    """Raise `UsageError` if the package is missing."""
    _library()


def _library() -> Any:
    try:
        import distributed
    except ModuleNotFoundError:
        raise UsageError(
            f"--cluster needs the Python package distributed: type `{install('cluster')}`."
        ) from None
    return distributed


@contextmanager
def quiet() -> Iterator[None]:
    """Keep records and warnings of libraries from the user's terminal inside the block."""
    before = logging.root.manager.disable
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        logging.disable(logging.CRITICAL)
        try:
            yield
        finally:
            logging.disable(before)


@contextmanager
def opened(address: Address) -> Iterator[Any]:
    """Yield a client of a cluster; a local one ends with the block.

    Raises `RenderError` if no scheduler answers, and `UsageError` for a file that is none.
    """
    with quiet():
        import cloudpickle
        import dask.config

        from glrt.cluster import entry

        distributed = _library()
        cloudpickle.register_pickle_by_value(entry)
        with dask.config.set(_CONFIG):
            target = _local(distributed, address) if address.count else _reached(address)
            try:
                client = distributed.Client(**target, timeout=PATIENCE, set_as_default=False)
            except (OSError, TimeoutError, ValueError):
                raise RenderError(
                    f"No scheduler answers at {address.text}. Start one with `dask scheduler`, or "
                    "check the address."
                ) from None
            try:
                yield client
            finally:
                _close(client, target.get("address") if address.count else None)


def _local(distributed: Any, address: Address) -> dict[str, Any]:
    """Start processes of one thread, which share the cores."""
    threads = max(1, (os.cpu_count() or 1) // address.count)
    started = distributed.LocalCluster(
        n_workers=address.count,
        threads_per_worker=1,
        processes=True,
        memory_limit=None,  # a worker is not ended for the memory that others take
        dashboard_address=None,
        silence_logs=logging.CRITICAL,
        env={"LP_NUM_THREADS": str(threads), "DASK_LOGGING__DISTRIBUTED": "critical"},
    )
    return {"address": started}


def _reached(address: Address) -> dict[str, Any]:
    if address.kind == "scheduler":
        return {"address": address.text}
    if not Path(address.text).is_file():
        raise UsageError(
            f"--cluster {address.text}: there is no file {quoted(address.text)}. Start `dask "
            "scheduler --scheduler-file` with it, or give local:N or tcp://HOST:PORT."
        )
    return {"scheduler_file": address.text}


def _close(client: Any, local: Any) -> None:
    with suppress(Exception):  # the scheduler may have ended
        client.close(timeout=2)
    if local is not None:
        with suppress(Exception):
            local.close(timeout=5)
