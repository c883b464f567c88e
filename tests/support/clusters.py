"""A cluster for tests: a scheduler and workers, in threads of this process."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from glrt.cluster.clusters import quiet


@contextmanager
def small_cluster(workers: int = 1, threads: int = 1) -> Iterator[Any]:
    """Yield a cluster whose scheduler listens on TCP; only one worker may use OpenGL."""
    with warnings.catch_warnings(), quiet():
        from distributed import LocalCluster

        start: Any = LocalCluster
        cluster = start(
            n_workers=workers,
            threads_per_worker=threads,
            processes=False,
            protocol="tcp://",
            host="127.0.0.1",
            dashboard_address=None,
            memory_limit=None,
        )
        with cluster:
            yield cluster
