"""Classic bugs of path tracers, each as a change of shader text and the fast test that finds it.

The tests themselves are on trial: `python -m tests.mutation` plants one bug after the other in a
copy of the tree and runs its test, which must fail.
"""

from typing import NamedTuple


class Edit(NamedTuple):
    """Text of a shader file, which stands there once, and what the bug puts in its place."""

    file: str
    old: str
    new: str


class Mutant(NamedTuple):
    """A bug, and the tests of one file (an expression for pytest -k) that must fail with it."""

    bug: str
    edits: tuple[Edit, ...]
    test: str  # FILE::NAME in tests/; all cases of it are run until one fails


def _edit(file: str, old: str, new: str) -> tuple[Edit, ...]:
    return (Edit(f"shaders_glsl/{file}", old, new),)


MUTANTS = [
    Mutant(
        "the cosine is missing in Lambert's law",
        _edit("bsdfs/matte.glsl", "color * (wi.z / PI)", "color * (1.0 / PI)"),
        "truths/test_direct_light.py::test_light_of_a_ball_falls_with_the_square_of_its_distance",
    ),
    Mutant(
        "light is counted twice: by sampling and by scattering",
        _edit("integrators/path.glsl", "power_heuristic(pdf, light_pdf) : 0.0", "1.0 : 1.0"),
        "truths/test_furnace.py::test_light_sampling_counts_a_wall_once",
    ),
    Mutant(
        "the index of refraction is inverted",
        _edit(
            "bsdfs/material.glsl",
            "outside ? 1.0 / material.ior : material.ior",
            "outside ? material.ior : 1.0 / material.ior",
        ),
        "shaders/test_dielectric.py::test_glass_knows_its_inside",
    ),
    Mutant(
        "survivors of roulette are not weighed",
        _edit("integrators/path.glsl", "    throughput /= survival;\n", ""),
        "truths/test_furnace.py::test_roulette_raises_the_variance_and_leaves_the_mean",
    ),
    Mutant(
        "seeds are hashed from index + frame",
        _edit(
            "sampling/sampler.glsl",
            "return pcg_hash(uint(pixel.x) + pcg_hash(uint(pixel.y) + frame));",
            "return pcg_hash(uint(pixel.y * 128 + pixel.x) + uint(sample_index) + seed);",
        ),
        "shaders/test_rng.py::test_pixels_and_their_neighbours_are_independent_over_many_frames",
    ),
    Mutant(
        "the running mean is a mix of two weights",
        _edit(
            "film/pixel.glsl",
            "vec3 next = mean + (step + dither);",
            "vec3 next = mean * (1.0 - weight) + x * weight;",
        ),
        "rendering/test_accumulation.py::test_equal_samples_have_their_value_as_mean_and_no_variance",
    ),
    Mutant(
        "all steps of the running mean are rounded the same way",
        _edit("film/pixel.glsl", "mean + (step + dither)", "mean + step"),
        "rendering/test_accumulation.py::test_film_keeps_its_digits_over_a_million_samples",
    ),
    Mutant(
        "hits nearer than a fixed epsilon are ignored",
        _edit(
            "shapes/sphere.glsl",
            "t > 0.0 && t < hit.distance && i != ignored",
            "t > 1e-3 && t < hit.distance && i != ignored",
        ),
        "truths/test_invariance.py::test_scene_scaled_by_a_power_of_two_keeps_its_bits",
    ),
    Mutant(
        "one bounce too many",
        _edit("integrators/path.glsl", "path.depth == frame.bounces", "path.depth > frame.bounces"),
        "truths/test_furnace.py::test_partial_sums_are_exact_at_every_pixel",
    ),
    Mutant(
        "the density of a sphere lamp is per area, not per solid angle",
        _edit(
            "lights/sampling.glsl",
            "lamps) / (2.0 * PI * one_minus_cos)",
            "lamps) / (4.0 * PI * sphere.radius * sphere.radius)",
        ),
        "shaders/test_light.py::test_the_density_of_a_sphere_lamp_is_one_over_its_solid_angle",
    ),
    Mutant(
        "Fresnel's root is taken of a negative number",
        _edit("bsdfs/dielectric.glsl", "    if (cos2_t <= 0.0) return 1.0;\n", ""),
        "shaders/test_dielectric.py::test_beyond_the_critical_angle_everything_is_reflected",
    ),
    Mutant(
        "the density of GGX lacks the Jacobian of reflection",
        _edit(
            "bsdfs/metal.glsl",
            "ggx_d(alpha, h) / (2.0 * ggx_shadow(alpha, wo))",
            "ggx_d(alpha, h) * (2.0 * dot(wo, h)) / ggx_shadow(alpha, wo)",
        ),
        "shaders/test_material.py::test_the_density_of_rough_metal_integrates_to_one",
    ),
    Mutant(
        "the lens has half its angle",
        _edit(
            "integrators/camera.glsl",
            "vec3 offset = disk.x * camera.right + disk.y * camera.up;",
            "vec3 offset = 0.5 * (disk.x * camera.right + disk.y * camera.up);",
        ),
        "shaders/test_camera.py::test_the_lens_is_a_disk_of_the_size_told_and_evenly_filled",
    ),
    Mutant(
        "roulette ends paths before their light is gathered",
        (
            Edit(
                "shaders_glsl/integrators/path.glsl",
                "    if (SAMPLE_LIGHTS && !is_delta(material)) {\n",
                "    vec3 arrived = path.throughput;\n"
                "    if (ROULETTE && path.depth > 0 && roulette_ends(path.throughput, rng)) {\n"
                "        return false;\n    }\n"
                "    if (SAMPLE_LIGHTS && !is_delta(material)) {\n",
            ),
            Edit(
                "shaders_glsl/integrators/path.glsl",
                "    if (ROULETTE && roulette_ends(path.throughput, rng)) return false;\n",
                "",
            ),
            Edit(
                "shaders_glsl/integrators/path.glsl",
                "path.throughput * direct_light(",
                "arrived * direct_light(",
            ),
        ),
        "truths/test_furnace.py::test_roulette_keeps_the_light_of_dim_paths",
    ),
    Mutant(
        "the background is counted twice after a bounce",
        _edit(
            "integrators/path.glsl",
            "path.throughput * background(path.ray.direction)",
            "path.throughput * background(path.ray.direction) * (path.depth > 0 ? 2.0 : 1.0)",
        ),
        "truths/test_furnace.py::test_white_ball_vanishes_under_a_white_sky",
    ),
    Mutant(
        "the cosine of a quad lamp is missing",
        _edit("lights/sampling.glsl", "(distance / cos_light)", "distance"),
        "truths/test_direct_light.py::test_rectangle_lights_the_point_below_its_corner",
    ),
    Mutant(
        "samples are counted from 1",
        _edit(
            "film/pixel.glsl",
            "float(index + 1) - pixel.dropped",
            "float(index + 2) - pixel.dropped",
        ),
        "rendering/test_accumulation.py::test_the_first_sample_is_taken_as_it_is",
    ),
    Mutant(
        "lamps are never in the shade",
        _edit(
            "integrators/path.glsl",
            "occluded(light.ray, light.distance, light.shape)",
            "light.distance < 0.0",
        ),
        "truths/test_truths.py::test_ball_before_a_lamp_takes_its_share_of_the_light",
    ),
    Mutant(
        "the sphere's discriminant is b^2 - c",
        _edit(
            "shapes/sphere.glsl",
            "r2 - dot(beside, beside)",
            "along * along - (dot(to_center, to_center) - r2)",
        ),
        "shaders/test_sphere.py::test_spheres_are_hit_where_float64_says_from_near_and_from_far",
    ),
    Mutant(
        "points stay where the distance leaves them, beside their sphere",
        _edit(
            "shapes/sphere.glsl",
            "vec3 position = sphere.center + sphere.radius * normal;",
            "vec3 position = p;",
        ),
        "shaders/test_shape.py::test_a_point_that_was_hit_from_afar_lies_on_its_shape_to_the_last_digits",
    ),
    Mutant(
        "the cone of a sphere lamp is 1 - sqrt(1 - s2)",
        _edit("lights/sampling.glsl", "s2 / (1.0 + sqrt(1.0 - s2))", "1.0 - sqrt(1.0 - s2)"),
        "shaders/test_light.py::test_the_cone_of_a_sphere_keeps_its_digits_up_to_a_million_radii",
    ),
    Mutant(
        "refraction does not scale radiance",
        _edit("bsdfs/dielectric.glsl", "float scale = eta * eta;", "float scale = 1.0;"),
        "truths/test_furnace.py::test_camera_in_glass_sees_the_square_of_the_index",
    ),
    Mutant(
        "sampled light is weighed by the density of scattering",
        _edit(
            "integrators/path.glsl",
            "power_heuristic(light.pdf, pdf_material(vertex, wi))",
            "power_heuristic(pdf_material(vertex, wi), light.pdf)",
        ),
        "truths/test_furnace.py::test_both_weighted_count_a_box_of_lamps_once",
    ),
    Mutant(
        "a uniform number can be 1",
        _edit(
            "sampling/unit_float.glsl",
            "float(x >> 8u) * 5.9604644775390625e-8",
            "float(x) / 4294967295.0",
        ),
        "shaders/test_rng.py::test_a_unit_float_lies_in_the_unit_interval_and_is_never_one",
    ),
    Mutant(
        "matte surfaces scatter evenly instead of by the cosine",
        _edit("sampling/warp.glsl", "float z = sqrt(1.0 - u.x);", "float z = 1.0 - u.x;"),
        "shaders/test_warp.py::test_the_hemisphere_is_filled_by_the_cosine",
    ),
    Mutant(
        "directions reflected in glass are not made unit vectors",
        _edit(
            "bsdfs/dielectric.glsl",
            "normalized(incoming + 2.0 * cos_i * n)",
            "incoming + 2.0 * cos_i * n",
        ),
        "truths/test_robust.py::test_directions_stay_unit_over_many_reflections_in_glass",
    ),
    Mutant(
        "boxes of the tree leave no room for rounding",
        (
            Edit(
                "shaders_glsl/shapes/sphere_tree.glsl",
                "const float SLACK = 3.814697265625e-6;",
                "const float SLACK = 0.0;",
            ),
            Edit("glrt/accel/sphere_nodes.py", "SLACK = 2.0**-18", "SLACK = 0.0"),
        ),
        "accel/test_spheres_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "of equal spheres the tree takes the one that it meets first",
        _edit("shapes/sphere_tree.glsl", "t == hit.distance && shape < hit.shape", "false"),
        "accel/test_spheres_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "a ray that misses a box of the tree leaves out the node behind it, too",
        _edit("shapes/sphere_tree.glsl", "? 1 : 1 + below;", "? 1 : 2 + below;"),
        "accel/test_spheres_by_tree.py::test_a_ray_finds_by_the_tree_what_it_finds_without",
    ),
    Mutant(
        "strips of a lamp are chosen by their width, not by their angle",
        _edit(
            "lights/quad_solid_angle.glsl", "sample_strip(view.x, quad.width, view.z, u.x)", "u.x"
        ),
        "shaders/test_quad_solid_angle.py::test_samples_are_even_over_strips_and_along_them",
    ),
    Mutant(
        "a strip seen under more than a right angle takes its complement",
        _edit(
            "lights/quad_solid_angle.glsl",
            "2.0 * half_angle : PI - 2.0 * half_angle",
            "2.0 * half_angle : 0.0",
        ),
        "shaders/test_quad_solid_angle.py::test_densities_sum_up_to_the_solid_angle",
    ),
    Mutant(
        "few lamps are chosen evenly, and weighed as if by flux over squared distance",
        _edit(
            "lights/choice.glsl",
            "sum += cluster_weight(i - 1, ray);",
            "sum += total / float(CLUSTERS);",
        ),
        "accel/test_light_choice.py::test_few_lamps_are_chosen_by_flux_over_squared_distance",
    ),
    Mutant(
        "the table of lamps takes every alias",
        _edit(
            "lights/choice.glsl",
            "rest < light.keep ? part.first + index : light.alias & 0xFFFF",
            "light.alias & 0xFFFF",
        ),
        "accel/test_clusters.py::test_a_lamp_is_chosen_as_often_as_its_density_says",
    ),
    Mutant(
        "among many lamps the density of one is that of its part of a cluster",
        _edit("lights/choice.glsl", "chance * light.share", "chance"),
        "accel/test_clusters.py::test_densities_are_the_chances_of_clusters_and_of_lamps_in_them",
    ),
    Mutant(
        "light beyond the last layer is lost",
        _edit("film/layers.glsl", "i == min(layer, LAYERS - 1)", "i == layer"),
        "methods/test_path_lengths.py::test_the_light_of_each_length_adds_up",
    ),
    Mutant(
        "the display adds the halves of a layer as if both had as many samples",
        _edit(
            "weighting.frag",
            "one.rgb * (one.a / count) + other.rgb * (other.a / count)",
            "0.5 * (one.rgb + other.rgb)",
        ),
        "rendering/test_relight.py::test_the_driver_shows_the_sum_that_files_hold",
    ),
    Mutant(
        "fragments begin anew with each dispatch",
        _edit(
            "trace.frag",
            "if (frame.first_sample == 0) return",
            "if (frame.first_sample >= 0) return",
        ),
        "rendering/test_fragment.py::test_fragment_and_compute_give_the_same_bits",
    ),
    Mutant(
        "fragments of a crop take the seeds of the corner of the frame",
        _edit(
            "trace.frag", "add_samples(pixel, frame.origin + texel)", "add_samples(pixel, texel)"
        ),
        "rendering/test_fragment.py::test_a_crop_by_fragments_is_the_part_of_the_frame",
    ),
    Mutant(
        "all draws of a block take their points in one order",
        _edit(
            "sampling/sampler.glsl",
            "owen_scramble(self.point, pcg_hash(self.block ^ first))",
            "self.point",
        ),
        "shaders/test_sobol.py::test_the_points_of_two_pairs_of_draws_are_shuffled_apart",
    ),
    Mutant(
        "the last two of four dimensions are the first two again",
        _edit(
            "sampling/sampler.glsl",
            "bool last = (self.dimension & 1u) == 0u;",
            "bool last = false;",
        ),
        "shaders/test_sobol.py::test_two_draws_in_turn_share_their_point",
    ),
    Mutant(
        "blocks of a pixel share their scramble",
        _edit(
            "sampling/sampler.glsl",
            "pixel_seed(pixel, index / BLOCK, ~seed)",
            "pixel_seed(pixel, 0, ~seed)",
        ),
        "shaders/test_sobol.py::test_blocks_are_independent_of_their_neighbours",
    ),
]
