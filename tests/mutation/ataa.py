"""Bugs of adaptive temporal antialiasing: its rules, its filter, its samples."""

from tests.mutation.mutant import Edit, Mutant, edit

GLSL, FRAG, MORE = "temporal/ataa.glsl", "ataa.frag", "glrt/rendering/more_samples.py"
TESTS = "temporal/test_ataa.py"
RULES = f"{TESTS}::test_the_first_rule_that_fires_decides"
FILTER = f"{TESTS}::test_the_filter_does_what_the_twin_does"
HIDDEN = f"{TESTS}::test_what_was_hidden_is_traced_in_a_band_as_wide_as_the_parallax"

ATAA = [
    Mutant(
        "mirrors keep history however they move",
        edit(GLSL, "is_specular && length", "false && length"),
        RULES,
    ),
    Mutant(
        "edges are traced forever",
        edit(GLSL, "known < ENOUGH_SAMPLES ? TRACED : KEEPS", "TRACED"),
        f"{TESTS}::test_a_still_camera_traces_ever_less",
    ),
    Mutant(
        "what comes into sight is traced, not filtered",
        edit(GLSL, "return FILTERED;", "return TRACED_ALONE;"),
        f"{TESTS}::test_a_pan_by_whole_pixels_filters_as_many_columns",
    ),
    Mutant(
        "the filter goes across edges",
        edit(
            FRAG,
            "vec2(sw + se - nw - ne, nw + sw - ne - se)",
            "vec2(nw + sw - ne - se, sw + se - nw - ne)",
        ),
        FILTER,
    ),
    Mutant(
        "the filter keeps what leaves the lumas around",
        edit(FRAG, "luma < lowest || luma > highest ? inner : outer", "outer"),
        FILTER,
    ),
    Mutant(
        "the film does not count beside traced samples",
        edit(
            FRAG,
            "(count * texelFetch(light, texel, 0).rgb + extra.a * extra.rgb) / samples",
            "extra.rgb",
        ),
        HIDDEN,
    ),
    Mutant(
        "traced samples are those of the film again",
        (Edit(MORE, "renderer.settings.seed ^ OTHER_SEED", "renderer.settings.seed"),),
        HIDDEN,
    ),
    Mutant(
        "history that was out of the box is blended with traced samples",
        edit(GLSL, "if (off > OFF_BOX) return TRACED_ALONE;", "if (off > OFF_BOX) return TRACED;"),
        RULES,
    ),
    Mutant(
        "samples are traced under other weights, too",
        (
            Edit(
                "glrt/rendering/temporal.py",
                "renderer if is_whole(renderer, weights) else None",
                "renderer",
            ),
        ),
        f"{TESTS}::test_other_weights_trace_nothing",
    ),
    Mutant(
        "eight samples are traced, whatever is asked for",
        (Edit("glrt/rendering/temporal.py", "Ataa(gl, way.traced)", "Ataa(gl)"),),
        "analysis/test_motion.py::test_ataa_traces_as_many_samples_as_are_asked_for",
    ),
]
