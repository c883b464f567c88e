"""Bugs of parts and of what puts them together."""

from tests.mutation.mutant import Edit, Mutant


def bug(name: str, file: str, old: str, new: str, test: str) -> Mutant:
    """One edit of a module of glrt."""
    return Mutant(name, (Edit(f"glrt/{file}", old, new),), test)


MOMENTS = "image/moments.py"
MERGE = "image/merge.py"
FILMS = "image/film_moments.py"
PARTS = "image/partition.py"

MERGING = [
    bug(
        "two means are merged evenly, however many samples each has",
        MOMENTS,
        "(b.mean - a.mean) * _share(b.samples, samples)",
        "(b.mean - a.mean) * 0.5",
        "image/test_moments.py::test_parts_together_have_the_moments_of_all_samples",
    ),
    bug(
        "the distance of two means adds no variance",
        MOMENTS,
        "+ b.variance * b.observations + between",
        "+ b.variance * b.observations",
        "image/test_moments.py::test_two_means_and_their_distance_make_the_variance",
    ),
    bug(
        "samples of an observation that has begun count in the variance",
        MOMENTS,
        "apart = b.whole_mean - a.whole_mean",
        "apart = b.mean - a.mean",
        "image/test_moments.py::test_a_begun_observation_moves_the_mean_and_not_the_variance",
    ),
    bug(
        "the distance of two means is weighed by samples",
        MOMENTS,
        "_share(a.observations * b.observations, observations)",
        "_share(a.samples * b.samples, samples)",
        "image/test_moments.py::test_parts_together_have_the_moments_of_all_samples",
    ),
    bug(
        "the observation that has begun is lost",
        MOMENTS,
        "b.begun, b.part)",
        "a.begun, a.part)",
        "image/test_merge.py::test_parts_together_hold_what_one_film_holds",
    ),
    bug(
        "parts are merged in the order in which they are given",
        MERGE,
        "order = sorted(parts, key=lambda name: _number(parts[name]))",
        "order = list(parts)",
        "image/test_merge.py::test_bits_do_not_depend_on_the_order",
    ),
    bug(
        "variances of AOVs are those of n observations",
        FILMS,
        "** 2 * (observations - 1)",
        "** 2 * observations",
        "image/test_merge.py::test_parts_together_hold_what_one_film_holds",
    ),
    bug(
        "depths of pixels that met nothing are merged as 0",
        MERGE,
        "np.where(film.samples > 0, mean, np.float32(np.inf))",
        "mean",
        "image/test_merge.py::test_dropped_samples_and_empty_pixels_stay_what_they_are",
    ),
    bug(
        "dropped samples count as samples",
        FILMS,
        "_counts(image.samples - state.dropped)",
        "_counts(image.samples + 0 * state.dropped)",
        "image/test_merge.py::test_dropped_samples_and_empty_pixels_stay_what_they_are",
    ),
    bug(
        "the sampler's seed may differ between parts",
        MERGE,
        '("exposure", "tonemap")]',
        '("exposure", "tonemap", "seed")]',
        "image/test_merge_refusals.py::test_what_cannot_be_merged_is_refused_by_its_reason",
    ),
    bug(
        "an interrupted part is merged as if it were whole",
        MERGE,
        "if recipe.samples != wanted:",
        "if recipe.samples > wanted:",
        "image/test_merge_refusals.py::test_what_cannot_be_merged_is_refused_by_its_reason",
    ),
    bug(
        "missing parts are not missed",
        MERGE,
        "if missing and not missing.is_complete and not incomplete:",
        "if missing and not missing.is_complete and incomplete is None:",
        "image/test_merge_refusals.py::test_what_cannot_be_merged_is_refused_by_its_reason",
    ),
    bug(
        "a part has an observation of the one before it",
        PARTS,
        "return range(block * first, min(block * end, samples))",
        "return range(block * max(first - 1, 0), min(block * end, samples))",
        "image/test_partition.py::test_each_sample_is_in_one_part_and_observations_stay_whole",
    ),
    bug(
        "parts are cut between samples",
        PARTS,
        "observations = -(-samples // block)\n    first,",
        "observations, block = samples, 1\n    first,",
        "image/test_partition.py::test_each_sample_is_in_one_part_and_observations_stay_whole",
    ),
    bug(
        "a part begins with the first sample of the render",
        "rendering/tracer.py",
        "self.film.restart(self._plan.first_sample)",
        "self.film.restart(0)",
        "rendering/test_parts.py::test_a_part_begins_where_the_one_before_it_ended",
    ),
    bug(
        "AOVs of a part begin with the first sample of the render",
        "rendering/aov_tracer.py",
        "stage.film.restart(plan.first_sample)",
        "stage.film.restart(0)",
        "rendering/test_parts.py::test_merged_parts_are_one_render_up_to_rounding",
    ),
    bug(
        "parts under other skies are merged",
        "image/differences.py",
        "for path in before.keys() & after.keys():",
        "for path in before.keys() - after.keys():",
        "cli/test_scene_files.py::test_parts_under_other_skies_are_not_merged",
    ),
    bug(
        "a picture renders again with whatever file is there",
        "image/sources.py",
        "AssetFolder(base or Path(), rules.allow_outside, expected, rules.accept_changed)",
        "AssetFolder(base or Path(), rules.allow_outside, None, rules.accept_changed)",
        "cli/test_scene_files.py::test_a_file_that_has_changed_is_refused_unless_accepted",
    ),
]
