"""Parameters of a test of which some are slow."""

from collections.abc import Collection, Iterable
from typing import Any

import pytest


def some_slow(values: Iterable[str], slow: Collection[str]) -> list[Any]:
    """The values for `pytest.mark.parametrize`, of which those in `slow` are marked slow."""
    return [pytest.param(it, marks=pytest.mark.slow) if it in slow else it for it in values]
