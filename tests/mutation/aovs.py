"""Bugs of AOVs: what rays meet, what counts, and how the host reads it."""

from tests.mutation.mutant import Edit, Mutant, edit

HIT = "integrators/first_hit.glsl"
HOST = "glrt/rendering/aov_tracer.py"


def host(old: str, new: str) -> tuple[Edit, ...]:
    """An edit of what gathers AOVs."""
    return (Edit(HOST, old, new),)


AOVS = [
    Mutant(
        "normals are those of the shape, on either side",
        edit(HIT, "dot(surface.normal, ray.direction) > 0.0 ? -surface", "false ? -surface"),
        "rendering/test_aovs.py::test_a_wall_before_the_camera_is_known_to_the_last_bit",
    ),
    Mutant(
        "depth is the distance along the ray",
        edit(HIT, "vec3(dot(surface.position, frame.camera.forward))", "vec3(hit.distance)"),
        "rendering/test_aovs.py::test_a_wall_before_the_camera_is_known_to_the_last_bit",
    ),
    Mutant(
        "AOVs are those of the corner of the pixel",
        edit(
            HIT,
            "camera_ray(frame.camera, vec2(frame.size), vec2(place), rng)",
            "camera_ray(frame.camera, vec2(frame.size), vec2(place) - next_2d(rng), rng)",
        ),
        "rendering/test_aovs.py::test_the_position_on_a_wall_is_linear_in_the_pixel",
    ),
    Mutant(
        "AOVs have no jitter",
        edit(
            "integrators/camera.glsl",
            "vec2 jitter = next_2d(rng);",
            "vec2 jitter = 0.0 * next_2d(rng) + 0.5;",
        ),
        "rendering/test_aovs.py::test_the_position_on_a_wall_is_linear_in_the_pixel",
    ),
    Mutant(
        "samples that meet nothing count as depths of 0",
        edit(HIT, "aov == DEPTH || aov == POSITION", "aov == POSITION"),
        "rendering/test_aov_truths.py::test_means_over_pixels_with_edges_are_those_of_float64",
    ),
    Mutant(
        "samples that meet nothing are left out of albedo and normal",
        edit(HIT, "aov == DEPTH || aov == POSITION ? nothing_met() : vec3(0.0)", "nothing_met()"),
        "rendering/test_aovs.py::"
        "test_where_nothing_is_met_colour_and_normal_count_and_distances_do_not",
    ),
    Mutant(
        "the albedo of glass is that of a black material",
        edit(
            HIT, "if (material.kind == DIELECTRIC || material.kind == PANE) return vec3(1.0);", ""
        ),
        "rendering/test_aovs.py::test_every_material_has_its_albedo",
    ),
    Mutant(
        "the object is that of the pixel's corner",
        edit(
            "integrators/middle_ray.glsl",
            "(vec2(place) + 0.5) / vec2(frame.size)",
            "vec2(place) / vec2(frame.size)",
        ),
        "rendering/test_aovs.py::test_objects_have_their_place_in_the_scene_file",
    ),
    Mutant(
        "AOVs of a crop are those of the corner of the frame",
        edit(
            "aov.comp",
            "add_aovs(first, second, frame.origin + texel)",
            "add_aovs(first, second, texel)",
        ),
        "rendering/test_aov_bits.py::test_a_crop_has_the_aovs_of_that_part_of_the_frame",
    ),
    Mutant(
        "fragments of AOVs begin anew with each dispatch",
        edit("aov.frag", "if (frame.is_empty == 0) {", "if (frame.is_empty == 7) {"),
        "rendering/test_aov_bits.py::test_both_pipelines_and_tiers_give_the_same_aovs",
    ),
    Mutant(
        "the second AOV of a pass is read from the first",
        edit("aov.comp", "imageLoad(source_second_mean, texel)", "imageLoad(source_mean, texel)"),
        "rendering/test_aov_bits.py::test_an_aov_alone_is_that_among_all",
    ),
    Mutant(
        "objects are numbered as the kernel has them",
        host("for index in order_of_kernel(scene))", "for index in range(len(scene.objects)))"),
        "rendering/test_aovs.py::test_objects_have_their_place_in_the_scene_file",
    ),
    Mutant(
        "positions are relative to the camera",
        host("np.where(is_met, value + eye, 0.0)", "np.where(is_met, value, 0.0)"),
        "rendering/test_aov_truths.py::test_aovs_tell_what_the_camera_rays_of_paths_meet",
    ),
    Mutant(
        "positions are moved in float32",
        host(
            "np.array(scene.camera.position, np.float64)", "np.array(scene.camera.position, 'f4')"
        ),
        "rendering/test_aov_bits.py::test_far_from_the_origin_only_positions_lose_digits",
    ),
    Mutant(
        "the error of an AOV is that of n observations, not of n - 1",
        host("variance[..., :3] / (count - 1)", "variance[..., :3] / count"),
        "rendering/test_aov_truths.py::test_errors_of_positions_on_a_wall_are_those_that_seeds_show",
    ),
    Mutant(
        "AOVs end inside an observation",
        host("samples=block * planned.samples", "samples=max(block * planned.samples - 1, 1)"),
        "rendering/test_aov_updates.py::test_aovs_are_gathered_in_whole_observations",
    ),
    Mutant(
        "an edit leaves AOVs as they were",
        (Edit("glrt/rendering/tracer.py", "        after.aovs.restart(plan)\n", ""),),
        "rendering/test_aov_updates.py::test_an_edit_restarts_aovs_and_leaves_nothing_behind",
    ),
    Mutant(
        "a dispatch of AOVs that ran into the loop limit is taken as it is",
        host("if scene.lost_any() and planned.samples > 1:", "if False:"),
        "rendering/test_aov_bits.py::test_a_dispatch_that_runs_into_the_loop_limit_is_done_again",
    ),
    Mutant(
        "AOVs that lost a channel are kept",
        (
            Edit(
                "glrt/image/aovs.py",
                "all(part is not None for part in rest)",
                "any(part is not None for part in rest)",
            ),
        ),
        "image/test_aovs.py::test_an_aov_that_lost_a_channel_is_left_out",
    ),
    Mutant(
        "the last bounce of a path is not counted",
        edit("integrators/samples.glsl", "float(path.depth)", "float(max(path.depth - 1, 0))"),
        "rendering/test_bounces_aov.py::test_no_path_ends_early_in_a_closed_room_without_roulette",
    ),
    Mutant(
        "a path that roulette ended counts the bounce that it did not take",
        edit(
            "integrators/path.glsl",
            "roulette_ends(path.throughput, rng)) return goes_on(END_BY_ROULETTE);",
            "roulette_ends(path.throughput, rng)) { path.depth += 1; return false; }",
        ),
        "rendering/test_bounces_aov.py::test_roulette_ends_as_many_as_their_chances_say",
    ),
    Mutant(
        "what is beyond the limit of bounces has colours of its own",
        (
            Edit(
                "glrt/rendering/aov_view.py",
                "float(min(max(limit, 1), MOST_BOUNCES))",
                "float(MOST_BOUNCES)",
            ),
        ),
        "rendering/test_bounces_aov.py::test_colours_reach_from_none_to_the_limit",
    ),
    Mutant(
        "dispatches of bounces are as large as those of camera rays",
        host("if is_of_paths else _rounds_of_rays", "if False else _rounds_of_rays"),
        "rendering/test_bounces_aov.py::test_what_is_beyond_the_loop_limit_is_refused_by_name",
    ),
]
