"""No number lies under the grip of its slider."""

import pytest

from glrt.view.widgets.slider_text import Slider, share_of, text_next_to_grip

GRIP, SPACE, FORM = 12.0, 4.0, "%.3g"


def place_of(form: str, width: float, text: float) -> tuple[float, float]:
    """Where a number begins and ends, since it is centred with its spaces."""
    before, after = form.split(FORM)
    left = (width - text - SPACE * len(before + after)) / 2 + SPACE * len(before)
    return left, left + text


@pytest.mark.parametrize("width", [100.0, 130.0, 250.0])
@pytest.mark.parametrize("text", [8.0, 28.0, 40.0])
def test_a_number_stands_next_to_the_grip_and_in_its_slider(width: float, text: float) -> None:
    for percent in range(101):
        slider = Slider(width, GRIP, percent / 100)
        left, right = place_of(text_next_to_grip(FORM, slider, text, SPACE), width, text)
        assert right <= slider.middle - GRIP / 2 or left >= slider.middle + GRIP / 2, percent
        assert left >= 0
        assert right <= width


def test_shares_of_a_range() -> None:
    assert share_of(5.0, 0.0, 10.0, is_logarithmic=False) == 0.5
    assert share_of(0.1, 0.001, 10.0, is_logarithmic=True) == pytest.approx(0.5)
    assert share_of(99.0, 0.0, 10.0, is_logarithmic=False) == 1.0
    assert share_of(0.0, 0.001, 10.0, is_logarithmic=True) == 0.0
