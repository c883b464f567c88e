"""Results that are kept while what they were made of is the same object."""

from threading import Event, Thread

import pytest

from glrt.core import memo
from glrt.core.memo import ComputedOnce, computed_once, kept_for_the_same


def test_a_result_is_kept_for_the_same_objects_and_no_others() -> None:
    asked = []

    @kept_for_the_same
    def length(*given: list[int]) -> int:
        asked.append(given)
        return sum(map(len, given))

    one, other = [1, 2], [1, 2]
    assert [length(one), length(one), length(one)] == [2, 2, 2]
    assert len(asked) == 1
    assert length(other) == 2, "equal, but another"
    assert length(one) == 2, "still known"
    assert len(asked) == 2
    assert length(one, other) == 4
    assert length(one) == 2
    assert len(asked) == 4


def test_threads_do_not_wait_while_another_object_computes_a_property() -> None:
    begun, may_end = Event(), Event()

    class Thing:
        def __init__(self, waits: bool) -> None:
            self.waits, self.asked = waits, 0

        @computed_once
        def value(self) -> int:
            self.asked += 1
            if self.waits:
                begun.set()
                assert may_end.wait(60)
            return 3

    slow, quick = Thing(True), Thing(False)
    thread = Thread(target=lambda: slow.value)
    thread.start()
    assert begun.wait(60)
    assert [quick.value, quick.value, quick.asked] == [3, 3, 1]
    assert thread.is_alive()
    may_end.set()
    thread.join()
    assert slow.value == 3
    assert isinstance(Thing.value, ComputedOnce)


def test_a_result_is_not_that_of_another_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """The other thread has its turn between the comparison and the return."""

    @kept_for_the_same
    def length(given: list[int]) -> int:
        return len(given)

    def is_same(known: object, given: object) -> bool:
        monkeypatch.setattr(memo, "_is_same", lambda *_: False)
        length([1])
        return known is given

    pair = [1, 2]
    length(pair)
    monkeypatch.setattr(memo, "_is_same", is_same)
    assert length(pair) == 2
