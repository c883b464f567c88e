"""At rest no frame is drawn; whatever happens begins one at once."""

import pytest

from glrt.view.event_wait import AWAKE, LONGEST, SLICE, EventWait


class Desk:
    """A clock, and the moments at which something happens."""

    def __init__(self) -> None:
        self.now, self.event, self.input, self.work = 100.0, -1.0, -1.0, -1.0
        self.wait = EventWait(self.pause, lambda: self.now == self.input, lambda: self.now)

    def pause(self, seconds: float) -> None:
        end = self.now + seconds
        self.now = self.event if self.now < self.event < end else end

    def frame(self) -> float:
        """Seconds without a frame, before this one."""
        return self.wait.wait(lambda: self.now < self.work or self.work < 0)


def test_at_rest_there_is_hardly_a_frame() -> None:
    assert Desk().frame() == pytest.approx(LONGEST, abs=SLICE)


@pytest.mark.parametrize("delay", [0.01, 0.04, 3.21])
def test_an_event_begins_frames_at_once_and_they_go_on_for_a_while(delay: float) -> None:
    desk = Desk()
    desk.event = desk.now + delay
    assert desk.frame() == pytest.approx(delay)
    assert desk.frame() == 0
    desk.now += AWAKE
    assert desk.frame() > SLICE


def test_input_at_the_end_of_a_pause_is_not_overlooked() -> None:
    desk = Desk()
    desk.input = desk.now + SLICE
    assert desk.frame() == pytest.approx(SLICE)
    desk.now += AWAKE / 2
    assert desk.frame() == 0


def test_work_is_seen_within_a_slice() -> None:
    desk = Desk()
    desk.work = desk.now + 7.5 * SLICE
    assert desk.frame() == pytest.approx(8 * SLICE)
    desk.now += 100 * AWAKE
    assert desk.frame() == 0, "while there is work"
