"""What the worker processes of pytest-xdist tell the run that started them, as they end."""

from typing import Any

import pytest


def report(config: pytest.Config, name: str, value: float | str) -> None:
    """In a worker: hand over a value. To call before pytest-xdist ends the worker's session."""
    if hasattr(config, "workeroutput"):
        config.workeroutput[name] = value


def reported_by(node: Any, name: str, otherwise: float | str) -> float | str:
    """In `pytest_testnodedown`: what the worker handed over; one that crashed has told nothing."""
    value: float | str = getattr(node, "workeroutput", {}).get(name, otherwise)
    return value
