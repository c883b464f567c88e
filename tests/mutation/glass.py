"""Bugs of glass: rough, tinted, thin, and in other glass."""

from tests.mutation.mutant import Edit, Mutant, edit

_ROUGH = "bsdfs/rough_dielectric.glsl"
_MEDIA = "integrators/media.glsl"
_PATH = "integrators/path.glsl"
_STATE = "integrators/path_state.glsl"
_SHADERS = "shaders/test_rough_dielectric.py"
_TRUTHS = "truths/test_media.py"

GLASS = [
    Mutant(
        "the half vector's Jacobian is missing in refraction",
        edit(_ROUGH, "(4.0 * cos_o / stretch) * (-cos_i / stretch)", "4.0 * cos_o * -cos_i"),
        f"{_SHADERS}::test_facets_scatter_as_the_textbook_says",
    ),
    Mutant(
        "radiance that crosses rough glass does not scale where a lamp is sampled",
        edit(_ROUGH, "wi.z < 0.0 ? vertex.eta * vertex.eta : 1.0", "1.0"),
        f"{_SHADERS}::test_light_goes_both_ways_but_for_eta_squared",
    ),
    Mutant(
        "the density of rough glass is that of its facets alone",
        edit(_ROUGH, "kept * facets.pdf + lost;", "facets.pdf;"),
        f"{_SHADERS}::test_samples_follow_their_density",
    ),
    Mutant(
        "what facets lose to each other stays lost",
        edit(_ROUGH, "return glass.first_albedo >= 0;", "return false;"),
        f"{_SHADERS}::test_no_light_is_lost_or_gained",
    ),
    Mutant(
        "facets lose as much of light from inside as of that from outside",
        edit(
            _ROUGH,
            "outside ? both.x : both.y",
            "both.x",
        ),
        f"{_SHADERS}::test_no_light_is_lost_or_gained",
    ),
    Mutant(
        "lost light crosses as often from inside as from outside",
        (
            Edit(
                "glrt/scene/facets.py",
                "even / ior**2 * min(1, outer / inner)",
                "even * min(1, outer / inner)",
            ),
        ),
        f"{_SHADERS}::test_light_goes_both_ways_but_for_eta_squared",
    ),
    Mutant(
        "rays to lamps through rough glass leave its outer side",
        edit(_PATH, "    if (crosses) light.ray.inward = !light.ray.inward;\n", ""),
        "truths/test_rough_glass.py::test_methods_agree_on_light_through_rough_glass",
    ),
    Mutant(
        "tinted glass does not absorb the light of sampled lamps",
        edit(_PATH, "direct *= share_left(", "share_left("),
        f"{_TRUTHS}::test_lamps_in_tinted_glass_are_found_alike",
    ),
    Mutant(
        "tinted glass ends where light leaves it, but not its colour",
        edit(
            _PATH,
            "enters ? absorption_of_glass(material.details) : vec3(0.0);",
            "absorption_of_glass(material.details);",
        ),
        f"{_TRUTHS}::test_light_is_left_as_beer_says",
    ),
    Mutant(
        "a camera in tinted glass is in air",
        edit(_STATE, "HAS_ATTENUATION ? frame.camera_absorption : vec3(0.0)", "vec3(0.0)"),
        f"{_TRUTHS}::test_a_camera_in_glass_sees_through_what_is_before_it",
    ),
    Mutant(
        "a pane reflects as one face does",
        edit("bsdfs/pane.glsl", "2.0 * face / (1.0 + face)", "face"),
        f"{_TRUTHS}::test_a_pane_passes_what_two_faces_do",
    ),
    Mutant(
        "the lower priority is there",
        (Edit("glrt/scene/glasses.py", "-(glass.priority or 0)", "glass.priority or 0"),),
        f"{_TRUTHS}::test_the_higher_priority_is_there",
    ),
    Mutant(
        "sampled light is thought to pass surfaces that are none",
        edit(_PATH, "    path.pdf = 0.0;\n    return true;", "    return true;"),
        f"{_TRUTHS}::test_lamps_are_found_behind_surfaces_that_are_none",
    ),
    Mutant(
        "a camera in nested glass is in air",
        edit(_STATE, "HAS_NESTED ? frame.camera_counts : 0u", "0u"),
        f"{_TRUTHS}::test_a_camera_under_water_looks_out_through_glass",
    ),
    Mutant(
        "light that is left after a distance falls too slowly",
        edit(_MEDIA, "1.0 + rest + rest * rest * p", "1.0 + rest"),
        "shaders/test_decay.py::test_decay_is_the_exponential_function",
    ),
]
