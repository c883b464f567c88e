"""Bugs of probes that go on from picture to picture, of their balls, and of what they cost."""

from tests.mutation.mutant import Edit, Mutant, edit

LIVE, BALLS, WINDOW, WORK = (
    "rendering/test_live_probes.py",
    "rendering/test_probe_balls.py",
    "view/test_live_probes.py",
    "analysis/test_probe_work.py",
)
TRACER, SUPPLY = "glrt/rendering/probe_tracer.py", "glrt/rendering/probe_supply.py"
SESSION = "glrt/view/state/session.py"
CANDIDATE = "glrt/analysis/method_choice/candidate.py"

LIVE_PROBES = [
    Mutant(
        "live probes keep the share of what is new",
        (Edit(SUPPLY, "tracer.follow(self.hysteresis)", "tracer.follow(1 - self.hysteresis)"),),
        f"{LIVE}::test_light_follows_a_step_by_what_each_update_keeps",
    ),
    Mutant(
        "live probes stay where others were of use",
        (Edit(TRACER, "if not self._is_placed:", "if False:"),),
        f"{LIVE}::test_places_and_distances_follow_what_is_moved",
    ),
    Mutant(
        "live probes see what was there before",
        (Edit(TRACER, "self._see(FOLLOWING, self._done, kept=hysteresis)", "pass"),),
        f"{LIVE}::test_places_and_distances_follow_what_is_moved",
    ),
    Mutant(
        "a picture of its own goes on with the probes of the one before",
        (
            Edit(
                SUPPLY,
                "hysteresis is not None\n            self.tracer",
                "True\n            self.tracer",
            ),
        ),
        f"{LIVE}::test_a_picture_begins_with_probes_of_its_own",
    ),
    Mutant(
        "a picture by live probes is handed out",
        (
            Edit(
                SUPPLY,
                "if self.tracer and self.hysteresis is not None:\n            raise",
                "if False:\n            raise",
            ),
        ),
        f"{LIVE}::test_a_picture_by_live_probes_is_not_handed_out",
    ),
    Mutant(
        "live probes are updated for each block of samples",
        (
            Edit(
                SUPPLY, "return self._is_due and self.tracer.is_used", "return self.tracer.is_used"
            ),
        ),
        f"{WINDOW}::test_probes_go_on_while_edits_follow_one_another",
    ),
    Mutant(
        "a camera that moves makes the light of probes old",
        (Edit(SUPPLY, 'update={"camera": plan.scene.camera}', "update={}"),),
        f"{WINDOW}::test_a_walk_of_the_camera_changes_no_light",
    ),
    Mutant(
        "live probes go on at rest",
        (
            Edit(
                SESSION,
                "self.live.kept(self.settings, self._preview.is_under_way)",
                "self.live.kept(self.settings, True)",
            ),
        ),
        f"{WINDOW}::test_at_rest_the_picture_is_one_of_its_own",
    ),
    Mutant(
        "balls of probes are upside down",
        edit("probe_balls.vert", "vec4(place.x, -place.y, 0.0, 1.0)", "vec4(place, 0.0, 1.0)"),
        f"{BALLS}::test_balls_stand_on_their_side",
    ),
    Mutant(
        "balls of probes shine through what stands before them",
        edit("probe_balls.frag", "away > behind.r)", "away > 1e9 * behind.r)"),
        f"{BALLS}::test_what_is_nearer_hides_balls",
    ),
    Mutant(
        "a ball ends where its middle plane does",
        edit(
            "probe_balls.frag",
            "precise float root = b * b - a * (dot(middle, middle) - radius * radius);",
            "precise float root = b * b - a * dot(middle, middle) * (1.0 - radius * radius"
            " / (dot(middle, middle) + radius * radius));",
        ),
        f"{BALLS}::test_a_ball_is_as_large_as_it_looks",
    ),
    Mutant(
        "far balls are drawn over near ones",
        (Edit("glrt/rendering/probe_balls.py", "np.argsort(-away)", "np.argsort(away)"),),
        f"{BALLS}::test_distances_are_those_to_what_is_around",
    ),
    Mutant(
        "balls of probes show irradiance",
        edit(
            "probe_balls.frag",
            "light_at_probe(probe, normal) / PI",
            "light_at_probe(probe, normal)",
        ),
        f"{BALLS}::test_a_ball_shows_what_its_probe_holds",
    ),
    Mutant(
        "rays from probes are not counted",
        edit("probe_rays.comp", "if (COUNT_RAYS) found.rgb = vec3(rays_so_far);", ""),
        f"{WORK}::test_rays_of_probes_are_counted",
    ),
    Mutant(
        "one set of probes lights all samples of a candidate",
        (Edit(CANDIDATE, "return math.ceil(samples / self.settings.block)", "return 1"),),
        f"{WORK}::test_work_of_probes_is_shared_by_pixels_and_blocks",
    ),
]
