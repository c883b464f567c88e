"""Bugs of lamps that share a place with other surfaces."""

from tests.mutation.mutant import Edit, Mutant, edit

_PLACES = "shapes/coincident.glsl"
_TRUTHS = "truths/test_coincident_lamps.py"
_LIGHT = f"{_TRUTHS}::test_the_light_below_is_that_of_what_is_seen"
_FURNACE = f"{_TRUTHS}::test_a_furnace_of_doubled_walls_is_even"

COINCIDENT = [
    Mutant(
        "of two surfaces in one place the lower number is seen, whether or not it emits",
        edit(
            _PLACES,
            "own.shines == other.shines ? shape < hit.shape : own.shines",
            "shape < hit.shape",
        ),
        _LIGHT,
    ),
    Mutant(
        "a lamp that emits to the other side comes first, too",
        edit(_PLACES, "shines && dot(normal, ray.direction) < 0.0", "shines"),
        _LIGHT,
    ),
    Mutant(
        "rays start on the surface that shares the place of the one they leave",
        edit(_PLACES, "    ray.origin += shift * normal;\n", ""),
        _FURNACE,
    ),
    Mutant(
        "a lamp sample counts wherever nothing stands before the lamp",
        edit(
            "textures/holes.glsl",
            "if (HAS_COINCIDENT && ignored != NO_SHAPE",
            "if (false && ignored != NO_SHAPE",
        ),
        _LIGHT,
    ),
    Mutant(
        "particles leave a lamp where another one is seen",
        edit("integrators/particles.glsl", "    return shows(back, lamp);", "    return true;"),
        f"{_TRUTHS}::test_particles_leave_the_lamp_that_is_seen",
    ),
    Mutant(
        "an object is left out although one of its sides is seen",
        (
            Edit(
                "glrt/scene/twins.py",
                "(own == side or not thing.is_one_sided)",
                "True",
            ),
        ),
        "scene/test_twins.py::test_each_side_shows_one",
    ),
    Mutant(
        "surfaces that touch along an edge overlap",
        (Edit("glrt/scene/coincidence.py", "depth > LEAST_OVERLAP * width", "depth >= 0"),),
        "scene/test_coincidence.py::test_neighbours_are_not",
    ),
    Mutant(
        "triangles repeat others from the same first corner alone",
        (
            Edit(
                "glrt/scene/repeated_triangles.py",
                "np.roll(corners, -first, axis=0).tobytes()",
                "corners.tobytes()",
            ),
        ),
        "scene/test_twins.py::test_triangles_of_equal_corners_are_found_whatever_comes_first",
    ),
]
