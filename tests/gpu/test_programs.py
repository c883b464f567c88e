"""The programs of a context: compiled once, shared, and freed when they are long unused."""

from typing import Any

import pytest

from glrt.core.errors import RenderError
from glrt.gpu.glsl import Source, files_reread
from glrt.gpu.programs import IDLE, Programs


class Compiled:
    """A program that is only counted."""

    def __init__(self) -> None:
        self.is_free, self.rests = False, 0

    def rest(self) -> None:
        self.rests += 1

    def release(self) -> None:
        assert not self.is_free
        self.is_free = True


def shaders(number: int, text: str = "") -> list[Source]:
    return [Source("trace.comp", {"NUMBER": number}, texts={"more.glsl": text})]


def taken(programs: Programs, wanted: list[Source]) -> Any:
    made: Any = Compiled
    return programs.take(wanted, made)


def refuse() -> Any:
    raise RenderError("not this one")


def test_equal_sources_share_a_program_and_others_do_not() -> None:
    programs = Programs()
    first = taken(programs, shaders(1))
    assert programs.take(shaders(1), refuse) is first
    others = [shaders(2), shaders(1, "float x;"), [*shaders(1), *shaders(1)]]
    assert len({id(taken(programs, wanted)) for wanted in others} | {id(first)}) == 4


def test_files_that_are_read_again_make_other_programs() -> None:
    programs = Programs()
    first = taken(programs, shaders(1))
    with files_reread():
        assert taken(programs, shaders(1)) is not first
    second = taken(programs, shaders(1))
    with pytest.raises(RenderError), files_reread():
        programs.take(shaders(1), refuse)
    assert programs.take(shaders(1), refuse) is second


def test_programs_in_use_stay_and_the_least_recently_used_goes_first() -> None:
    programs = Programs()
    used = taken(programs, shaders(0))
    idle = [taken(programs, shaders(number)) for number in range(1, IDLE + 1)]
    for kernel in idle:
        programs.give_back(kernel)
    assert all(kernel.rests == 1 for kernel in idle)
    programs.give_back(programs.take(shaders(1), refuse))
    programs.give_back(taken(programs, shaders(99)))
    assert [kernel.is_free for kernel in (used, *idle)] == [False, False, True] + [False] * 6
    assert programs.take(shaders(0), refuse) is used


def test_a_program_stays_until_its_last_user_is_done() -> None:
    programs = Programs()
    kernel = taken(programs, shaders(0))
    programs.take(shaders(0), refuse)
    programs.give_back(kernel)
    for number in range(1, IDLE + 2):
        programs.give_back(taken(programs, shaders(number)))
    assert not kernel.is_free
    programs.give_back(kernel)
    for number in range(1, IDLE + 2):
        programs.give_back(taken(programs, shaders(number)))
    assert kernel.is_free


def test_a_program_that_is_refused_is_not_kept() -> None:
    programs = Programs()
    with pytest.raises(RenderError):
        programs.take(shaders(1), refuse)
    assert taken(programs, shaders(1))
