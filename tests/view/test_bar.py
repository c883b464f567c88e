"""The panel while it scrolls: what stays in sight, and where rows stay; no window is opened."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from imgui_bundle import ImVec2, imgui

from glrt.view.state.preferences import Preferences, Tab
from glrt.view.tabs.bar import below_bar
from glrt.view.widgets.fields import button
from glrt.view.widgets.steady_widget import ANCHOR

SIZE = ImVec2(300.0, 200.0)
TOP = 36.0  # pixels, below the title of the window: in the line of the tabs
TABS: tuple[Tab, ...] = ("Scene", "Light")


class Panel:
    """A panel of 40 buttons: the button "used" stands behind some that come and go."""

    def __init__(self) -> None:
        context = imgui.create_context()
        self.io = imgui.get_io()
        self.io.display_size = ImVec2(600.0, 200.0)
        self.io.delta_time = 0.1
        self.io.backend_flags |= imgui.BackendFlags_.renderer_has_textures.value
        self.io.set_ini_filename("")
        self._context = context
        self.app: Any = SimpleNamespace(
            session=SimpleNamespace(problem=""), preferences=Preferences(), prefer=self._prefer
        )
        self.above, self.below = 10, 30
        self.places: dict[str, ImVec2] = {}  # of the upper left corners, on the screen
        self.pressed: list[str] = []
        self.scroll = 0.0
        self.goes_to = ""
        ANCHOR.forget()
        self.frame(2)

    def _prefer(self, preferences: Preferences) -> None:
        self.app.preferences = preferences

    def frame(self, count: int = 1, scroll: float | None = None) -> None:
        for _ in range(count):
            imgui.new_frame()
            imgui.set_next_window_pos(ImVec2(0.0, 0.0))
            imgui.set_next_window_size(SIZE)
            imgui.begin("Controls")
            if scroll is not None:
                imgui.set_scroll_y(scroll)
            with below_bar(self.app, TABS):
                for number in range(self.above):
                    self._row(f"above {number}")
                self._row("used")
                for number in range(self.below):
                    self._row(f"below {number}")
            ANCHOR.keep()
            self.scroll = imgui.get_scroll_y()
            imgui.end()
            imgui.render()

    def _row(self, name: str) -> None:
        if name == self.goes_to:
            ANCHOR.go_here()
            self.goes_to = ""
        if button(f"{name}: as wide as the panel, more or less"):
            self.pressed.append(name)
        self.places[name] = imgui.get_item_rect_min()

    def click(self, x: float, y: float) -> None:
        self.io.add_mouse_pos_event(x, y)
        self.frame(2)
        for is_down in (True, False):
            self.io.add_mouse_button_event(0, is_down)
            self.frame(2)

    def use(self) -> float:
        """Click the button "used"; where it is."""
        at = self.places["used"]
        self.click(at.x + 5, at.y + 5)
        assert self.pressed == ["used"]
        return float(at.y)

    def end(self) -> None:
        ANCHOR.forget()
        imgui.destroy_context(self._context)


def bar_end_of_panel() -> float:
    """Where the bar ends, in pixels from the upper edge of the screen and of the panel."""
    window = imgui.internal.find_window_by_name("Controls")
    return float(window.deco_outer_size_y1 + window.deco_inner_size_y1)


@pytest.fixture
def panel() -> Iterator[Panel]:
    panel = Panel()
    yield panel
    panel.end()


@pytest.mark.parametrize("scroll", [0.0, 100.0, 1e6])
def test_a_problem_stays_where_it_is_and_rows_end_below_it(panel: Panel, scroll: float) -> None:
    """A click where its button stands dismisses it, though a row lies there, too."""
    panel.app.session.problem = "wrong"
    panel.frame(3)
    top = panel.places["above 0"].y
    panel.frame(3, scroll)
    panel.frame(2)
    assert (panel.scroll > 0) == (scroll > 0)
    for place in list(panel.places.values()):
        if 0 < place.y < top - 12:
            panel.click(200.0, place.y + 8)
    assert panel.pressed == []
    first = min(place.y for place in panel.places.values() if place.y >= top)
    panel.click(200.0, first + 5)
    assert len(panel.pressed) == 1, "but rows below it are"
    panel.click(20.0, top - 16)
    assert panel.app.session.problem == ""
    assert len(panel.pressed) == 1


def test_a_click_on_a_tab_chooses_it(panel: Panel) -> None:
    panel.frame(2)
    style = imgui.get_style()
    names = [imgui.calc_text_size(tab).x + 2 * style.frame_padding.x for tab in TABS]
    panel.click(style.window_padding.x + names[0] + style.item_spacing.x + 5, TOP)
    assert panel.app.preferences.tab == "Light"
    panel.click(style.window_padding.x + 5, TOP)
    assert panel.app.preferences.tab == "Scene"


def test_keys_and_scrolls_know_where_the_bar_ends(panel: Panel) -> None:
    end = bar_end_of_panel()
    assert abs(panel.places["above 0"].y - end) < 1


@pytest.mark.parametrize("above", [14, 7])
def test_the_row_that_is_used_stays_when_others_come_and_go(panel: Panel, above: int) -> None:
    panel.frame(3, 150.0)
    panel.frame(2)
    before = panel.use()
    panel.above = above
    panel.frame(3)
    assert panel.places["used"].y == before


def test_a_row_stays_where_nothing_is_left_to_scroll_until_the_mouse_is_elsewhere(
    panel: Panel,
) -> None:
    panel.above = 3
    panel.frame(2)
    first, before = panel.places["above 0"].y, panel.use()
    panel.above = 1
    panel.frame(3)
    assert panel.places["used"].y == before
    panel.io.add_mouse_pos_event(500.0, 100.0)
    panel.frame(3)
    assert panel.places["above 0"].y == first


def test_room_above_goes_once_it_is_scrolled_out_of_sight(panel: Panel) -> None:
    panel.above = 3
    panel.frame(2)
    first = panel.places["above 0"].y
    panel.use()
    panel.above = 1
    panel.frame(3)
    assert panel.places["above 0"].y > first
    panel.frame(2, 90.0)
    before = panel.places["below 3"].y
    panel.frame(3)
    assert panel.places["below 3"].y == before
    panel.frame(3, 0.0)
    panel.frame(2)
    assert panel.places["above 0"].y == first


def test_a_row_is_not_kept_under_a_bar_that_grows(panel: Panel) -> None:
    """The bar shows what went wrong; a row in use that is lower stays."""
    panel.frame(3, 150.0)
    panel.frame(2)
    before = panel.use()
    panel.app.session.problem = "wrong"
    panel.frame(4)
    assert panel.places["used"].y == before
    panel.app.session.problem = "wrong\n" * 5
    panel.frame(4)
    end = bar_end_of_panel()
    assert panel.places["used"].y >= end


def test_the_panel_goes_to_what_is_to_be_seen_whatever_was_used_before(panel: Panel) -> None:
    """Though rows come above what was used, which is not kept in its place then."""
    end = panel.places["above 0"].y
    panel.frame(3, 150.0)
    panel.frame(2)
    panel.use()
    panel.above, panel.goes_to = 14, "above 4"
    panel.frame(4)
    assert panel.places["above 4"].y == end


def test_widgets_of_other_parts_are_not_held(panel: Panel) -> None:
    """The bar's own neither: it has no place among the rows."""
    panel.frame(3, 150.0)
    panel.frame(2)
    panel.app.session.problem = "wrong"
    panel.frame(3)
    before = panel.use()
    panel.click(20.0, bar_end_of_panel() - 16)
    assert panel.app.session.problem == ""
    panel.above = 14
    panel.frame(3)
    assert panel.places["used"].y == before
