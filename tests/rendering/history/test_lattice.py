"""Which pixels a coarse picture samples: each once in a cycle, and early everywhere."""

import numpy as np
import pytest

from glrt.rendering.history.lattice import FACTORS, Cycle, corner_of, lattice_of


@pytest.mark.parametrize("factor", FACTORS)
def test_lattices_sample_each_pixel_once_and_halve_their_distance_early(factor: int) -> None:
    """Each fourfold number of frames is a lattice of half the distance, from any start."""
    size = 24, 16
    cycle = Cycle(0, factor, 7)
    places: list[int] = []
    for frame in range(1, factor**2 + 1):
        places += lattice_of(size, factor, cycle.corner).tolist()
        cycle = cycle._replace(frames=frame)
        if frame in (1, 4, 16, 64):
            step = cycle.step
            assert step == factor // round(frame**0.5)
            y, x = np.divmod(np.array(places), size[0])
            assert len({*zip(x % step, y % step, strict=True)}) == 1
            assert len(places) == size[0] * size[1] // step**2
    assert sorted(places) == [*range(size[0] * size[1])]


def test_no_sample_is_taken_twice_in_a_view() -> None:
    cycle, seen = Cycle(0, 0, 3), set()
    for factor in (8, 8, 4, 4, 2, *[2] * 8, 4):
        cycle = cycle.followed_by(factor)
        for pixel in lattice_of((16, 16), factor, cycle.corner).tolist():
            assert (pixel, cycle.number) not in seen
            seen.add((pixel, cycle.number))
        cycle = cycle._replace(frames=cycle.frames + 1)


def test_the_order_begins_with_a_diagonal() -> None:
    assert [corner_of(n, 8) for n in range(5)] == [(0, 0), (4, 4), (4, 0), (0, 4), (2, 2)]
