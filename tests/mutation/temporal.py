"""Bugs of history: where it comes from, what it is refused for, and what it counts for."""

from tests.mutation.mutant import Edit, Mutant, edit

REPROJECTION, HOST = "passes/reprojection.glsl", "glrt/rendering/temporal.py"
WHERE, WHEN = "rendering/test_reprojection.py", "rendering/test_temporal.py"

TEMPORAL = [
    Mutant(
        "history is taken half a pixel off",
        edit(REPROJECTION, "vec2 from_middle = place - 0.5;", "vec2 from_middle = place;"),
        f"{WHERE}::test_between_pixels_it_is_exact_for_a_parabola",
    ),
    Mutant(
        "a view that has moved is taken for the same",
        edit(REPROJECTION, "surface.xyz + eye_shift : surface.xyz", "surface.xyz : surface.xyz"),
        f"{WHERE}::test_a_pan_by_whole_pixels_keeps_every_bit",
    ),
    Mutant(
        "the sky moves with the eye",
        edit(REPROJECTION, "surface.w > 0.0 ?", "surface.w > -1.0 ?"),
        f"{WHERE}::test_a_sky_follows_the_directions",
    ),
    Mutant(
        "an object takes the history of another one in its place",
        edit(REPROJECTION, "if (there.w != object || object < 0.0) return false;", ""),
        f"{WHERE}::test_another_object_in_its_place_gives_nothing",
    ),
    Mutant(
        "surfaces may turn",
        edit(REPROJECTION, "facing.xyz) >= SAME_NORMAL", "facing.xyz) >= 0.0"),
        f"{WHERE}::test_a_surface_that_has_turned_gives_nothing",
    ),
    Mutant(
        "surfaces may come nearer",
        edit(REPROJECTION, "off <= SAME_PLACE * length(seen)", "off <= length(seen)"),
        f"{WHERE}::test_a_surface_that_has_come_nearer_gives_nothing",
    ),
    Mutant(
        "between pixels history is linear: it blurs",
        edit(REPROJECTION, "if (count == 4 && are_around", "if (count == 5 && are_around"),
        f"{WHERE}::test_half_a_pixel_many_times_keeps_detail",
    ),
    Mutant(
        "history between pixels stands for the mean of their samples",
        edit(REPROJECTION, "rarity += weight / there.a;", "rarity += weight / 10.0;"),
        f"{WHERE}::test_samples_between_pixels_are_those_of_their_harmonic_mean",
    ),
    Mutant(
        "a mirror has as much history as a wall",
        edit(
            "reproject.frag",
            "has_flag(facing, SPECULAR | BLURRED) ? most_specular : most",
            "most",
        ),
        f"{WHERE}::test_it_counts_for_less_where_its_motion_is_wrong",
    ),
    Mutant(
        "pixels at the edge of a lamp have history",
        (
            Edit("shaders_glsl/reproject.frag", " || has_flag(facing, LAMP_EDGE)", ""),
            Edit(f"shaders_glsl/{REPROJECTION}", "has_flag(other, LAMP_EDGE) || ", ""),
        ),
        f"{WHERE}::test_it_counts_for_less_where_its_motion_is_wrong",
    ),
    Mutant(
        "history stays beside a film of many samples",
        edit("fade.frag", "max(1.0 - samples / end, 0.0)", "1.0"),
        f"{WHEN}::test_history_and_film_are_weighed_by_their_samples",
    ),
    Mutant(
        "a still camera ends with history",
        (
            Edit(
                HOST,
                "return self._is_brought and renderer.samples < self.end",
                "return self._is_brought",
            ),
            Edit("shaders_glsl/fade.frag", "max(1.0 - samples / end, 0.0)", "1.0"),
        ),
        f"{WHEN}::test_a_film_holds_no_history_and_a_still_camera_ends_with_it",
    ),
    Mutant(
        "wrong history is believed",
        edit("fade.frag", "1.0 + history.a * texelFetch(evidence, tile, 0).r", "1.0"),
        f"{WHEN}::test_history_that_is_seen_to_be_wrong_is_not_believed",
    ),
    Mutant(
        "chance is taken for evidence",
        edit("evidence.frag", " - MARGIN * variance / count", ""),
        f"{WHEN}::test_the_evidence_is_the_bias_beyond_chance",
    ),
    Mutant(
        "another light keeps all history",
        (Edit(HOST, "None if is_same_light else OTHER_LIGHT", "None"),),
        f"{WHEN}::test_under_another_light_history_counts_for_little",
    ),
    Mutant(
        "objects that were added keep the history of others",
        (
            Edit(
                "glrt/rendering/reprojection.py",
                "return [shape.shape for shape in one.visible] == "
                "[shape.shape for shape in other.visible]",
                "return one is not None and other is not None",
            ),
        ),
        f"{WHEN}::test_a_view_of_other_objects_begins_anew",
    ),
    Mutant(
        "all views of a move have the same noise",
        (Edit("glrt/view/state/moving_picture.py", "self._begun * GOLDEN", "0 * GOLDEN"),),
        "view/test_moving_picture.py::"
        "test_views_of_a_move_have_noise_of_their_own_and_a_still_one_that_of_reset",
    ),
    Mutant(
        "an error is told of a picture with history",
        (
            Edit(
                "glrt/view/state/error_history.py",
                "session.is_passing or has_history or",
                "session.is_passing or",
            ),
        ),
        "view/test_moving_picture.py::test_no_error_is_told_while_history_is_shown",
    ),
    Mutant(
        "the first edit waits until shaders of history are compiled",
        (Edit("glrt/rendering/temporal.py", "renderer.samples or self._is_prepared", "True"),),
        "view/test_moving_picture.py::test_the_first_edit_waits_for_no_shader",
    ),
]
