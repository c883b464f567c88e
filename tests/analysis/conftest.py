"""A fixture: searches for the method that suffices are small, and share their references."""

import time
from types import SimpleNamespace

import pytest

from glrt.analysis import reference as references
from glrt.analysis.method_choice import search
from glrt.gpu.context import Context
from tests.support.verdicts import LARGER, SIZE


@pytest.fixture
def small_and_cached(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    context: Context,
    exact_kernels: None,
) -> None:
    """Small frames, a cache for all these tests, and time that other programs do not take.

    That is processor time, where processors render, of the kernels that users get.
    """
    del exact_kernels
    if context.is_software:
        clock = SimpleNamespace(perf_counter=time.process_time)
        monkeypatch.setattr(references, "time", clock)
    size = LARGER if request.node.get_closest_marker("larger") else SIZE
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "suffices"))
    monkeypatch.setattr(search, "HEIGHT", size)
    monkeypatch.setattr(search, "REFERENCE_WORK", 5e8)
