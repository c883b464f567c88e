"""Bugs of the film: how samples become means, layers and crops."""

from tests.mutation.mutant import Mutant, edit

FILM = [
    Mutant(
        "the running mean is a mix of two weights",
        edit(
            "film/pixel.glsl",
            "vec3 next = mean + (step + dither);",
            "vec3 next = mean * (1.0 - weight) + x * weight;",
        ),
        "rendering/test_accumulation.py::test_equal_samples_have_their_value_as_mean_and_no_variance",
    ),
    Mutant(
        "all steps of the running mean are rounded the same way",
        edit("film/pixel.glsl", "mean + (step + dither)", "mean + step"),
        "rendering/test_accumulation.py::test_film_keeps_its_digits_over_a_million_samples",
    ),
    Mutant(
        "samples are counted from 1",
        edit(
            "film/pixel.glsl",
            "next_mean(pixel.mean, x, pixel.count)",
            "next_mean(pixel.mean, x, pixel.count + 1.0)",
        ),
        "rendering/test_accumulation.py::test_the_first_sample_is_taken_as_it_is",
    ),
    Mutant(
        "light beyond the last layer is lost",
        edit("film/layers.glsl", "i == min(layer, LAYERS - 1)", "i == layer"),
        "methods/test_path_lengths.py::test_the_light_of_each_length_adds_up",
    ),
    Mutant(
        "the display adds the halves of a layer as if both had as many samples",
        edit(
            "weighting.frag",
            "one.rgb * (one.a / count) + other.rgb * (other.a / count)",
            "0.5 * (one.rgb + other.rgb)",
        ),
        "rendering/test_relight.py::test_the_driver_shows_the_sum_that_files_hold",
    ),
    Mutant(
        "fragments begin anew with each dispatch",
        edit(
            "trace.frag",
            "if (frame.is_empty != 0) return",
            "if (frame.is_empty >= 0) return",
        ),
        "rendering/test_fragment.py::test_fragment_and_compute_give_the_same_bits",
    ),
    Mutant(
        "fragments of a crop take the seeds of the corner of the frame",
        edit("trace.frag", "add_samples(pixel, frame.origin + texel)", "add_samples(pixel, texel)"),
        "rendering/test_fragment.py::test_a_crop_by_fragments_is_the_part_of_the_frame",
    ),
]
