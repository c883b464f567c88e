"""Mitsuba, for the tests that ask it."""

import sys
from collections.abc import Iterator

import pytest

from bench.peer import Peer
from glrt.core.errors import RenderError
from tests.mitsuba.engine import LLVM_PACKAGE
from tests.support.system_packages import needs_mitsuba, needs_package


@pytest.fixture(scope="module")
def mitsuba() -> Iterator[Peer]:
    """Mitsuba in its fast mode, ready."""
    needs_mitsuba()
    try:
        peer = Peer([sys.executable, "-m", "tests.mitsuba.serve"])
    except RenderError as error:
        needs_package(LLVM_PACKAGE not in str(error), LLVM_PACKAGE)
        raise
    yield peer
    peer.close()
