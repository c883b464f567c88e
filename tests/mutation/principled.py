"""Bugs of principled surfaces."""

from tests.mutation.mutant import Edit, Mutant, edit

_FILE = "bsdfs/principled.glsl"
_SHADERS = "shaders/test_principled.py"
_TRUTHS = "truths/test_principled.py"

PRINCIPLED = [
    Mutant(
        "the density of a sample is that of the chosen lobe alone",
        edit(_FILE, "pdf += chances.y * density;", ""),
        f"{_SHADERS}::test_samples_follow_their_density",
    ),
    Mutant(
        "a clear coat leaves all light to what is below",
        edit(_FILE, "value *= min(below_coat(gloss, wi.z), below_coat(gloss, vertex.wo.z));", ""),
        f"{_SHADERS}::test_it_scatters_as_the_formulas_say",
    ),
    Mutant(
        "what is below a coat is weighed by the view alone, as in glTF",
        edit(
            _FILE,
            "min(below_coat(gloss, wi.z), below_coat(gloss, vertex.wo.z))",
            "below_coat(gloss, vertex.wo.z)",
        ),
        f"{_SHADERS}::test_light_goes_both_ways",
    ),
    Mutant(
        "the base gets all light",
        edit(_FILE, "it.base * (from.base * to.base * gloss.even_base)", "it.base"),
        f"{_SHADERS}::test_white_surfaces_lose_little_and_gain_nothing",
    ),
    Mutant(
        "facets lose light to each other for good",
        edit(_FILE, "it.again * (from.lost * to.lost * gloss.spread)", "vec3(0.0)"),
        f"{_SHADERS}::test_white_surfaces_lose_little_and_gain_nothing",
    ),
    Mutant(
        "metal keeps a matte base",
        edit(
            _FILE,
            "vec3 base = (1.0 - material.metallic) * material.color;",
            "vec3 base = material.color;",
        ),
        f"{_SHADERS}::test_it_scatters_as_the_formulas_say",
    ),
    Mutant(
        "a smooth coat is not divided by the chance of its choice",
        edit(_FILE, "(1.0 - COAT_F0) * edge) / chances.x);", "(1.0 - COAT_F0) * edge));"),
        f"{_SHADERS}::test_smooth_facets_over_matte_are_a_closed_form",
    ),
    Mutant(
        "a coat does not dim smooth facets",
        edit(_FILE, " * below_coat(gloss, cosine) / chances.y", " / chances.y"),
        f"{_SHADERS}::test_smooth_facets_over_matte_are_a_closed_form",
    ),
    Mutant(
        "the tables of facets are those of head-on and grazing exchanged",
        (
            Edit(
                "glrt/scene/gloss.py",
                "return (share * (1 - edge)).mean(axis=1), (share * edge).mean(axis=1)",
                "return (share * edge).mean(axis=1), (share * (1 - edge)).mean(axis=1)",
            ),
        ),
        f"{_SHADERS}::test_tables_are_the_integral_of_facets",
    ),
    Mutant(
        "a surface that is glass in part is glass as often as not",
        edit(_FILE, "if (u >= share)", "if (u >= 0.5)"),
        f"{_TRUTHS}::test_glass_in_part_is_a_mean_of_glass_and_the_rest",
    ),
    Mutant(
        "holes are as rare as the surface",
        edit("textures/holes.glsl", ">= material.coverage;", "< material.coverage;"),
        f"{_TRUTHS}::test_holes_let_light_through",
    ),
    Mutant(
        "glass that is a part does not tint what crosses",
        edit("bsdfs/scattering.glsl", "HAS_TRANSMISSION ? material.color : vec3(1.0)", "vec3(1.0)"),
        f"{_TRUTHS}::test_light_takes_the_colour_at_each_crossing",
    ),
]
