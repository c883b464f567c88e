"""The window used by hand, under an X server without a screen: what `tests/window` checks."""

import re
from collections.abc import Iterator

import pytest

from tests.support.drivers import OLD_DRIVER
from tests.support.processes import glrt
from tests.window.process import ROOT, CheckedWindow, names_of_checks

pytestmark = pytest.mark.timeout(600)  # of a machine that has other things to do as well
CHECKS = names_of_checks()
ON_OLD_DRIVERS = (
    "the_driver_decides_on_the_pipeline",
    "the_picture_never_goes_black",
    "a_drag_turns_by_its_share_of_the_window",
    "a_picture_is_saved_with_its_recipe_and_opened_again",
    "a_kept_picture_is_compared_by_a_wipe",
    "a_compilation_is_announced_while_the_old_picture_stays",
    "an_object_is_edited_in_the_panel",
    "views_cost_no_sample_and_have_a_legend",
    "paths_are_shown_or_refused_by_name",
)
SLOW = (  # half a second each, or more
    "a_ready_made_material_replaces_all_values",
    "a_checkbox_switches_each_effect_of_hybrid",
    "rows_end_below_the_bar",
    "the_panel_goes_to_the_paths_of_a_pixel_whatever_was_used_before",
    "wheel_and_keys_move_the_camera",
    "the_difference_is_white_where_nothing_changed",
    "cornell_gets_a_metal_ball_in_five_clicks",
    "an_added_lamp_is_dimmed_by_itself",
    "a_selection_is_outlined_copied_and_deleted_by_keys",
    "names_are_typed",
    "a_material_is_made_unique_new_and_removed",
    "one_of_two_lamps_gets_a_group_of_its_own",
    "figures_belong_to_the_picture_next_to_them",
    "dialogs_of_the_desktop_open_and_save",
    "a_scene_file_is_saved_by_its_key_with_its_comments",
    "the_panel_inspects",
    "keys_move_in_the_panel_and_change_its_widgets",
    "tooltips_wrap",
    "particles_come_by_a_control_and_are_relit",
    "bounces_are_tuned_live_and_shown_alone",
    "a_row_of_the_panel_reports_its_lamp",
    "a_wheel_that_spins_freely_stops_at_the_limits",
    "the_horizon_is_no_place_that_ends_the_window",
    "a_metal_of_a_colour_becomes_a_measured_one_and_back",
    "a_principled_surface_is_edited_live",
    "glass_is_tinted_and_nests",
    "a_list_reports_what_its_words_mean",
    "a_lamp_is_dimmed_where_it_is_edited",
    "an_object_is_edited_in_the_panel",
    "an_object_is_chosen_in_a_list_of_thousands_and_a_frame_does_not_go_through_them",
    "a_texture_is_turned",
    "a_lamp_becomes_a_spot_of_one_side_and_a_hidden_object_goes",
    "both_gather_at_equal_samples",
    "both_gather_in_equal_time",
    "the_pictures_are_those_of_renders_of_each_alone",
    "they_stand_side_by_side_or_behind_a_line",
    "they_are_swapped_and_b_comes_back_by_undo",
    "what_is_known_of_a_stands_next_to_what_is_known_of_b",
    "a_picture_that_is_kept_again_ends_the_one_before",
    "without_room_for_a_b_goes_on_alone",
    "samples_are_stepped_through_and_more_pixels_compile_nothing",
    "a_scene_that_changed_since_is_reported_and_a_camera_that_moved_is_not",
    "paths_are_stored_as_a_test",
    "particles_of_a_pixel_are_listed_apart_as_the_command_does",
    "a_scene_whose_particles_cannot_be_followed_is_reported",
    "escape_ends_the_choice_of_a_pixel_and_then_removes_its_paths",
    "preferences_are_kept_while_the_window_is_open",
    "a_lamp_over_probes_restarts_the_picture",
    "probes_are_shown_as_balls",
    "the_picture_never_goes_black",
    "an_image_of_the_sky_is_turned_and_tinted",
    "the_tour_has_five_steps_and_is_closed_for_ever",
    "bounces_until_the_end_are_shown_on_a_scale_and_reported_of_a_pixel",
    "counts_of_more_bounces_than_are_shown_are_labelled",
    "a_view_that_is_on_its_way_is_reported",
    "the_history_of_pixels_is_shown_while_it_counts",
    "a_shader_that_is_broken_on_disk_is_reported_and_the_old_kernel_goes_on",
    "what_was_opened_last_is_at_hand",
    "a_name_that_is_no_text_is_shown_and_kept",
    "every_control_costs_what_it_says",
    "the_picture_follows_sliders",
    "a_rest_and_its_end_show_in_no_bit",
    "preferences_are_chosen_and_restart_nothing",
    "a_model_that_is_dropped_is_added_or_opened",
    "the_picture_is_denoised_with_its_error_reported_and_saved_plain",
    "whatever_is_typed_into_a_field_ends_nothing",
    "a_drag_shows_the_plain_picture_until_it_is_denoised_again",
    "without_dialogs_of_the_desktop_the_window_draws_one",
    "a_scene_dropped_by_another_program_is_opened",
    "one_of_each_kind_is_added_and_undone",
    "probes_light_the_picture_of_the_method_ddgi",
    "a_walk_through_the_ceiling_is_reported_and_ended",
    "a_clear_sky_comes_with_its_sun_and_goes_without_a_change_of_it",
    "a_walk_goes_past_the_pivot_at_its_speed",
    "a_drag_too_noisy_to_read_shows_first_surfaces_and_says_so",
    "keys_that_move_in_the_panel_go_to_no_row_under_the_bar",
    "rows_of_a_narrow_panel_are_not_cut",
    "edits_are_not_lost_unasked",
    "a_scene_dropped_on_edits_is_opened_when_that_is_agreed",
    "keys_are_chosen_in_the_panel",
    "a_black_picture_has_figures",
    "the_picture_follows_the_handles",
    "buttons_and_boxes_of_the_scene_restart_it",
    "views_of_aovs_cost_no_sample_and_are_not_saved",
    "a_problem_stays_in_sight_while_the_panel_scrolls",
    "a_widget_stays_where_it_is_when_rows_come_and_go",
    "every_control_of_the_panel_is_moved_here",
    "probes_are_live_while_edits_follow_one_another",
    "a_walk_without_end_stops_at_the_limits",
    "the_figures_report_error_and_forecast",
    "points_are_reused_as_the_panel_says",
    "the_question_on_edits_lies_in_the_picture_and_is_answered_once",
    "arrow_keys_choose_a_row_and_a_click_elsewhere_closes_the_box",
    "a_drag_on_a_label_changes_a_value_in_one_step",
    "an_image_of_the_sky_dropped_by_another_program_lights_the_scene",
    "the_outline_fades_while_a_value_is_dragged_not_while_words_are_typed",
    "a_drag_on_the_label_of_a_colour_keeps_its_hue",
    "a_double_click_goes_back_to_the_value_of_the_scene",
    "the_screen_is_filled_and_nothing_is_lost_on_the_way_back",
    "a_row_selects_its_object_and_a_click_in_the_picture_its_row",
    "groups_fold_and_the_camera_leads_to_its_values",
    "the_eye_hides_an_object_and_undo_shows_it",
    "keys_walk_through_the_list_and_delete_from_it",
    "words_filter_the_list_also_if_the_panels_were_hidden",
    "a_frame_goes_through_the_rows_in_sight_alone",
    "a_grid_is_shown_by_colours_whose_knots_are_changed",
    "a_grid_is_chosen_for_the_fog_in_a_ball",
    "a_click_on_a_picture_opens_its_scene",
    "a_file_that_was_opened_lately_is_opened_again",
    "a_picture_of_another_size_is_exported_while_the_window_goes_on",
    "a_jpeg_is_exported_and_replaces_a_file_when_that_is_agreed",
    "an_export_is_cancelled_and_leaves_nothing",
    "a_film_of_a_turntable_is_exported",
    "what_is_wrong_with_an_export_is_said_where_it_is_typed",
    "the_box_fits_a_small_window",
    "an_image_dropped_on_an_object_becomes_its_color",
    "the_scene_is_seen_from_its_sides",
    "views_are_kept_and_come_back_by_digits",
    "cameras_of_a_file_are_in_the_menu",
    "undo_redo_and_pause_stand_in_the_bar_and_say_why_they_do_nothing",
)


