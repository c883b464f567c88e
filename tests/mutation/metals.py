"""Bugs of measured metals: their Fresnel equations, and where they are asked."""

from tests.mutation.mutant import Edit, Mutant, edit

_FRESNEL = "shaders/test_conductor.py::test_any_index_reflects_as_complex_arithmetic_says"
_TRUTHS = "truths/test_conductors.py"

METALS = [
    Mutant(
        "one polarisation stands for both",
        edit("bsdfs/conductor.glsl", "0.5 * (rs + rp);", "rs;"),
        _FRESNEL,
    ),
    Mutant(
        "the refracted part of a dark metal cancels",
        edit("bsdfs/conductor.glsl", "t >= 0.0 ? 0.5 * (sum + t) :", "true ? 0.5 * (sum + t) :"),
        "shaders/test_conductor.py::test_metals_reflect_as_complex_arithmetic_says",
    ),
    Mutant(
        "rough metal reflects as under the angle to its normal, not to its facets",
        edit(
            "bsdfs/metal.glsl",
            "metal_reflectance(vertex.material, dot(vertex.wo, h));",
            "metal_reflectance(vertex.material, vertex.wo.z);",
        ),
        f"{_TRUTHS}::test_a_rough_plate_reflects_its_albedo",
    ),
    Mutant(
        "sampled light is scattered by metal as if head-on",
        edit(
            "bsdfs/metal.glsl",
            "metal_reflectance(material, dot(vertex.wo, h));",
            "metal_reflectance(material, 1.0);",
        ),
        f"{_TRUTHS}::test_metal_weighs_sampled_light_as_scattered_light",
    ),
    Mutant(
        "all measured metals are the first of them",
        (
            Edit(
                "glrt/rendering/pack_materials.py",
                'number_of.get(finish.material, row["details"])',
                'number_of.get(finish.material, row["details"]) and 0',
            ),
        ),
        f"{_TRUTHS}::test_two_metals_are_told_apart",
    ),
]
