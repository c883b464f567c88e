"""Mitsuba, for the tests that ask it."""

import sys
from collections.abc import Iterator
from importlib.util import find_spec

import pytest

from bench.peer import Peer
from glrt.core.errors import RenderError
from tests.mitsuba.engine import LLVM_PACKAGE
from tests.support.system_packages import needs_package

NO_WHEEL = "Mitsuba has no wheel for this system"


@pytest.fixture(scope="module")
def mitsuba() -> Iterator[Peer]:
    """Mitsuba in its fast mode, ready."""
    if find_spec("mitsuba") is None:
        pytest.skip(NO_WHEEL)
    try:
        peer = Peer([sys.executable, "-m", "tests.mitsuba.serve"])
    except RenderError as error:
        needs_package(LLVM_PACKAGE not in str(error), LLVM_PACKAGE)
        raise
    yield peer
    peer.close()
