"""Scenes of these tests keep objects that are there twice: a tree breaks ties as a loop does."""

from collections.abc import Sequence
from typing import Any

import pytest

from glrt.scene import scene


@pytest.fixture(autouse=True)
def twins_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every object is shown, also one that another one covers."""

    def shown(objects: Sequence[Any], materials: object) -> tuple[int, ...]:
        del materials
        return tuple(range(len(objects)))

    monkeypatch.setattr(scene, "shown", shown)
