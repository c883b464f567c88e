"""One context for all pictures: opened once, and current in one thread at a time."""

from contextlib import nullcontext
from threading import Event, Thread
from time import sleep
from types import SimpleNamespace

import pytest

from glrt.api import render
from glrt.core.errors import ContextError
from glrt.image.sources import load
from glrt.notebook import shared_context
from glrt.notebook.live import Live
from glrt.notebook.shared_context import HOLD, SharedContext
from glrt.settings import settings_for


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


@pytest.mark.slow
def test_pictures_are_answered_in_a_thread_while_cells_render_and_ask() -> None:
    """Kernels may answer pages in a thread of their own."""
    room = load("cornell")
    settings = settings_for(room.render, width=48, height=32, samples=100_000)
    lives = [Live(room, settings), Live(load("lamps"), settings)]
    is_over, notices, answers = Event(), list[str](), [0, 0]

    def answer() -> None:
        while not is_over.is_set():
            for number, live in enumerate(lives):
                reply = live.answer({"turn": [0.01, 0]} if answers[0] % 10 < 3 else {})
                notices.extend([reply.content["notice"]] if reply.content.get("is_problem") else [])
                answers[number] += 1

    thread = Thread(target=answer)
    thread.start()
    try:
        bits = {render(room, 4, width=24, height=16).radiance.tobytes() for _ in range(8)}
        before = list(answers)
        lives[0].rest()
        assert all(live.answer({}).content["wait"] in (0, HOLD) for live in lives)
        while answers[1] < before[1] + 4:
            assert thread.is_alive()
            sleep(0.05)
    finally:
        is_over.set()
        thread.join(60)
        for live in lives:
            live.rest()
    assert notices == []
    assert len(bits) == 1
    assert min(answers) > 4
