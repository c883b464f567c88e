"""Bugs of what the window edits, saves and draws over the picture."""

from tests.mutation.merging import bug
from tests.mutation.mutant import Mutant

_OUTLINE = "view/viewport/outline.py"
_EDITS = "view/state/scene_edits.py"
_LISTS = "scene/toml_lists.py"
_NAMES = "scene/names.py"
_VIEW = "view/viewport/picture_view.py"
_BAR, _BAR_TEST = "view/panels/bar.py", "view/test_bar.py"
_ANCHOR = "view/panels/anchor.py"
_BLACK, _BLACK_TEST = "view/viewport/black.py", "view/test_black.py"
_REFUSED = "view/test_refused_views.py"

EDITOR: list[Mutant] = [
    bug(
        "neighbours that are turned over part an outline",
        _OUTLINE,
        "((first != second) != faces.turned)",
        "(first != second)",
        "view/test_outline.py::test_faces_that_are_turned_over_change_nothing",
    ),
    bug(
        "seams of a mesh are outlined",
        _OUTLINE,
        "same: NDArray[np.intp] = first[which.reshape(-1)]",
        "same: NDArray[np.intp] = np.arange(len(which.reshape(-1)))",
        "view/test_outline.py::test_seams_of_a_mesh_are_no_rims",
    ),
    bug(
        "a ball is outlined by its equator",
        _OUTLINE,
        "share = radius**2 / square",
        "share = 0.0 * radius",
        "view/test_outline.py::test_rays_just_inside_meet_the_object_and_rays_just_outside_do_not",
    ),
    bug(
        "an object that goes leaves its comment to the next",
        _LISTS,
        'while start and lines[start - 1].lstrip().startswith("#"):',
        "while False:",
        "scene/test_toml_lists.py::test_an_object_that_goes_takes_its_comment_and_no_other",
    ),
    bug(
        "a material that is renamed loses the intensity of its light",
        _EDITS,
        "        lights[new] = lights.pop(old)\n",
        "        lights.pop(old)\n",
        "view/test_scene_edits.py::test_a_renamed_material_keeps_its_objects_place_and_intensity",
    ),
    bug(
        "metal that was a lamp shines on",
        _EDITS,
        'if not material.emits or material.type == "light":',
        "if not material.emits:",
        "view/test_scene_edits.py::test_another_type_of_material_keeps_what_both_have",
    ),
    bug(
        "what comes back by undo is not selected",
        _EDITS,
        "return new[0] if len(after) == len(before) + 1 and len(new) == 1 else None",
        "return None if new else None",
        "view/test_scene_edits.py::test_what_was_selected_is_found_again",
    ),
    bug(
        "the wheel zooms about the middle",
        "view/state/zoom.py",
        "share = (at[0] - left) / width, (at[1] - top) / height",
        "share = (room[0] / 2 - left) / width, (room[1] / 2 - top) / height",
        "view/test_zoom.py::test_what_is_under_the_mouse_stays_there",
    ),
    bug(
        "the values of a pixel are those of another row",
        "rendering/weighting.py",
        "row = film.read(slice(y, y + 1))",
        "row = film.read(slice(max(y - 1, 0), max(y, 1)))",
        "rendering/test_reading.py::test_each_pixel_is_read_as_it_is_in_the_picture",
    ),
    bug(
        "a lamp that is hidden is drawn as seen",
        "view/viewport/path_lines.py",
        '"hidden" if light.hidden else "sampled"',
        '"sampled"',
        "view/test_path_lines.py::test_sampled_points_are_as_far_as_they_are",
    ),
    bug(
        "another name restarts the picture",
        _NAMES,
        "    if _are_named_alike(first, second):",
        "    if first is not None:",
        "rendering/test_renamed.py::test_other_names_lose_no_sample",
    ),
    bug(
        "two light groups that become one are taken for a name",
        _NAMES,
        "groups[group] if group else thing.group",
        "None",
        "rendering/test_renamed.py::test_what_is_more_than_a_name_is_told_apart",
    ),
    bug(
        "the order of materials is taken for names",
        _NAMES,
        "for number, name in enumerate(scene.materials)}",
        "for number, name in enumerate(sorted(scene.materials))}",
        "rendering/test_renamed.py::test_what_is_more_than_a_name_is_told_apart",
    ),
    bug(
        "intensities of light groups are lost with their names",
        _NAMES,
        "for name, value in scene.lights.items()}",
        "for name, value in ()}",
        "rendering/test_renamed.py::test_light_is_weighed_on_under_other_names",
    ),
    bug(
        "a particle is linked to its lamp and not to the camera",
        "view/viewport/path_lines.py",
        'Line(places[at], np.array(eye), "linked")',
        'Line(places[at], places[0], "linked")',
        "view/test_path_lines.py::test_a_particle_is_linked_to_the_camera_from_where_it_was_seen",
    ),
    bug(
        "a picture that is waited for gets a small share of a frame",
        _VIEW,
        "is_alone = session.is_done or session.waits",
        "is_alone = session.is_done",
        "view/test_reference_image.py::test_a_picture_that_is_waited_for_gets_long_turns",
    ),
    bug(
        "a refusal outlives the edit that it was of",
        _VIEW,
        "session.aovs, session.refused = gathered_for(self.view), ()",
        "session.aovs = gathered_for(self.view)",
        f"{_REFUSED}::test_a_refused_view_is_given_up_and_had_once_the_edit_is_undone",
    ),
    bug(
        "a refused view is not given up",
        _VIEW,
        "if session.refused and session.refused == gathered_for(self.view):",
        "if session.refused != session.refused:",
        f"{_REFUSED}::test_a_refused_view_is_given_up_and_had_once_the_edit_is_undone",
    ),
    bug(
        "a chord whose Ctrl is let go within a slow frame is a step",
        "view/panels/shortcuts.py",
        "if down[name] or any(imgui.is_key_released(key) for key in keys)",
        "if down[name] and keys",
        "view/test_viewport.py::test_a_chord_that_ends_within_a_slow_frame_is_no_step",
    ),
    bug(
        "a key that stays down after its chord makes steps",
        "view/panels/shortcuts.py",
        'app.is_deaf = "ctrl" in modifiers()',
        "app.is_deaf = False",
        "view/test_viewport.py::test_a_chord_that_ends_within_a_slow_frame_is_no_step",
    ),
    bug(
        "a copy lies where its original does",
        "view/viewport/transform.py",
        "step = max(_CLEAR * height, least)",
        "step = 0.0 * max(_CLEAR * height, least)",
        "view/test_duplicates.py::test_a_copy_of_a_solid_stands_clear_of_it_towards_the_pivot",
    ),
    bug(
        "a copy of what hangs high goes higher",
        "view/viewport/transform.py",
        "-step if shape.middle[1] > pivot[1] else step",
        "step",
        "view/test_duplicates.py::test_a_copy_of_a_solid_stands_clear_of_it_towards_the_pivot",
    ),
    bug(
        "undo tells of each object what was a new name of their material",
        "view/state/changes.py",
        "renamed.get(old.material, old.material)",
        "old.material",
        "view/test_changes.py::test_a_renamed_material_is_told_and_not_each_of_its_objects",
    ),
    bug(
        "an object that is deleted is told as the one that moved up",
        "view/state/changes.py",
        "return came if len(after) > len(before) else gone",
        "return came or [name_of(after[-1])]",
        "view/test_changes.py::test_an_edit_is_told_in_a_few_words",
    ),
    bug(
        "counts of bounces pass for those of a lower limit",
        "view/state/costs.py",
        "return renderer.plan.settings.bounces if renderer else session.settings.bounces",
        "return session.settings.bounces",
        "view/test_costs.py::test_the_limit_that_was_traced_is_told_while_fewer_bounces_are_shown",
    ),
    bug(
        "undo and pause scroll away with the rows",
        _BAR,
        "imgui.set_cursor_pos_y(start.y + imgui.get_scroll_y())",
        "imgui.set_cursor_pos_y(start.y)",
        f"{_BAR_TEST}::test_commands_stay_where_they_are_and_rows_end_below_them",
    ),
    bug(
        "rows are clicked through the bar above them",
        _BAR,
        "panel.pos.y + end), clip.max",
        "panel.pos.y), clip.max",
        f"{_BAR_TEST}::test_commands_stay_where_they_are_and_rows_end_below_them",
    ),
    bug(
        "keys that move in the panel go to rows under the bar",
        _BAR,
        "panel.deco_inner_size_y1 = end - panel.deco_outer_size_y1",
        "panel.deco_inner_size_y1 = 0.0",
        f"{_BAR_TEST}::test_keys_and_scrolls_know_where_the_bar_ends",
    ),
    bug(
        "a row at the top of the panel jumps when others above it go",
        _ANCHOR,
        "room = -wanted if wanted < 0 else",
        "room = 0.0 if wanted < 0 else",
        f"{_BAR_TEST}::"
        "test_a_row_stays_where_nothing_is_left_to_scroll_until_the_mouse_is_elsewhere",
    ),
    bug(
        "the row in use is kept under a bar that has grown",
        _ANCHOR,
        "return min(moved, below) if below >= 0 else moved",
        "return moved",
        f"{_BAR_TEST}::test_a_row_is_not_kept_under_a_bar_that_grows",
    ),
    bug(
        "the panel stays at what was used when something else is to be seen",
        _ANCHOR,
        "self._lead, 0.0))\n        self.forget()",
        "self._lead, 0.0))",
        f"{_BAR_TEST}::test_the_panel_goes_to_what_is_to_be_seen_whatever_was_used_before",
    ),
    bug(
        "a button of the bar is held as a row",
        _ANCHOR,
        "        if not self._has_rows:\n            return\n",
        "",
        f"{_BAR_TEST}::test_widgets_of_other_parts_are_not_held",
    ),
    bug(
        "a camera on one side of an object is taken for one inside",
        _BLACK,
        "for sign in (1.0, -1.0)]",
        "for sign in (1.0,)]",
        f"{_BLACK_TEST}::test_an_object_around_the_camera_is_known",
    ),
    bug(
        "a material of no object counts as light",
        _BLACK,
        "if group in groups)",
        "if group or groups)",
        f"{_BLACK_TEST}::test_the_reason_is_told",
    ),
    bug(
        "a picture that is dim is said to have no light",
        _BLACK,
        "if renderer.picture(session.weights)[0].max() > FAINT:",
        "if False:",
        f"{_BLACK_TEST}::test_the_reason_is_told",
    ),
    bug(
        "rounding at the rim of two walls is said to be light",
        _BLACK,
        "FAINT = 1e-7",
        "FAINT = 0.0",
        f"{_BLACK_TEST}::test_light_that_no_exposure_shows_is_none",
    ),
    bug(
        "a picture of few samples is not looked at when it is complete",
        _BLACK,
        "session.is_done and session.samples != self._seen",
        "False",
        f"{_BLACK_TEST}::test_the_reason_is_told",
    ),
    bug(
        "a walk comes to a halt before the pivot",
        "view/camera_moves.py",
        "self.pivot = orbit.carried(self.pivot, before, self.camera)",
        "orbit.carried(self.pivot, before, self.camera)",
        "view/test_walking.py::test_a_walk_keeps_its_speed_and_the_distance_to_the_pivot",
    ),
]
