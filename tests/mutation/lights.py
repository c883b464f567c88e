"""Bugs of what lamps emit: cones, sides, groups, and the choice among lamps that are aimed."""

from tests.mutation.mutant import Edit, Mutant, edit

_EMISSION = "lights/emission.glsl"
_CONES = "shaders/test_emission.py::test_emission_has_the_share_of_the_cone"
_TRUTHS = "truths/test_emission.py"
_KEYS = "truths/test_object_keys.py"

LIGHTS = [
    Mutant(
        "cones are half as wide",
        edit(_EMISSION, "share_in_cone(0.5 * dot(aside, aside)", "share_in_cone(dot(aside, aside)"),
        _CONES,
    ),
    Mutant(
        "the share of a cone falls in a straight line",
        edit(_EMISSION, "s * s * (3.0 - 2.0 * s)", "s"),
        _CONES,
    ),
    Mutant(
        "cones open backwards",
        edit(_EMISSION, "direction - emitter.axis", "direction + emitter.axis"),
        f"{_TRUTHS}::test_outside_the_outer_angle_a_spot_is_dark",
    ),
    Mutant(
        "the scene's cone has the inner angle for both",
        (Edit("glrt/rendering/aims.py", "return outer, min(1", "return inner, min(1"),),
        f"{_TRUTHS}::test_a_spot_in_a_white_ball_gives_off_the_flux_of_its_cone",
    ),
    Mutant(
        "one-sided lamps shine backwards",
        edit(_EMISSION, "is_one_sided != 0 && !facing", "is_one_sided != 0 && facing"),
        f"{_TRUTHS}::test_a_quad_shines_along_its_normal",
    ),
    Mutant(
        "the back of a lamp that is hit emits too",
        edit("integrators/path.glsl", "-path.ray.direction, facing)", "-path.ray.direction, true)"),
        f"{_TRUTHS}::test_one_side_of_a_smooth_mesh_is_that_of_its_facets",
    ),
    Mutant(
        "shading normals tell which side emits",
        edit(
            "integrators/path.glsl",
            "bool facing = dot(path.ray.direction, true_normal(surface)) < 0.0;",
            "bool facing = dot(path.ray.direction, surface.normal) < 0.0;",
        ),
        f"{_TRUTHS}::test_one_side_of_a_smooth_mesh_is_that_of_its_facets",
    ),
    Mutant(
        "the older models take the shorter edge of a quad for edge_u",
        edit("integrators/classic.glsl", "dot(facing, quad.normal) < 0.0) facing", "false) facing"),
        f"{_TRUTHS}::test_a_quad_shines_along_its_normal",
    ),
    Mutant(
        "the size of a lamp does not widen its aim",
        edit(
            _EMISSION,
            "cosine >= lamp_cosine ? 1.0 : cosine * lamp_cosine + sine * lamp_sine",
            "cosine",
        ),
        "shaders/test_emission.py::test_what_a_lamp_lights_is_within_its_aim",
    ),
    Mutant(
        "a lamp is taken from elsewhere where a cluster lights nothing",
        edit(
            "lights/choice.glsl",
            "parts_weight(cluster, ray) == 0.0) return NO_LIGHT",
            "false) return NO_LIGHT",
        ),
        f"{_TRUTHS}::test_all_methods_see_the_same_light_of_many_spots",
    ),
    Mutant(
        "the light group of an object is overruled by that of its material",
        (
            Edit(
                "glrt/scene/scene.py",
                "group or material.group or name",
                "material.group or name or group",
            ),
        ),
        f"{_KEYS}::test_objects_of_one_material_have_groups_of_their_own",
    ),
    Mutant(
        "hidden objects are rendered",
        (Edit("glrt/scene/twins.py", "if not it.hidden and n not in covered", "if True"),),
        f"{_KEYS}::test_a_hidden_object_is_not_there",
    ),
]
