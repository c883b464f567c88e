"""The size of previews: what fits into a frame, in addition to the work of an edit."""

from itertools import pairwise
from typing import Any

import pytest

from glrt.view.state.preview_size import COARSEST, FACTORS, FINER, LEAST, OVERRUN, STILL, Preview
from tests.support.sessions import Clock

PIXELS = 1 << 16
FRAME = 0.1  # seconds


class Slow:
    """A renderer whose sample of a pixel takes a time, of a size; it counts what it was given."""

    is_baked = False

    def __init__(self, clock: Clock, pixel_seconds: float, size: tuple[int, int]) -> None:
        self.clock, self.size = clock, size
        self.seconds = pixel_seconds * size[0] * size[1]  # of a sample
        self.work = 0.0
        self.given: list[float] = []

    @property
    def samples(self) -> int:
        return int(self.work + 1e-9)

    def advance(self, seconds: float, target: int) -> None:
        self.given.append(seconds)
        done = min(seconds / self.seconds, target - self.work)
        self.clock.now += done * self.seconds
        self.work += done


@pytest.fixture
def clock() -> Clock:
    clock = Clock()
    clock.step = 0.0
    return clock


def learnt(clock: Clock, whole: float) -> Preview:
    """Learn that a sample of the whole frame takes `whole` seconds."""
    preview = Preview(clock)
    preview.record(whole, PIXELS)
    return preview


@pytest.mark.parametrize("whole", [0.05, 0.1, 0.11, 0.3, 0.9, 1.7, 6.3])
def test_a_sample_fits_and_leaves_little_of_the_frame(clock: Clock, whole: float) -> None:
    preview = learnt(clock, whole)
    preview.begin(PIXELS, FRAME)
    used = whole / preview.factor**2
    assert used <= FRAME
    assert used > FRAME / 2**0.5 or preview.factor == 1


def test_no_picture_is_coarser_than_the_coarsest(clock: Clock) -> None:
    preview = learnt(clock, 1000.0)
    preview.begin(PIXELS, FRAME)
    assert preview.factor == COARSEST


def test_edits_that_take_long_leave_less_for_the_sample(clock: Clock) -> None:
    preview = learnt(clock, 0.3)
    for _ in range(40):
        preview.edited(0.05)
    preview.begin(PIXELS, FRAME)
    assert 0.3 / preview.factor**2 <= FRAME - 0.05 + 1e-6


def test_the_first_edit_is_expected_to_take_long(clock: Clock) -> None:
    """Only until one was measured."""
    one, other = learnt(clock, 0.08), learnt(clock, 0.08)
    one.expect(0.05)
    for preview in (one, other):
        preview.begin(PIXELS, FRAME)
    assert 0.08 / one.factor**2 <= FRAME - 0.05 < 0.08 / other.factor**2
    other.edited(0.01)
    other.expect(0.05)
    other.end()
    other.begin(PIXELS, FRAME)
    assert other.factor == 1


def test_samples_have_a_share_of_the_frame_however_long_edits_take(clock: Clock) -> None:
    preview, renderer = learnt(clock, 0.3), Slow(clock, 1e-5, (50, 50))
    for _ in range(40):
        preview.edited(3.0)
    preview.begin(PIXELS, FRAME)
    assert 0.3 / preview.factor**2 > LEAST * FRAME / 2**0.5
    clock.now += 2 * STILL
    preview.deliver()
    preview.work(renderer, 100, FRAME, 3.0)  # type: ignore[arg-type]
    assert renderer.given == [LEAST * FRAME]


def test_sizes_do_not_alternate_when_times_vary(clock: Clock) -> None:
    """Times vary by a tenth to both sides: more than between frames on a quiet machine."""
    preview, seen = learnt(clock, 0.3), list[float]()
    for n in range(60):
        preview.begin(PIXELS, FRAME)
        seen.append(preview.factor)
        preview.record((0.33 if n % 2 else 0.27), PIXELS)
    assert sum(a != b for a, b in pairwise(seen)) <= 1


def test_the_picture_becomes_finer_once_that_fits_well(clock: Clock) -> None:
    preview = learnt(clock, 0.3)
    preview.begin(PIXELS, FRAME)
    before = preview.factor
    for _ in range(40):
        preview.record(0.3 * 0.45, PIXELS)
        preview.begin(PIXELS, FRAME)
    assert preview.factor < before
    assert 0.3 * 0.45 / preview.factor**2 <= FRAME
    finer = [factor for factor in FACTORS if factor < preview.factor][-1]
    assert 0.3 * 0.45 / finer**2 > FINER * FRAME


def work_once(clock: Clock, sample: float, **given: Any) -> Slow:
    """A frame of a preview whose sample takes `sample` frames."""
    preview = learnt(clock, 0.5)
    preview.begin(PIXELS, FRAME)
    renderer = Slow(clock, sample * FRAME / 100, (10, 10))
    preview.work(renderer, given.get("target", 9), FRAME, given.get("edit", 0.0))  # type: ignore[arg-type]
    return renderer


def test_the_first_sample_may_overrun_the_frame_so_that_it_shows_something(clock: Clock) -> None:
    assert work_once(clock, 0.95 * OVERRUN).samples == 1


def test_it_is_cut_where_it_takes_far_longer(clock: Clock) -> None:
    start = clock.now
    assert work_once(clock, 3.0).samples == 0
    assert clock.now - start == pytest.approx(OVERRUN * FRAME)


def test_what_an_edit_takes_is_a_part_of_that(clock: Clock) -> None:
    """A frame that is all gone for an edit has as long again for its sample."""
    assert work_once(clock, 0.95, edit=FRAME).samples == 1
    assert work_once(clock, 1.05, edit=FRAME).samples == 0


def test_further_samples_end_with_the_frame(clock: Clock) -> None:
    start = clock.now
    assert work_once(clock, 0.3).samples == 3
    assert clock.now - start == pytest.approx(FRAME)
    assert work_once(Clock(), 0.3, target=1).samples == 1
