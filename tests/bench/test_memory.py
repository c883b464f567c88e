"""The table of memory says what accounts for a render."""

import pytest

from bench.memory import Row, main, measure, table


@pytest.mark.slow
def test_film_and_picture_account_for_what_a_larger_picture_takes() -> None:
    """The exception is memory for bands of rows and for writing files: 48 MiB, of 240 here."""
    row = measure(1280, "sobol")
    assert row.film == 6 * 16 * 1280**2
    assert row.base > 50 * 2**20, "an interpreter with numpy and a driver"
    assert row.base + row.film < row.peak
    assert abs(row.rest) < 48 * 2**20


def test_memory_is_reported_in_mebibytes() -> None:
    row = Row(64, "independent", 1.25, 400 * 2**20, 100 * 2**20, 250 * 2**20, 40 * 2**20)
    line = list(table([row]))[2]
    assert line == "| 64 x 64 | independent | 1.2 s | 400 | 100 | 250 | 40 | 10 |"


@pytest.mark.slow
def test_a_picture_that_finds_no_room_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--size", "20000"]) == 4
    assert "20000 x 20000 pixels failed" in capsys.readouterr().err
