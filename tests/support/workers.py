"""Values that worker processes of pytest-xdist report at their end to the run that started them."""

from typing import Any

import pytest


def report(config: pytest.Config, name: str, value: float | str) -> None:
    """In a worker: hand over a value. To call before pytest-xdist ends the worker's session."""
    if hasattr(config, "workeroutput"):
        config.workeroutput[name] = value


def reported_by(node: Any, name: str, otherwise: float | str) -> float | str:
    """In `pytest_testnodedown`: the worker's value, or `otherwise` if it crashed."""
    value: float | str = getattr(node, "workeroutput", {}).get(name, otherwise)
    return value
