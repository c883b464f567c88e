"""Words find entries of the palette, the best first."""

import pytest

from glrt.view.palette.entries import value_text
from glrt.view.palette.matching import Entry, matches

ENTRIES = (
    Entry("save the scene", "command", "Ctrl+S"),
    Entry("save the scene as", "command", "Ctrl+Shift+S"),
    Entry("samples", "Samples", "256", "samples of each pixel"),
    Entry("samples per frame", "Samples", "0"),
    Entry("resample", "Paths"),
    Entry("bounces", "Paths", "10", "segments of a path, after which it ends"),
)


def found(words: str) -> list[str]:
    return [entry.name for entry in matches(words, ENTRIES)]


def test_without_words_all_are_found_in_their_order() -> None:
    assert found(" ") == [entry.name for entry in ENTRIES]


@pytest.mark.parametrize(
    ("words", "first"),
    [
        ("as scene", "save the scene as"),
        ("SAMP", "samples"),
        ("fra sam", "samples per frame"),
        ("paths", "bounces"),
        ("smpl", "samples"),
        ("segment", "bounces"),
        ("ctrl+shift", "save the scene as"),
    ],
)
def test_all_words_must_fit_in_any_order(words: str, first: str) -> None:
    assert found(words)[0] == first


def test_a_word_fits_best_at_the_beginning_of_a_word() -> None:
    assert found("sample") == ["samples", "samples per frame", "resample"]


def test_a_word_that_fits_nothing_finds_nothing() -> None:
    assert found("samples zebra") == []


def test_letters_are_found_in_their_order() -> None:
    assert found("bncs") == ["bounces"]
    assert found("scnb") == []


def test_values_are_shown_as_in_the_panel() -> None:
    assert [value_text(it) for it in (True, False, 3, 0.02, "mis", (1.0, 0.5, 0.25))] == [
        *("on", "off", "3", "0.02", "mis", "1, 0.5, 0.25")
    ]
