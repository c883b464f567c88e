"""The command does not look for garbage among its imports; programs are let alone."""

import gc
from collections.abc import Iterator

import pytest

from glrt import garbage


@pytest.fixture(autouse=True)
def as_before() -> Iterator[None]:
    assert gc.isenabled()
    yield
    gc.unfreeze()
    gc.enable()


def test_the_command_looks_for_garbage_in_what_comes_after_its_imports(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(garbage, "is_command", lambda: True)
    garbage.leave_imports_alone()
    assert not gc.isenabled()
    imported: list[object] = []
    garbage.loaded()
    assert gc.isenabled()
    assert not any(found is imported for found in gc.get_objects())
    later: list[object] = []
    assert any(found is later for found in gc.get_objects())


def test_a_program_that_imports_glrt_collects_as_it_likes() -> None:
    garbage.leave_imports_alone()
    assert gc.isenabled()
    gc.disable()
    garbage.loaded()
    assert not gc.isenabled()
    assert gc.get_freeze_count() == 0
