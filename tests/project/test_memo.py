"""Results that are kept while what they were made of is the same object."""

from glrt.core.memo import kept_for_the_same


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
    assert length(one, other) == 4
    assert length(one) == 2
    assert len(asked) == 4
