"""Bugs of probes: their maps, what they leave out, their weights, and where they stand."""

from tests.mutation.mutant import Edit, Mutant, edit

MAPS, TRUTHS, GRID = (
    "shaders/test_probe_maps.py",
    "truths/test_probes.py",
    "methods/test_probe_grid.py",
)
HOST = "glrt/rendering/probe_tracer.py"

PROBES = [
    Mutant(
        "the border of a map of directions repeats the row beside it as it is",
        edit(
            "probes/octahedron.glsl",
            "texel = ivec2(side + 1 - texel.x, clamp(texel.y, 1, side));",
            "texel = ivec2(texel.x, clamp(texel.y, 1, side));",
        ),
        f"{MAPS}::test_a_border_repeats_what_lies_beyond_the_fold",
    ),
    Mutant(
        "irradiance of probes lacks its cosine",
        edit(
            "probe_light.comp",
            "dot(directions[i].xyz, normal)",
            "dot(directions[i].xyz, normal) > 0.0 ? 1.0 : 0.0",
        ),
        f"{TRUTHS}::test_irradiance_over_a_floor_is_a_half_space",
    ),
    Mutant(
        "probes count the lamps that they see, which direct light has",
        edit("integrators/path_state.glsl", "if (FROM_PROBES && length == 0) return;", ""),
        f"{TRUTHS}::test_as_many_bounces_as_probes_bring_one_of_are_exact_in_a_closed_room",
    ),
    Mutant(
        "the hysteresis of probes is the share of what is new",
        edit(
            "probes/blend.glsl",
            "mean + kept * (before - mean)",
            "before + kept * (mean - before)",
        ),
        f"{TRUTHS}::test_maps_settle_by_their_hysteresis",
    ),
    Mutant(
        "Chebyshev's bound holds for what is nearer than the mean",
        edit(
            "probes/query.glsl",
            "if (distance <= moments.x) return 1.0;",
            "if (distance >= moments.x) return 1.0;",
        ),
        f"{MAPS}::test_visibility_is_the_cube_of_chebyshevs_bound",
    ),
    Mutant(
        "the bias of probes goes along the normal more than to the eye",
        edit(
            "probes/query.glsl",
            "(BIAS_TO_NORMAL * normal + (1.0 - BIAS_TO_NORMAL) * wo)",
            "(BIAS_TO_NORMAL * wo + (1.0 - BIAS_TO_NORMAL) * normal)",
        ),
        f"{MAPS}::test_light_is_looked_up_before_a_surface_towards_the_eye",
    ),
    Mutant(
        "outer faces are taken for inner ones",
        edit("probes/solids.glsl", "dot(direction, normal) > 0.0", "dot(direction, normal) < 0.0"),
        f"{TRUTHS}::test_a_probe_deep_in_a_solid_is_of_no_use",
    ),
    Mutant(
        "rays leave from where a probe stood before it was pushed",
        edit(
            "probe_rays.comp",
            "middle_of_cell(probe) + place_of_probe(probe).xyz",
            "middle_of_cell(probe)",
        ),
        f"{TRUTHS}::test_a_probe_in_a_small_ball_is_pushed_out_of_it",
    ),
    Mutant(
        "a set of probes begins with the light of the one before",
        (Edit(HOST, '_clear(self.maps["probe_light"])', "pass"),),
        f"{TRUTHS}::test_the_picture_of_other_samples_at_once_has_the_same_bits",
    ),
    Mutant(
        "probes light each other in pictures of two bounces",
        edit(
            "probes/query.glsl", "path.depth + 2 > frame.bounces", "path.depth + 1 > frame.bounces"
        ),
        f"{TRUTHS}::test_as_many_bounces_as_probes_bring_one_of_are_exact_in_a_closed_room",
    ),
    Mutant(
        "of two probes the far one counts more",
        edit(
            "probes/query.glsl",
            "corner[i] == 1 ? beyond[i] : 1.0 - beyond[i]",
            "corner[i] == 0 ? beyond[i] : 1.0 - beyond[i]",
        ),
        "truths/test_probe_fields.py::test_light_of_probes_is_a_mean_without_edges_at_cells",
    ),
    Mutant(
        "probes light what they do not see",
        edit(
            "probes/query.glsl",
            "weight *= chance_seen(distances_at_probe(probe, from_probe), distance);",
            "weight *= 1.0;",
        ),
        f"{TRUTHS}::test_a_dark_room_stays_dark_behind_a_thick_wall",
    ),
    Mutant(
        "a direction of the map of distances hears of a wider cone",
        edit("probes/blend.glsl", "x16 * x16 * x16 * x2", "x2"),
        f"{TRUTHS}::test_distances_in_a_ball_are_those_of_its_chords",
    ),
    Mutant(
        "probes warm up by equal weights",
        (Edit(HOST, "1 - WEIGHTS[update] if averaged < 0", "0.5 if averaged < 0"),),
        f"{TRUTHS}::test_a_closed_room_has_the_light_of_all_bounces",
    ),
    Mutant(
        "the first probes stand in the walls of the box",
        (
            Edit(
                "glrt/methods/probe_grid.py",
                "return self.low + self.cell / 2",
                "return self.low",
            ),
        ),
        f"{GRID}::test_the_box_of_the_scene_file_is_divided_into_cells",
    ),
    Mutant(
        "a gather asks probes at the first matte surface",
        edit(
            "integrators/path_state.glsl",
            "asks_probes = !FINAL_GATHER || FROM_PROBES;",
            "asks_probes = true;",
        ),
        f"{TRUTHS}::test_a_matte_surface_in_a_mirror_is_the_first_one_of_a_gather",
    ),
    Mutant(
        "rays from probes of a gather gather, too",
        edit(
            "integrators/path_state.glsl",
            "asks_probes = !FINAL_GATHER || FROM_PROBES;",
            "asks_probes = !FINAL_GATHER;",
        ),
        f"{TRUTHS}::test_a_closed_room_has_the_light_of_all_bounces",
    ),
    Mutant(
        "probes of a gather light each other one bounce too early",
        (Edit(HOST, " - METHODS[plan.settings.method].gathers", ""),),
        f"{TRUTHS}::test_as_many_bounces_as_probes_bring_one_of_are_exact_in_a_closed_room",
    ),
    Mutant(
        "a mirror is the first surface of a gather",
        edit(
            "probes/query.glsl",
            "if (vertex.material.kind != MATTE || path.depth + 2 > frame.bounces) return;",
            "if (path.depth > 0) path.asks_probes = true;\n"
            "    if (vertex.material.kind != MATTE || path.depth + 2 > frame.bounces) return;",
        ),
        f"{TRUTHS}::test_a_matte_surface_in_a_mirror_is_the_first_one_of_a_gather",
    ),
]
