"""Bugs of light transport: how surfaces scatter, lamps shine, and paths and lenses gather light."""

from tests.mutation.mutant import Edit, Mutant, edit

TRANSPORT = [
    Mutant(
        "the cosine is missing in Lambert's law",
        edit("bsdfs/matte.glsl", "color * (wi.z / PI)", "color * (1.0 / PI)"),
        "truths/test_direct_light.py::test_light_of_a_ball_falls_with_the_square_of_its_distance",
    ),
    Mutant(
        "light is counted twice: by sampling and by scattering",
        edit("integrators/path.glsl", "power_heuristic(pdf, light_pdf) : 0.0", "1.0 : 1.0"),
        "truths/test_furnace.py::test_light_sampling_counts_a_wall_once",
    ),
    Mutant(
        "the index of refraction is inverted",
        edit(
            "bsdfs/scattering.glsl",
            "is_outside ? 1.0 / material.ior : material.ior",
            "is_outside ? material.ior : 1.0 / material.ior",
        ),
        "shaders/test_dielectric.py::test_glass_knows_its_inside",
    ),
    Mutant(
        "survivors of roulette are not weighed",
        edit("integrators/roulette.glsl", "    throughput /= survival;\n", ""),
        "truths/test_roulette.py::test_roulette_raises_the_variance_and_leaves_the_mean",
    ),
    Mutant(
        "one bounce too many",
        edit("integrators/path.glsl", "path.depth == frame.bounces", "path.depth > frame.bounces"),
        "truths/test_furnace.py::test_partial_sums_are_exact_at_every_pixel",
    ),
    Mutant(
        "the density of a sphere lamp is per area, not per solid angle",
        edit(
            "lights/sampling.glsl",
            "lamps) / (2.0 * PI * one_minus_cos)",
            "lamps) / (4.0 * PI * sphere.radius * sphere.radius)",
        ),
        "shaders/test_light.py::test_the_density_of_a_sphere_lamp_is_one_over_its_solid_angle",
    ),
    Mutant(
        "Fresnel's root is taken of a negative number",
        edit("bsdfs/dielectric.glsl", "    if (cos2_t <= 0.0) return 1.0;\n", ""),
        "shaders/test_dielectric.py::test_beyond_the_critical_angle_everything_is_reflected",
    ),
    Mutant(
        "the density of GGX lacks the Jacobian of reflection",
        edit(
            "bsdfs/metal.glsl",
            "ggx_d(alpha, h) / (2.0 * ggx_shadow(alpha, wo))",
            "ggx_d(alpha, h) * (2.0 * dot(wo, h)) / ggx_shadow(alpha, wo)",
        ),
        "shaders/test_material.py::test_the_density_of_rough_metal_integrates_to_one",
    ),
    Mutant(
        "the lens has half its angle",
        edit(
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
                "    if (!is_delta(material)) gather_direct(",
                "    vec3 arrived = path.throughput;\n"
                "    if (ROULETTE && path.depth > 0 && roulette_ends(path.throughput, rng)) {\n"
                "        return false;\n    }\n"
                "    vec3 raised = path.throughput;\n"
                "    path.throughput = arrived;\n"
                "    if (!is_delta(material)) gather_direct(",
            ),
            Edit(
                "shaders_glsl/integrators/path.glsl",
                "    if (ROULETTE && !resamples && roulette_ends(path.throughput, rng)) "
                "return goes_on(END_BY_ROULETTE);\n",
                "",
            ),
            Edit(
                "shaders_glsl/integrators/path.glsl",
                "    precise Scattering next = sample_material(",
                "    path.throughput = raised;\n    precise Scattering next = sample_material(",
            ),
        ),
        "truths/test_roulette.py::test_roulette_keeps_the_light_of_dim_paths",
    ),
    Mutant(
        "the background is counted twice after a bounce",
        edit(
            "integrators/path.glsl",
            "path.throughput * background(path.ray.direction)",
            "path.throughput * background(path.ray.direction) * (path.depth > 0 ? 2.0 : 1.0)",
        ),
        "truths/test_furnace.py::test_white_ball_vanishes_under_a_white_sky",
    ),
    Mutant(
        "the cosine of a quad lamp is missing",
        edit("lights/sampling.glsl", "(distance / cos_light)", "distance"),
        "truths/test_direct_light.py::test_rectangle_lights_the_point_below_its_corner",
    ),
    Mutant(
        "the cosine of a round lamp is missing",
        edit("lights/sampling.glsl", "* distance / cos_light", "* distance"),
        "shaders/test_disk.py::test_a_round_lamp_lights_the_floor_by_its_form_factor",
    ),
    Mutant(
        "points of a round lamp crowd in its middle",
        edit(
            "lights/sampling.glsl",
            "disk.radius * sample_disk(u)",
            "disk.radius * u.x * sample_disk(u)",
        ),
        "shaders/test_disk.py::test_the_density_is_that_of_even_points_in_solid_angle",
    ),
    Mutant(
        "lamps are never in the shade",
        edit(
            "integrators/path.glsl",
            "occluded(light.ray, light.distance, light.shape)",
            "light.distance < 0.0",
        ),
        "truths/test_truths.py::test_ball_before_a_lamp_takes_its_share_of_the_light",
    ),
    Mutant(
        "the cone of a sphere lamp is 1 - sqrt(1 - s2)",
        edit("lights/sampling.glsl", "s2 / (1.0 + sqrt(1.0 - s2))", "1.0 - sqrt(1.0 - s2)"),
        "shaders/test_light.py::test_the_cone_of_a_sphere_keeps_its_digits_up_to_a_million_radii",
    ),
    Mutant(
        "refraction does not scale radiance",
        edit("bsdfs/dielectric.glsl", "float scale = eta * eta;", "float scale = 1.0;"),
        "truths/test_furnace.py::test_camera_in_glass_sees_the_square_of_the_index",
    ),
    Mutant(
        "sampled light is weighed by the density of scattering",
        edit(
            "integrators/path.glsl",
            "return power_heuristic(light.pdf, scattered);",
            "return power_heuristic(scattered, light.pdf);",
        ),
        "truths/test_furnace.py::test_both_weighted_count_a_box_of_lamps_once",
    ),
    Mutant(
        "directions reflected in glass are not made unit vectors",
        edit(
            "bsdfs/dielectric.glsl",
            "normalized(incoming + 2.0 * cos_i * n)",
            "incoming + 2.0 * cos_i * n",
        ),
        "truths/test_glass.py::test_directions_stay_unit_over_many_reflections_in_glass",
    ),
    Mutant(
        "strips of a lamp are chosen by their width, not by their angle",
        edit(
            "lights/quad_solid_angle.glsl", "sample_strip(view.x, quad.width, view.z, u.x)", "u.x"
        ),
        "shaders/test_quad_solid_angle.py::test_samples_are_even_over_strips_and_along_them",
    ),
    Mutant(
        "a strip seen under more than a right angle takes its complement",
        edit(
            "lights/quad_solid_angle.glsl",
            "2.0 * half_angle : PI - 2.0 * half_angle",
            "2.0 * half_angle : 0.0",
        ),
        "shaders/test_quad_solid_angle.py::test_densities_sum_up_to_the_solid_angle",
    ),
    Mutant(
        "few lamps are chosen evenly, and weighed as if by flux over squared distance",
        edit(
            "lights/choice.glsl",
            "sum += cluster_weight(i - 1, ray);",
            "sum += total / float(CLUSTERS);",
        ),
        "accel/test_light_choice.py::test_few_lamps_are_chosen_by_flux_over_squared_distance",
    ),
    Mutant(
        "the table of lamps takes every alias",
        edit(
            "lights/choice.glsl",
            "rest < light.keep ? part.first + index : light.alias & 0xFFFF",
            "light.alias & 0xFFFF",
        ),
        "accel/test_clusters.py::test_a_lamp_is_chosen_as_often_as_its_density_says",
    ),
    Mutant(
        "among many lamps the density of one is that of its part of a cluster",
        edit("lights/choice.glsl", "chance * light.share", "chance"),
        "accel/test_clusters.py::test_densities_are_the_chances_of_clusters_and_of_lamps_in_them",
    ),
    Mutant(
        "below the horizon the sky goes on to the zenith",
        edit(
            "lights/sky.glsl",
            "direction.y < 0.0 ? frame.background_bottom",
            "false ? frame.background_bottom",
        ),
        "truths/test_horizon.py::test_each_side_is_a_gradient_of_its_own",
    ),
    Mutant(
        "a sky of two gradients goes by the height above the nadir",
        edit("lights/sky.glsl", "abs(direction.y) * (pole", "0.5 * (direction.y + 1.0) * (pole"),
        "truths/test_horizon.py::test_each_side_is_a_gradient_of_its_own",
    ),
    Mutant(
        "models see the lower half of a sky from above",
        edit("lights/sky.glsl", "(sine - angle * normal.y)", "(sine + angle * normal.y)"),
        "truths/test_horizon.py::test_models_know_what_a_surface_gathers",
    ),
    Mutant(
        "models take the middle of a sky that has a horizon",
        edit(
            "lights/sky.glsl",
            "if (!HAS_HORIZON) return background(two_thirds_up);",
            "return background(two_thirds_up);",
        ),
        "truths/test_horizon.py::test_models_know_what_a_surface_gathers",
    ),
    Mutant(
        "the image of the sky is mirrored",
        edit("sampling/angle.glsl", "direction.x < 0.0 ? -azimuth", "direction.x > 0.0 ? -azimuth"),
        "truths/test_sky_image.py::test_pixels_stand_where_the_format_says",
    ),
    Mutant(
        "the image of the sky stands on its head",
        edit(
            "sampling/angle.glsl", "angle_of(across, direction.y)", "angle_of(across, -direction.y)"
        ),
        "truths/test_sky_image.py::test_the_first_row_is_above",
    ),
    Mutant(
        "the image of the sky turns the other way",
        edit(
            "lights/sky.glsl",
            "(direction) + frame.background_turn",
            "(direction) + 1.0 - frame.background_turn",
        ),
        "truths/test_sky_image.py::test_a_quarter_turn_moves_what_stood_ahead_to_the_left",
    ),
    Mutant(
        "the image of the sky has an edge behind the camera",
        edit("lights/sky.glsl", "+ size.x) % size.x", "+ size.x) % (size.x + 1)"),
        "truths/test_sky_image.py::test_directions_see_what_float64_says",
    ),
    Mutant(
        "pixels of the sky are half a pixel off",
        edit("lights/sky.glsl", "* vec2(environment_size()) - 0.5", "* vec2(environment_size())"),
        "truths/test_sky_image.py::test_a_floor_gathers_the_upper_half",
    ),
]
