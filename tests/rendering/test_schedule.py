"""How much a dispatch takes: decided by pure functions, tried on a device with a made-up speed."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from glrt.gpu.program import Pace
from glrt.rendering.schedule import (
    FIRST_TILES,
    GROWTH,
    HEADLESS,
    INTERACTIVE,
    MOST_TILES,
    MOST_TOGETHER,
    DispatchPolicy,
    DispatchRange,
    Schedule,
    stride_of,
    whole_frame,
)

Device = Callable[[DispatchRange], float]  # seconds for a part


def device(cost: float, latency: float = 1e-4) -> Device:
    """Seconds: `cost` a tile and sample, after a latency."""
    return lambda part: latency + cost * part.tiles * part.samples


def frames(
    schedule: Schedule,
    seconds_for: Device,
    samples: int,
    budget: float = 0.25,
    policy: DispatchPolicy = HEADLESS,
) -> list[list[tuple[DispatchRange, float]]]:
    """The dispatches of each frame and what they took, to so many samples."""
    done = 0
    all_frames: list[list[tuple[DispatchRange, float]]] = [[]]
    while done < samples:
        part = schedule.next_dispatch(samples - done, budget, done, policy)
        seconds = seconds_for(part)
        all_frames[-1].append((part, seconds))
        if schedule.record(part, seconds):
            done += part.samples
            all_frames.append([])
    return all_frames[:-1]


@pytest.mark.parametrize("tiles", [1, 15, 16, 17, 4096, 100_000])
@pytest.mark.parametrize("cost", [1e-8, 1e-3])
def test_a_frame_covers_every_block_once_with_the_same_samples(tiles: int, cost: float) -> None:
    for frame in frames(Schedule(tiles, 50), device(cost), 60):
        portions = [part for part, _ in frame]
        ends = [0, *(p.first + p.tiles for p in portions)]
        assert [p.first for p in portions] == ends[:-1]
        assert ends[-1] == tiles
        assert len({p.samples for p in portions}) == 1
        assert max(p.tiles for p in portions) <= MOST_TILES


@pytest.mark.parametrize("limit", [HEADLESS.limit, INTERACTIVE.limit])
@pytest.mark.parametrize("tiles", [1, 64, 4096, 100_000])
@pytest.mark.parametrize("cost", [1e-7, 1e-5, 2e-3])
def test_no_dispatch_exceeds_its_limit_though_tiles_differ(
    limit: float, tiles: int, cost: float
) -> None:
    """A part of the picture costs up to 1.8 times another, and a sample of a tile up to 2 ms."""
    rng = np.random.default_rng(5)

    def uneven(part: DispatchRange) -> float:
        return device(cost)(part) * rng.uniform(0.6, 1.08)

    for frame in frames(Schedule(tiles, 1000), uneven, 5, limit / 2):
        assert max(seconds for _, seconds in frame) <= limit


def test_a_dispatch_of_a_slow_picture_fills_its_budget() -> None:
    last = frames(Schedule(4096, 1000), device(1e-3), 3, budget=0.25)[-1]
    assert len(last) == math.ceil(4096 * 1e-3 / 0.25)
    assert all(0.2 < seconds <= 0.2502 for _, seconds in last)


def test_a_dispatch_of_a_fast_picture_takes_many_samples() -> None:
    counts = [frame[0][0].samples for frame in frames(Schedule(64, 1000), device(1e-5), 4000)]
    assert max(counts) == int(0.25 / (1e-5 + 1e-4 / (64 * max(counts))) / 64)
    assert all(after <= GROWTH * before for before, after in pairwise(counts))


def lanes(part: DispatchRange) -> float:
    """A sample alone takes 2.5 times as long as one of many: lanes wait for its longest path."""
    return 1e-4 * part.tiles * (part.samples + 1.5)


def test_frames_of_a_slow_picture_get_more_samples_as_it_has_more() -> None:
    all_frames = frames(Schedule(4096, 1000), lanes, 256)
    held = 0
    for frame in all_frames:
        samples = frame[0][0].samples
        assert samples == min(max(1, held // 8), MOST_TOGETHER)
        held += samples
        assert max(seconds for _, seconds in frame) <= 0.2502
    assert held == 256
    assert len(all_frames) < 60


def test_who_looks_at_a_picture_sees_it_change_before_long() -> None:
    for cost in (1e-5, 1e-4, 1e-3):
        for frame in frames(Schedule(4096, 1000), device(cost), 200, 0.05, INTERACTIVE):
            whole = sum(seconds for _, seconds in frame)
            assert whole <= 1.05 * INTERACTIVE.patience or frame[0][0].samples == 1


def test_a_picture_that_begins_again_is_planned_by_what_a_single_sample_takes() -> None:
    schedule, pace = Schedule(4096, 1000), Pace()
    schedule.follow(pace)
    assert frames(schedule, lanes, 256)[-1][0][0].samples == MOST_TOGETHER
    again = Schedule(4096, 1000)
    again.follow(pace)
    first = frames(again, lanes, 1)[0]
    assert max(seconds for _, seconds in first) <= 0.2502
    longer = Schedule(4096, 1000, rounds=1)
    longer.follow(pace)
    assert longer.next_dispatch(1, 0.25).tiles <= FIRST_TILES


def test_the_first_dispatch_is_small_and_the_loop_limit_holds() -> None:
    all_frames = frames(Schedule(4096, 6), device(1e-9), 100)
    assert all_frames[0][0][0].tiles <= FIRST_TILES
    assert max(p.samples for frame in all_frames for p, _ in frame) == 6
    assert sum(frame[0][0].samples for frame in all_frames) == 100


def test_the_next_picture_of_a_kernel_begins_with_what_is_known() -> None:
    """A camera that moves needs this: each frame is another picture."""
    pace = Pace()

    def schedule(tiles: int, rounds: int) -> Schedule:
        found = Schedule(tiles, 64, rounds)
        found.follow(pace)
        return found

    first = schedule(1000, 5)
    assert first.next_dispatch(64, 1.0).tiles <= FIRST_TILES
    while not first.record(part := first.next_dispatch(1, 1.0), 1e-4 * FIRST_TILES):
        pass
    assert schedule(250, 5).next_dispatch(1, 1.0).tiles == min(250, GROWTH * part.tiles)
    assert schedule(250, 6).next_dispatch(1, 1.0).tiles <= FIRST_TILES, "longer samples: who knows"


def test_a_frame_of_more_samples_than_are_left_is_dropped() -> None:
    schedule = Schedule(100_000, 100)
    frames(schedule, device(1e-9), 200)
    begun = schedule.next_dispatch(50, 1.0)
    assert begun == DispatchRange(50, 0, 50_000)
    schedule.record(begun, 0.01)
    assert schedule.begun == 25
    assert schedule.next_dispatch(50, 1.0) == DispatchRange(50, 50_000, 50_000)
    assert schedule.next_dispatch(3, 1.0) == DispatchRange(3, 0, 50_000)
    assert schedule.begun == 0


def test_tiles_in_steps_of_the_stride_are_all_blocks() -> None:
    for tiles in (1, 2, 3, 128, 129, 262_144, 4_194_304):
        stride = stride_of(tiles)
        assert math.gcd(stride, tiles) == 1
        assert (tiles - 1) * stride < 2**32, "the kernel has 32 bits"


def test_tiles_of_a_dispatch_lie_all_over_the_picture() -> None:
    """In 64 rows of 64 tiles, 128 tiles touch at least every fourth row."""
    for first in (0, 1000, 3900):
        rows = {(number * stride_of(4096) % 4096) // 64 for number in range(first, first + 128)}
        assert np.diff(sorted({-1, *rows, 64})).max() <= 4


def test_a_whole_frame_is_as_few_dispatches_as_every_driver_takes() -> None:
    assert whole_frame(3, 4096) == [DispatchRange(3, 0, 4096)]
    assert whole_frame(1, 70_000) == [DispatchRange(1, 0, 65_535), DispatchRange(1, 65_535, 4465)]
