"""Bugs of random numbers and of what is drawn by them."""

from tests.mutation.mutant import Mutant, edit

SAMPLING = [
    Mutant(
        "seeds are hashed from index + frame",
        edit(
            "sampling/sampler.glsl",
            "return pcg_hash(uint(pixel.x) + pcg_hash(uint(pixel.y) + frame));",
            "return pcg_hash(uint(pixel.y * 128 + pixel.x) + uint(sample_index) + seed);",
        ),
        "shaders/test_rng.py::test_pixels_and_their_neighbours_are_independent_over_many_frames",
    ),
    Mutant(
        "a uniform number can be 1",
        edit(
            "sampling/unit_float.glsl",
            "float(x >> 8u) * 5.9604644775390625e-8",
            "float(x) / 4294967295.0",
        ),
        "shaders/test_rng.py::test_a_unit_float_lies_in_the_unit_interval_and_is_never_one",
    ),
    Mutant(
        "matte surfaces scatter evenly instead of by the cosine",
        edit("sampling/warp.glsl", "float z = sqrt(1.0 - u.x);", "float z = 1.0 - u.x;"),
        "shaders/test_warp.py::test_the_hemisphere_is_filled_by_the_cosine",
    ),
    Mutant(
        "all draws of a block take their points in one order",
        edit(
            "sampling/sampler.glsl",
            "owen_scramble(self.point, pcg_hash(self.block ^ first))",
            "self.point",
        ),
        "shaders/test_sobol.py::test_the_points_of_two_pairs_of_draws_are_shuffled_apart",
    ),
    Mutant(
        "the last two of four dimensions are the first two again",
        edit(
            "sampling/sampler.glsl",
            "bool last = (self.dimension & 1u) == 0u;",
            "bool last = false;",
        ),
        "shaders/test_sobol.py::test_two_draws_in_turn_share_their_point",
    ),
    Mutant(
        "blocks of a pixel share their scramble",
        edit(
            "sampling/sampler.glsl",
            "pixel_seed(pixel, index / BLOCK, ~seed)",
            "pixel_seed(pixel, 0, ~seed)",
        ),
        "shaders/test_sobol.py::test_blocks_are_independent_of_their_neighbours",
    ),
    Mutant(
        "64 points are Sobol's in their first two dimensions, and again in their last two",
        edit("sampling/sobol64.glsl", "last ? all >> 12u : all", "all"),
        "shaders/test_sobol.py::test_64_points_fill_four_dimensions_evenly",
    ),
    Mutant(
        "the last level of the scramble of 64 points flips all alike",
        edit("sampling/sobol64.glsl", "(tree.y >> (v >> 1u)) & 1u", "tree.y & 1u"),
        "shaders/test_sobol.py::test_the_points_of_two_pairs_of_draws_are_shuffled_apart",
    ),
    Mutant(
        "both coordinates of 64 points share their scramble",
        edit("sampling/sobol64.glsl", "two >> 6u & 63u, trees.zw", "two >> 6u & 63u, trees.xy"),
        "shaders/test_sobol.py::test_each_point_is_uniform_over_pixels_and_blocks",
    ),
]
