"""Bugs of the judgement on an estimated error, by what the scene tells of lamps in view."""

from tests.mutation.mutant import Edit, Mutant


def mutant(name: str, file: str, old: str, new: str, test: str) -> Mutant:
    """One edit of a module of glrt/error."""
    return Mutant(name, (Edit(f"glrt/error/{file}.py", old, new),), f"error/{test}")


SEEN, RULE = "seen_lamps", "reliability"

JUDGING = [
    mutant(
        "what covers a lamp is not seen",
        SEEN,
        "hits = int((met == number).sum())",
        "hits = int((met >= 0).sum())",
        "test_seen_lamps.py::test_what_stands_before_a_lamp_hides_it",
    ),
    mutant(
        "rays through a lens point where a pinhole's do",
        SEEN,
        "slopes - frame.tan_lens * lens",
        "slopes - 0 * lens",
        "test_seen_lamps.py::test_a_lens_spreads_a_lamp_and_loses_nothing_of_it",
    ),
    mutant(
        "a crop is taken for the upper left part",
        SEEN,
        "low = np.array([column, row]) + corner",
        "low = np.array([column, row]) + 0 * corner",
        "test_seen_lamps.py::test_a_crop_is_a_part_of_the_picture",
    ),
    mutant(
        "a pixel that other light made bright is taken for a lucky one",
        SEEN,
        "hits * (1 - share + np.log(share))",
        "0 * hits * (1 - share + np.log(share))",
        "test_seen_lamps.py::test_a_pixel_that_is_too_bright_to_be_so_by_luck_has_other_light",
    ),
    mutant(
        "pixels that are known still count as lit by luck",
        RULE,
        "errors[seen.rows, seen.columns] = 0",
        "errors[seen.rows[:0], seen.columns[:0]] = 0",
        "test_judgement.py::test_a_lamp_that_was_met_too_often_or_too_rarely_is_known",
    ),
]
