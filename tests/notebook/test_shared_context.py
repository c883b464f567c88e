"""One context for all pictures: opened once, and current in one thread at a time."""

from contextlib import nullcontext
from threading import Event, Thread
from types import SimpleNamespace

import pytest

from glrt.core.errors import ContextError
from glrt.notebook import shared_context
from glrt.notebook.shared_context import SharedContext


def test_it_is_opened_once_and_again_only_after_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[object] = []

    def open_one() -> object:
        opened.append(SimpleNamespace(gl=nullcontext()))
        if len(opened) == 1:
            raise ContextError("no OpenGL")
        return opened[-1]

    monkeypatch.setattr(shared_context, "open_context", open_one)
    shared = SharedContext()
    with pytest.raises(ContextError), shared.turn():
        pass
    for _ in range(3):
        with shared.turn() as context:
            assert context is opened[1]


def test_a_thread_waits_until_the_other_one_has_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared_context, "open_context", lambda: SimpleNamespace(gl=nullcontext()))
    shared, begun, entered = SharedContext(), Event(), Event()

    def enter() -> None:
        begun.set()
        with shared.turn():
            entered.set()

    other = Thread(target=enter)
    with shared.turn(), shared.turn():
        other.start()
        assert begun.wait(10)
        assert not entered.wait(0.05)
    assert entered.wait(10)
    other.join(10)
