"""The bugs to plant fit the source as it is, and the tests that must find them exist."""

import re
from collections import Counter
from pathlib import Path

import pytest

from tests.mutation.__main__ import ROOT, Outcome, drawn
from tests.mutation.mutant import Mutant, mutants, place_of, plant
from tests.mutation.places import places
from tests.support.particle_rooms import ROOMS

MUTANTS = mutants()
CLEAN = Outcome(is_fast=True, passed=2, failures=(), errors=0, seconds=1.0)
GLSL = """const int MOST = 3;
struct Ray { vec3 origin; };
float half_of(float x) {
    if (x < 0.0) { return 0.0; }
    return 0.5
        * x;
}
float other(float x) { return 0.5 * x; }
"""
PYTHON = """LIMIT = 3


class Film:
    @property
    def size(self):
        return 2 * LIMIT


def size():
    return 2 * LIMIT
"""


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name, text in (("shaders_glsl/a.glsl", GLSL), ("glrt/film.py", PYTHON)):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(text)
    return tmp_path


def test_bugs_fit_the_source_and_name_a_test() -> None:
    known = places(ROOT)
    for mutant in MUTANTS:
        assert place_of(mutant, known)
        assert mutant.new.split() != mutant.old.split()
        file, test = mutant.test.split("::")
        name, *case = test.split("[")
        assert re.search(rf"^def {name}\(", (ROOT / "tests" / file).read_text(), re.MULTILINE)
        assert not case or case[0].rstrip("]") in ROOMS


def test_bugs_have_names_of_their_own() -> None:
    assert [bug for bug, count in Counter(it.bug for it in MUTANTS).items() if count > 1] == []


def test_what_has_a_name_is_found_where_it_stands(tree: Path) -> None:
    found = {name: [span.file.name for span in spans] for name, spans in places(tree).items()}
    in_glsl, in_python = ("MOST", "Ray", "half_of", "other"), ("LIMIT", "Film", "Film.size", "size")
    expected = {name: ["a.glsl"] for name in in_glsl} | {name: ["film.py"] for name in in_python}
    assert found == expected


def test_a_bug_is_planted_in_its_function_whatever_the_spaces(tree: Path) -> None:
    bug = Mutant("no half", "half_of", "0.5 * x", "x", "a.py::test_it")
    file, before = plant(bug, places(tree))
    assert before == GLSL
    assert file.read_text() == GLSL.replace("0.5\n        * x", "x")
    bug = Mutant("once", "Film.size", "2 * LIMIT", "LIMIT", "a.py::test_it")
    file, _ = plant(bug, places(tree))
    assert file.read_text() == PYTHON.replace("2 * LIMIT", "LIMIT", 1)


@pytest.mark.parametrize(
    ("function", "old", "times"),
    [("half_of", "2.0", 0), ("nothing", "x", 0), ("half_of", "0.0", 2)],
)
def test_text_that_is_not_there_once_is_not_replaced(
    tree: Path, function: str, old: str, times: int
) -> None:
    bug = Mutant("bug", function, old, "new", "a.py::test_it")
    with pytest.raises(ValueError, match=f"{function} has {times} times: '{old}'"):
        place_of(bug, places(tree))


@pytest.mark.parametrize(
    ("outcome", "finds_it"),
    [
        (CLEAN, False),
        (CLEAN._replace(failures=("assert 1 == 2",)), True),
        (CLEAN._replace(failures=("AssertionError: worst z 9",)), True),
        (CLEAN._replace(failures=("glrt.core.errors.RenderError: the driver refuses",)), False),
        (CLEAN._replace(failures=("Failed: Timeout",)), False),
        (CLEAN._replace(failures=("assert 1 == 2",), errors=1), False),
    ],
)
def test_only_a_failed_assertion_finds_a_bug(outcome: Outcome, finds_it: bool) -> None:
    assert outcome.finds_it == finds_it


def test_each_commit_draws_other_bugs() -> None:
    draws = [drawn(MUTANTS, 2, commit) for commit in "abcdefgh"]
    assert all(len(draw) == 2 for draw in draws)
    assert len({mutant.bug for draw in draws for mutant in draw}) > 5
    assert drawn(MUTANTS, 2, "a") == draws[0]
