"""Bugs of resampling: what a reservoir keeps, what it stands for, and what samples reuse."""

from tests.mutation.mutant import Edit, Mutant, edit

TRUTHS, RESERVOIRS = "truths/test_resampled.py", "shaders/test_reservoirs.py"
MEANS = f"{TRUTHS}::test_direct_light_and_one_bounce_are_those_of_paths"
SHADER, STREAM = "probes/resampling.glsl", "probes/reservoir.glsl"

RESAMPLING = [
    Mutant(
        "a reservoir keeps the candidate that is offered last",
        edit(STREAM, "if (u * stream.sum < weight) {", "if (weight > 0.0) {"),
        f"{RESERVOIRS}::test_candidates_are_kept_as_often_as_they_weigh",
    ),
    Mutant(
        "a candidate's chance lacks its own weight in the sum",
        edit(STREAM, "u * stream.sum < weight", "u * (stream.sum + weight) < weight"),
        f"{RESERVOIRS}::test_an_integral_keeps_its_mean_however_many_are_offered",
    ),
    Mutant(
        "points that face away bring light",
        edit(STREAM, "if (cos_here <= 0.0 || cos_there <= 0.0) return 0.0;", ""),
        f"{RESERVOIRS}::test_what_a_point_brings_falls_with_both_cosines_and_the_squared_distance",
    ),
    Mutant(
        "numbers of shapes lose their upper half in a texture",
        edit(STREAM, "float(shape >> 16)", "0.0"),
        f"{RESERVOIRS}::test_numbers_of_shapes_survive_a_texture_of_floats",
    ),
    Mutant(
        "lamps that a scattered ray meets count whole beside points on lamps",
        edit(SHADER, "share * luminance(emission) * PI", "luminance(emission) * PI"),
        f"{TRUTHS}::test_points_on_all_kinds_of_lamps_are_weighed_beside_scattering",
    ),
    Mutant(
        "points on lamps are candidates where something hides them",
        edit(SHADER, "if (occluded(light.ray, light.distance, light.shape)) return;", ""),
        f"{TRUTHS}::test_points_on_all_kinds_of_lamps_are_weighed_beside_scattering",
    ),
    Mutant(
        "a point of another pixel lights what does not see it",
        edit(SHADER, "if (is_hidden(own.at, stream.kept)) return result;", ""),
        f"{TRUTHS}::test_points_that_neighbours_do_not_see_keep_the_mean",
    ),
    Mutant(
        "the unbiased form sends no rays",
        edit(SHADER, "if (is_hidden(found.at, own.kept)) there = 0.0;", ""),
        f"{TRUTHS}::test_points_that_neighbours_do_not_see_keep_the_mean",
    ),
    Mutant(
        "a surface hides its own points by rounding",
        edit(SHADER, "return !is_there || hit.distance", "return true || hit.distance"),
        f"{TRUTHS}::test_what_a_surface_has_found_is_not_hidden_from_it",
    ),
    Mutant(
        "the own point keeps all of its weight beside others",
        edit(SHADER, "left * here * own.weight", "here * own.weight"),
        MEANS,
    ),
    Mutant(
        "pixels around count as often as they are asked, not by their candidates",
        edit(SHADER, "precise float part = found.count / count;", "precise float part = 1.0;"),
        MEANS,
    ),
    Mutant(
        "a block of samples begins with what another has kept",
        edit(SHADER, "if (REUSES && index % BLOCK > 0)", "if (REUSES && index > 0)"),
        f"{TRUTHS}::test_a_part_is_its_own_share_of_the_whole",
    ),
    Mutant(
        "light from beyond the second surface counts from the camera, too",
        edit(SHADER, "path.radiance = resampling.earlier;", "path.radiance += resampling.earlier;"),
        f"{TRUTHS}::test_three_bounces_in_a_closed_room_are_exact",
    ),
    Mutant(
        "light of holes is resampled",
        (
            Edit(
                "glrt/methods/features.py",
                "resamples = traits.resamples and not found.holed",
                "resamples = traits.resamples",
            ),
        ),
        f"{TRUTHS}::test_scenes_with_holes_have_the_picture_of_a_gather",
    ),
]