@pytest.fixture(scope="module")
def window(display: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CheckedWindow]:
    checked = CheckedWindow(display, tmp_path_factory.mktemp("window"))
    yield checked
    assert checked.close() == 0


@pytest.fixture(scope="module")
def old_window(display: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CheckedWindow]:
    """The window on a driver without compute shaders."""
    checked = CheckedWindow(display, tmp_path_factory.mktemp("old-window"), **OLD_DRIVER)
    yield checked
    assert checked.close() == 0


def test_no_check_is_overlooked() -> None:
    """They are found by their text."""
    texts = [file.read_text() for file in (ROOT / "tests" / "window").glob("check_*.py")]
    assert len(set(CHECKS)) == sum(len(re.findall("^@check", text, re.M)) for text in texts) > 0


@pytest.mark.slow_cases(*SLOW)
@pytest.mark.parametrize("check", CHECKS)
def test_in_the_window(window: CheckedWindow, check: str) -> None:
    assert_well(window, check)


@pytest.mark.slow_cases(
    "the_driver_decides_on_the_pipeline",
    "the_picture_never_goes_black",
    "an_object_is_edited_in_the_panel",
    "views_cost_no_sample_and_have_a_legend",
)
@pytest.mark.parametrize("check", ON_OLD_DRIVERS)
def test_in_a_window_without_compute_shaders(old_window: CheckedWindow, check: str) -> None:
    assert_well(old_window, check)


def assert_well(window: CheckedWindow, check: str) -> None:
    """A check finds nothing wrong; otherwise the test fails with the check's own report."""
    trouble = window.trouble(check)
    if trouble:
        pytest.fail(trouble, pytrace=False)


def test_compute_shaders_that_are_asked_for_and_not_there_are_refused(display: str) -> None:
    arguments = "view", "cornell", "--pipeline", "compute"
    needed = glrt(*arguments, cwd=None, DISPLAY=display, **OLD_DRIVER)
    assert needed.returncode == 3
    assert "OpenGL 4.3" in needed.stderr
