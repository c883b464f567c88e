"""Bugs of the record of a path: what is told is not what happened."""

from tests.mutation.mutant import Mutant, edit

_RECORD = "paths.comp"
_PATH = "integrators/path.glsl"
_SUMS = "rendering/test_path_replay.py::test_lights_add_up_to_the_pixel"
_TRUTHS = "rendering/test_path_truths.py"
_LIGHT = "rendering/test_path_light.py"

_PARTICLES = "rendering/test_path_particles.py"

PATHS = [
    Mutant(
        "a replay draws the random numbers of another sample",
        edit(_RECORD, "sampler_at(place, index, frame.seed)", "sampler_at(place, offset + 1, 0u)"),
        _SUMS,
    ),
    Mutant(
        "the sky that the camera sees is left out of the record",
        edit(
            _PATH,
            "record_light(BY_SCATTERING, FROM_BACKGROUND,",
            "if (path.depth > 0) record_light(BY_SCATTERING, FROM_BACKGROUND,",
        ),
        _SUMS,
    ),
    Mutant(
        "the weight of one light is told of the next",
        edit(
            _RECORD,
            "        if (row < most_lights) lights[row] = light_here;\n    }\n    begin_light();",
            "        if (row < most_lights) lights[row] = light_here;\n    }",
        ),
        f"{_LIGHT}::test_densities_and_weights_of_both_strategies",
    ),
    Mutant(
        "the density told of the other strategy is that of this one",
        edit(_PATH, "record_weight(scattered, share);", "record_weight(light.pdf, share);"),
        f"{_LIGHT}::test_densities_and_weights_of_both_strategies",
    ),
    Mutant(
        "a lamp that is hidden is told as found",
        edit(_RECORD, "{ light_here.is_hidden = 1; }", "{}"),
        f"{_LIGHT}::test_hidden_lamps_are_told",
    ),
    Mutant(
        "throughput is told without the scale of refraction",
        edit(
            _PATH,
            "                  path.scale * path.throughput);",
            "                  path.throughput);",
        ),
        f"{_TRUTHS}::test_throughput_is_what_surfaces_and_roulette_leave",
    ),
    Mutant(
        "the chance that roulette gave is not told",
        edit("integrators/roulette.glsl", "    record_survival(survival);\n", ""),
        f"{_TRUTHS}::test_throughput_is_what_surfaces_and_roulette_leave",
    ),
    Mutant(
        "paths that roulette ends are told as absorbed",
        edit(_PATH, "goes_on(END_BY_ROULETTE)", "goes_on(END_ABSORBED)"),
        f"{_TRUTHS}::test_paths_end_for_the_reason_told",
    ),
    Mutant(
        "the last vertex of a path is not written down",
        edit(
            _RECORD,
            "    while (extend_path(path, rng)) {}\n    write_vertex();\n",
            "    while (extend_path(path, rng)) {}\n",
        ),
        f"{_TRUTHS}::test_paths_end_for_the_reason_told",
    ),
    Mutant(
        "a replay follows the particles of another sample",
        edit(_RECORD, "ivec2(lane, -1), frame.first_sample,", "ivec2(lane, -1), 1,"),
        f"{_PARTICLES}::test_both_films_add_up",
    ),
    Mutant(
        "the densities told of a link are those of the other way round",
        edit(
            "integrators/camera_links.glsl",
            "record_link(frame.particles * self.emission, pdf, weight);",
            "record_link(pdf, frame.particles * self.emission, weight);",
        ),
        f"{_PARTICLES}::test_their_weight_is_against_both_ways_of_the_camera",
    ),
    Mutant(
        "what crosses a surface is told as reflected",
        edit(_RECORD, "crosses ? EVENT_CROSSED : EVENT_REFLECTED", "EVENT_REFLECTED"),
        f"{_TRUTHS}::test_glass_bends_and_what_is_matte_scatters",
    ),
]
