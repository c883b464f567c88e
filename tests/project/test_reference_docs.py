"""The pages of docs/reference/ that a command writes are what it writes now."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

import reference


@pytest.mark.parametrize("name", reference.MAKERS)
def test_a_generated_page_is_up_to_date(name: str) -> None:
    written = (reference.FOLDER / name).read_text()
    assert written == reference.pages()[name], "run `make reference`"
