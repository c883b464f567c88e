"""The bugs to plant fit the shaders as they are, and the tests that must find them exist."""

import re

import pytest

from tests.mutation.__main__ import ROOT, Outcome, drawn, planted
from tests.mutation.mutant import Edit, Mutant
from tests.mutation.mutants import MUTANTS
from tests.support.particle_rooms import ROOMS

CLEAN = Outcome(passed=2, failures=(), errors=0, seconds=1.0)


@pytest.mark.parametrize("mutant", MUTANTS, ids=[mutant.bug for mutant in MUTANTS])
def test_bug_fits_the_text_and_names_a_test(mutant: Mutant) -> None:
    for edit in mutant.edits:
        text = (ROOT / edit.file).read_text()
        assert planted(text, [edit]) != text
    file, test = mutant.test.split("::")
    name, *case = test.split("[")
    assert re.search(rf"^def {name}\(", (ROOT / "tests" / file).read_text(), re.MULTILINE)
    assert not case or case[0].rstrip("]") in ROOMS


def test_bugs_have_names_of_their_own() -> None:
    assert len({mutant.bug for mutant in MUTANTS}) == len(MUTANTS)


@pytest.mark.parametrize("text", ["a c", "a b b c"])
def test_text_that_is_not_there_once_is_not_replaced(text: str) -> None:
    with pytest.raises(ValueError, match=r"x.glsl has [02] times: 'b'"):
        planted(text, [Edit("x.glsl", "b", "d")])


@pytest.mark.parametrize(
    ("outcome", "finds_it"),
    [
        (CLEAN, False),
        (CLEAN._replace(failures=("assert 1 == 2",)), True),
        (CLEAN._replace(failures=("AssertionError: worst z 9",)), True),
        (CLEAN._replace(failures=("glrt.errors.RenderError: the driver refuses",)), False),
        (CLEAN._replace(failures=("Failed: Timeout",)), False),
        (CLEAN._replace(failures=("assert 1 == 2",), errors=1), False),
    ],
)
def test_only_a_failed_assertion_finds_a_bug(outcome: Outcome, finds_it: bool) -> None:
    assert outcome.finds_it == finds_it
    assert outcome.is_clean == (outcome == CLEAN)


def test_each_commit_draws_other_bugs() -> None:
    draws = [drawn(MUTANTS, 2, commit) for commit in "abcdefgh"]
    assert all(len(draw) == 2 for draw in draws)
    assert len({mutant.bug for draw in draws for mutant in draw}) > 5
    assert drawn(MUTANTS, 2, "a") == draws[0]
