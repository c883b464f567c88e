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


@pytest.fixture(scope="module")
def window(display: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CheckedWindow]:
    checked = CheckedWindow(display, tmp_path_factory.mktemp("window"))
    yield checked
    assert checked.close() == 0


@pytest.fixture(scope="module")
def old_window(display: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[CheckedWindow]:
    """On a driver without compute shaders."""
    checked = CheckedWindow(display, tmp_path_factory.mktemp("old-window"), **OLD_DRIVER)
    yield checked
    assert checked.close() == 0


def test_no_check_is_overlooked() -> None:
    """They are found by their text."""
    texts = [file.read_text() for file in (ROOT / "tests" / "window").glob("check_*.py")]
    assert len(set(CHECKS)) == sum(len(re.findall("^@check", text, re.M)) for text in texts) > 0


@pytest.mark.parametrize("check", CHECKS)
def test_in_the_window(window: CheckedWindow, check: str) -> None:
    assert_well(window, check)


@pytest.mark.parametrize("check", ON_OLD_DRIVERS)
def test_in_a_window_without_compute_shaders(old_window: CheckedWindow, check: str) -> None:
    assert_well(old_window, check)


def assert_well(window: CheckedWindow, check: str) -> None:
    """A check finds nothing wrong; what it does find is shown as it is told."""
    trouble = window.trouble(check)
    if trouble:
        pytest.fail(trouble, pytrace=False)


def test_compute_shaders_that_are_asked_for_and_not_there_are_refused(display: str) -> None:
    arguments = "view", "cornell", "--pipeline", "compute"
    needed = glrt(*arguments, cwd=None, DISPLAY=display, **OLD_DRIVER)
    assert needed.returncode == 3
    assert "OpenGL 4.3" in needed.stderr
