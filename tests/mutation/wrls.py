"""Bugs of weighted recursive least squares: fits, features, what is brought, what is shown."""

from tests.mutation.mutant import Edit, Mutant, edit

FIT, CORE, ROWS = (f"temporal/{name}.glsl" for name in ("least_squares", "wrls", "wrls_rows"))
PREDICT, SHOWN, BRING = "predict.frag", "predictions.frag", "bring_models.frag"
HOST = "glrt/rendering/wrls.py"
SQUARES, PASSES = "temporal/test_least_squares.py", "temporal/test_wrls.py"
TWIN = f"{SQUARES}::test_the_shader_does_what_the_twin_does"
WHOLE = f"{PASSES}::test_the_passes_do_what_the_twin_does"

WRLS = [
    Mutant(
        "nothing is forgotten",
        edit(FIT, "(sum / next) / FORGETTING", "(sum / next)"),
        TWIN,
    ),
    Mutant(
        "the factor is corrected by the gain after its column",
        edit(FIT, "gain * (along[j] / sum)", "gain * (along[j] / next)"),
        TWIN,
    ),
    Mutant(
        "errors are those of the fit after the sample",
        edit(FIT, "outerProduct(error, gain / sum)", "outerProduct(error, gain)"),
        TWIN,
    ),
    Mutant(
        "the covariance is not bounded",
        edit(FIT, "if (sum > MOST_TRACE)", "if (sum < 0.0)"),
        f"{SQUARES}::test_the_covariance_of_the_shader_is_bounded_and_its_weights_are_not_zero",
    ),
    Mutant(
        "weights of outliers may be zero",
        edit(CORE, "return max(weight, LEAST_WEIGHT);", "return weight;"),
        f"{SQUARES}::test_the_covariance_of_the_shader_is_bounded_and_its_weights_are_not_zero",
    ),
    Mutant(
        "distances are relative to the brighter of two colours",
        edit(CORE, "min(length(a), length(b))", "max(length(a), length(b))"),
        TWIN,
    ),
    Mutant(
        "the feature is not kept within the neighbourhood",
        edit(CORE, "clamp(before.feature, lowest, highest)", "before.feature"),
        f"{SQUARES}::test_the_feature_before_is_kept_within_the_neighbourhood",
    ),
    Mutant(
        "the delayed predictor is the published one",
        edit(CORE, "if (is_delayed) {", "if (false) {"),
        TWIN,
    ),
    Mutant(
        "the delayed predictor stays that of the view before, however many samples follow",
        edit(CORE, "if (frames > 1.0) predictor", "if (false) predictor"),
        TWIN,
    ),
    Mutant(
        "several samples of a view weigh as one",
        edit(CORE, "weight * frames)", "weight)"),
        TWIN,
    ),
    Mutant(
        "what is not finite stays",
        edit(CORE, "if (!is_known) return", "if (false) return"),
        f"{SQUARES}::test_what_overflows_begins_anew",
    ),
    Mutant(
        "a mean of many samples begins a model as one does",
        edit(CORE, "if (frames > 1.0) fit", "if (false) fit"),
        f"{SQUARES}::test_a_model_that_begins_with_a_mean_of_samples_holds_on_to_it",
    ),
    Mutant(
        "two elements of the factor change places in texels",
        edit(ROWS, "factor[2].xy = rows.row[5].yz", "factor[2].xy = rows.row[5].zy"),
        f"{SQUARES}::test_a_model_survives_its_texels",
    ),
    Mutant(
        "limits of features leave out the row below",
        edit(PREDICT, "n / 3 - 1), ivec2(0), last)", "n / 3 - 2), ivec2(0), last)"),
        WHOLE,
    ),
    Mutant(
        "a pixel without a sample takes it for black",
        edit(PREDICT, "if (count > 0.0) made", "if (count >= 0.0) made"),
        f"{PASSES}::test_a_pixel_without_a_sample_shows_what_its_model_predicts",
    ),
    Mutant(
        "the film is reconstructed over outlines",
        edit("reconstruct.frag", ".w != object", ".w < 0.0"),
        f"{PASSES}::test_the_film_is_reconstructed_within_objects_alone",
    ),
    Mutant(
        "the film of many samples is reconstructed as widely",
        edit("reconstruct.frag", "weight *= min(FEW / samples, 1.0)", "weight *= 1.0"),
        f"{PASSES}::test_the_film_is_reconstructed_within_objects_alone",
    ),
    Mutant(
        "each sample of a view is a frame",
        edit(PREDICT, "max(count / frame, 1.0)", "max(count, 1.0)"),
        WHOLE,
    ),
    Mutant(
        "models follow other light as slowly as any",
        (Edit(HOST, "if not is_usable or not is_same_light:", "if not is_usable:"),),
        f"{PASSES}::test_a_view_under_other_light_is_right_once_it_has_samples",
    ),
    Mutant(
        "neighbours are alike by their predictions",
        edit(
            SHOWN,
            "texelFetch(feature, near, 0).rgb, own",
            "texelFetch(prediction, near, 0).rgb, own",
        ),
        WHOLE,
    ),
    Mutant(
        "near and far neighbours count the same",
        edit(SHOWN, "(away + unlike * unlike)", "(unlike * unlike)"),
        WHOLE,
    ),
    Mutant(
        "the film does not take the place of predictions",
        edit(SHOWN, "max(1.0 - samples / max(end, samples), 0.0)", "1.0"),
        f"{PASSES}::test_the_film_takes_the_place_of_predictions",
    ),
    Mutant(
        "the first of four models is taken, not the nearest",
        edit(
            "passes/reprojection.glsl", "if (distance < least && holds", "if (least > 2.5 && holds"
        ),
        f"{PASSES}::test_between_pixels_the_nearest_model_is_taken_as_it_is",
    ),
    Mutant(
        "models of another surface are taken over",
        edit(
            "passes/reprojection.glsl",
            "if (distance < least && holds(texel, object, seen, facing))",
            "if (distance < least)",
        ),
        f"{PASSES}::test_what_was_hidden_has_no_model_in_a_band_as_wide_as_the_parallax",
    ),
    Mutant(
        "pixels without history are told to have some",
        edit("false_colors.frag", "if (number > least) shown", "if (number > least - 1.0) shown"),
        "rendering/test_false_colors.py::test_numbers_of_history_are_drawn_and_none_is_grey",
    ),
    Mutant(
        "models that no sample followed are lost",
        (Edit(HOST, "if self._has_brought and not self._has_made:", "if False:"),),
        f"{PASSES}::test_a_view_without_a_sample_hands_its_models_on",
    ),
]
