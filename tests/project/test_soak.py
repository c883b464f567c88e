"""A process that changes its scenes without end does not grow: the program, and a share of it."""

import pytest

from tests.project.soak import Look, around, held, soak, told

GROWTH = 4.0  # megabytes in 24 stints; opening a context takes 0.04, a lost film some 0.5


@pytest.mark.slow
def test_stints_run_to_their_end() -> None:
    before = held()  # with what the tests before it left in this process
    looks = soak(600, seed=4, period=2)
    assert [look.stints for look in looks] == [1, 2]
    assert all(10 < look.megabytes < before + 1000 for look in looks)


def test_figures_are_of_start_middle_and_end() -> None:
    looks = [Look(60.0 * n, n + 1, 100.0 if n < 50 else 130.0) for n in range(100)]
    assert [around(looks, share) for share in (0, 0.5, 1)] == [100, 115, 130]
    assert told(looks) == (
        "200 changes of scene in 99 minutes: 100 MB at the start, 115 MB in the middle, "
        "130 MB at the end"
    )


@pytest.mark.slow
def test_the_same_changes_again_take_no_more_memory() -> None:
    looks = soak(250, seed=5, period=8, rounds=5)
    ends = [look.megabytes for look in looks[7::8]]
    assert len(ends) == 5
    assert ends[4] - ends[1] < GROWTH, ends
