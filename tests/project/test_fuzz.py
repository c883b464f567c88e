"""Inputs made by chance: read and rendered, or refused with one paragraph; never a traceback.

Each commit draws others, and the same commit always the same ones. `python -m tests.fuzz` makes
20,000.
"""

import hashlib
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import strategies as st

from glrt.gpu.context import Context
from tests.fuzz.hunt import hunt, kinds
from tests.support.slow_share import commit_of

COMMIT = commit_of(Path(__file__).parent)
START = int.from_bytes(hashlib.sha256(COMMIT.encode()).digest()[:4], "big")
COUNTS = {
    "scenes by the grammar": 160,  # about one in eight is sound
    "exported scenes": 80,
    "scenes with wrong values": 80,
    "files with wrong bytes": 80,
    "broken EXR": 80,
    "broken recipes": 80,
    "broken PNG": 40,
    "words of models": 80,
    "values of glTF": 80,
    "bytes of models": 60,
    "broken images": 80,
    "broken grids": 40,
}


@pytest.mark.slow_cases("scenes by the grammar", "exported scenes", "scenes with wrong values")
@pytest.mark.parametrize("kind", COUNTS)
def test_no_input_makes_a_traceback(kind: str, tmp_path: Path, context: Context) -> None:
    inputs, check = kinds(tmp_path, context)[kind]
    ends = hunt(inputs, check, COUNTS[kind], START)
    assert ends.total() >= COUNTS[kind] // 2
    sound = {"scenes by the grammar": "rendered", "exported scenes": "exported"}
    assert sound.get(kind, "refused") in ends


@pytest.mark.slow
@pytest.mark.parametrize("kind", COUNTS)
def test_no_input_of_many_makes_a_traceback(kind: str, tmp_path: Path, context: Context) -> None:
    inputs, check = kinds(tmp_path, context)[kind]
    hunt(inputs, check, 10 * COUNTS[kind], START)


def test_the_hunt_finds_what_breaks_and_shows_it_small() -> None:
    def check(value: int) -> str:
        assert value < 100
        return "small"

    with pytest.raises(AssertionError) as caught:
        hunt(st.integers(0, 10_000), check, 500, 1)
    assert "100" in "".join(caught.value.__notes__)


def test_the_same_start_makes_the_same_inputs() -> None:
    drawn: list[list[int]] = [[], []]
    for numbers in drawn:
        hunt(st.integers(), lambda n, kept=numbers: kept.append(n) or "", 20, 7)  # type: ignore[misc]
    assert drawn[0] == drawn[1]
    assert len(Counter(drawn[0])) > 5
