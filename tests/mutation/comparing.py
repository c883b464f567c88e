"""Bugs of what tells whether pictures differ, and of what says how much would have shown."""

from tests.mutation.merging import bug
from tests.mutation.mutant import Mutant

NOISE = "comparison/noise.py"
RARE = "comparison/rare_light.py"
SENSITIVITY = "comparison/sensitivity.py"
VERDICT = "comparison/verdict.py"

COMPARING: list[Mutant] = [
    bug(
        "rare light that was met anywhere is missed nowhere else",
        NOISE,
        "own + np.maximum(share * rare_power.sum(axis=(0, 1)) - add(rare_power), 0)",
        "own + 0 * share * rare_power.sum(axis=(0, 1))",
        "comparison/test_noise.py::"
        "test_rare_light_that_was_met_anywhere_may_have_been_missed_anywhere",
    ),
    bug(
        "rare light counts twice for the whole picture",
        NOISE,
        "rare_power.sum(axis=(0, 1)) - add(rare_power), 0)",
        "rare_power.sum(axis=(0, 1)), 0)",
        "comparison/test_noise.py::test_rare_light_counts_once_for_the_whole_picture",
    ),
    bug(
        "the rim of a lamp is rare light",
        RARE,
        "variance > FAR * np.maximum(usual, other)",
        "variance > FAR * usual",
        "comparison/test_rare_light.py::test_what_the_other_picture_has_too_is_not_rare",
    ),
    bug(
        "the edge of a noisy place is rare light",
        RARE,
        "spread_out(_largest_around(_medians(variance)), variance.shape)",
        "spread_out(_medians(variance), variance.shape)",
        "comparison/test_rare_light.py::test_a_noisy_place_is_not_rare",
    ),
    bug(
        "errors of rare light are believed between methods",
        VERDICT,
        "return worse if worse.share > HEAVY else None",
        "return worse if worse.share > 1 else None",
        "comparison/test_rare_light.py::"
        "test_heavy_tails_leave_two_methods_undecided_and_one_method_decided",
    ),
    bug(
        "a sky without noise shows the smallest change of all light",
        SENSITIVITY,
        "found = noise > CALM * usual",
        "found = noise > -1",
        "comparison/test_sensitivity.py::"
        "test_light_that_the_camera_sees_itself_says_nothing_of_the_rest",
    ),
    bug(
        "a change in every second block is called found in most",
        SENSITIVITY,
        'np.quantile(best, POWER, method="higher")',
        "np.quantile(best, 0.05)",
        "comparison/test_sensitivity.py::test_a_change_of_a_block_is_found_at_its_size",
    ),
    bug(
        "the size of a change leaves its noise out",
        NOISE,
        "self.reach(score) + NormalDist().inv_cdf(power) * noise + self.rounding",
        "0.7 * self.reach(score) + self.rounding",
        "comparison/test_sensitivity.py::test_a_change_of_all_light_is_found_at_its_size",
    ),
    bug(
        "a light group whose change would not show is the same",
        SENSITIVITY,
        "max(self.light, *self.groups.values()) if self.groups else self.light",
        "self.light",
        "comparison/test_sensitivity.py::"
        "test_a_group_whose_change_would_not_show_keeps_the_verdict_open",
    ),
]
