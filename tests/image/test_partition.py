"""Where a render is cut: each sample is in one part, and observations stay whole."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from glrt.core.errors import UsageError
from glrt.image.partition import Partition, one_part, parse_part, sample_range
from glrt.samplers import DIVISIONS
from glrt.settings import Settings
from tests.support.renders import SAMPLERS


def ranges(count: int, samples: int, sampler: str) -> list[range]:
    made = Settings.model_validate({"samples": samples, "sampler": sampler})
    partition = Partition(count=count, numbers=tuple(range(1, count + 1)))
    return [sample_range(partition, number, made) for number in partition.numbers]


@settings(max_examples=200, deadline=None, derandomize=True, database=None)
@given(st.data(), st.integers(1, 5000), st.sampled_from(SAMPLERS))
def test_each_sample_is_in_one_part_and_observations_stay_whole(
    data: st.DataObject, samples: int, sampler: str
) -> None:
    block = DIVISIONS[sampler].block
    observations = -(-samples // block)
    count = data.draw(st.integers(1, min(observations, 200)))
    found = ranges(count, samples, sampler)
    assert [number for part in found for number in part] == [*range(samples)]
    assert all(part.start % block == 0 for part in found)
    sizes = {-(-len(part) // block) for part in found}
    assert min(sizes) >= 1
    assert max(sizes) - min(sizes) <= 1


def test_parts_are_what_were_there_before() -> None:
    """A queue may render them today and tomorrow: other cuts would count samples twice."""
    assert ranges(3, 100, "sobol") == [range(32), range(32, 64), range(64, 100)]
    assert ranges(4, 10, "independent") == [range(2), range(2, 5), range(5, 7), range(7, 10)]
    assert ranges(2, 17, "sobol") == [range(16), range(16, 17)]


@pytest.mark.parametrize("number", [0, 4, -1])
def test_a_part_beyond_the_last_is_refused(number: int) -> None:
    with pytest.raises(UsageError, match="parts are numbered from 1 to 3"):
        one_part(number, 3, Settings(samples=64))


def test_more_parts_than_observations_are_refused() -> None:
    assert one_part(2, 2, Settings(samples=17)).samples(Settings(samples=17)) == 1
    with pytest.raises(UsageError, match=r"17 samples make at most 2 parts, each of 16 samples"):
        one_part(1, 3, Settings(samples=17))
    with pytest.raises(UsageError, match=r"1 sample make.* at most 1 part, each of 1 sample "):
        one_part(1, 2, Settings(samples=1, sampler="independent"))


def test_a_partition_reports_what_it_lacks() -> None:
    some = Partition(count=5, numbers=(2, 5))
    assert some.missing == [1, 3, 4]
    assert not some.is_complete
    assert str(some) == "2, 5 of 5"
    assert some.samples(Settings(samples=75)) == 16 + 11
    assert Partition(count=1, numbers=(1,)).is_complete


@pytest.mark.parametrize("numbers", [(), (0,), (4,), (2, 1), (1, 1), (1, 2, 3, 4)])
def test_numbers_that_are_no_parts_are_no_partition(numbers: tuple[int, ...]) -> None:
    """Such numbers come from a recipe that was tampered with."""
    with pytest.raises(ValidationError):
        Partition(count=3, numbers=numbers)


def test_a_part_is_read_as_number_and_count() -> None:
    assert parse_part("3/7") == (3, 7)
    for text in ("3", "3/", "/7", "3/7/9", "-1/7", "3 / 7", "1.5/2", "12345678/12345678", ""):
        with pytest.raises(ValueError, match="is not K/N, such as 3/7"):
            parse_part(text)


def test_no_parts_are_not_counted() -> None:
    with pytest.raises(ValueError, match="'0/0' has no parts: N must be 1 or more"):
        parse_part("0/0")
