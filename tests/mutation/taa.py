"""Bugs of temporal antialiasing: shares of samples, limits of history."""

from tests.mutation.mutant import Edit, Mutant, edit

GLSL, FRAG, HOST = "temporal/taa.glsl", "taa.frag", "glrt/rendering/taa.py"
TESTS = "temporal/test_taa.py"

TAA = [
    Mutant(
        "an exponential mean forgets at twice the rate",
        edit(GLSL, "1.0 - pow(1.0 - least, count)", "1.0 - pow(1.0 - least, 2.0 * count)"),
        f"{TESTS}::test_an_exponential_mean_has_the_published_number_of_samples",
    ),
    Mutant(
        "the first views count as little as later ones",
        edit(GLSL, "max(count / (known + count), exponential)", "exponential"),
        f"{TESTS}::test_the_first_views_count_the_same",
    ),
    Mutant(
        "history is clamped channel by channel, not brought along a line",
        edit(GLSL, "middle + most * off;", "middle + clamp(off, -reach, reach);"),
        f"{TESTS}::test_history_is_brought_to_the_edge_of_the_box_on_its_way_to_the_middle",
    ),
    Mutant(
        "history is kept near in red, green and blue",
        edit(FRAG, "rgb_of(clipped(ycocg_of(color)", "(clipped((color)"),
        f"{TESTS}::test_the_pass_does_what_the_twin_does",
    ),
    Mutant(
        "the deviation of the neighbourhood is its mean square",
        edit(FRAG, "squares / 9.0 - middle * middle", "squares / 9.0"),
        f"{TESTS}::test_the_pass_does_what_the_twin_does",
    ),
    Mutant(
        "history is taken as it is",
        edit(FRAG, "if (reach < 0.0) return color;", "if (reach != 0.0) return color;"),
        f"{TESTS}::test_history_far_from_what_is_seen_now_is_brought_near",
    ),
    Mutant(
        "antialiasing stays beside a film of many samples, and where it was forgotten",
        (
            Edit(HOST, "self._brought if fresh.samples < fresh.end else None", "self._brought"),
            Edit(
                "glrt/rendering/temporal.py",
                "return self._is_brought and renderer.samples < self.end",
                "return self._is_brought",
            ),
        ),
        "rendering/test_temporal.py::test_a_film_holds_no_history_and_a_still_camera_ends_with_it",
    ),
]
