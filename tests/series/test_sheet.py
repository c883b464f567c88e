"""Contact sheets: their labels keep the values that the frames show."""

import pytest

from glrt.series.sheet import fitting


@pytest.mark.parametrize(
    ("letters", "text", "short"),
    [
        (30, "attenuation_distance 0.125", "attenuation_distance 0.125"),
        (14, "attenuation_distance 0.125", "attenua… 0.125"),
        (6, "attenuation_distance 0.125", "0.125"),
        (12, "color 0.2 0.4 0.6", "0.2 0.4 0.6"),
        (9, "color 0.2 0.4 0.6", "0.2 0.4 …"),
        (9, "120 degrees", "120 degr…"),
        (3, "120 degrees", "120"),
        (0, "120 degrees", ""),
    ],
)
def test_a_label_that_is_too_long_loses_its_key_first(letters: int, text: str, short: str) -> None:
    assert fitting(text, lambda label: len(label) <= letters) == short
