"""The panel in tabs: what opens each, and what is kept of it."""

import json

from imgui_bundle import imgui

from glrt.view.controls import replaced
from glrt.view.state.preferences import load_preferences
from glrt.view.tabs.sections import TABS
from tests.window.check_newcomer import SMALLEST
from tests.window.check_toolbar import sized
from tests.window.gestures import ball, click, press
from tests.window.hand import Hand, check

CTRL = imgui.Key.mod_ctrl.value
_QUIETLY = int(imgui.test_engine.TestOpFlags_.no_error)


def has(hand: Hand, title: str) -> bool:
    """Whether a part is drawn; a part that is not has no place in the panel."""
    return bool(hand.ctx.item_info(f"//Controls/{title}", _QUIETLY).id_)


@check
def a_click_on_a_tab_shows_its_parts_alone(hand: Hand) -> None:
    app = hand.window.app
    for tab, parts in TABS.items():
        hand.ctx.item_click(f"//Controls/{tab}##tab")
        hand.ctx.yield_(3)
        assert app.preferences.tab == tab
        shown = {part.title for other in TABS.values() for part in other if has(hand, part.title)}
        assert shown == {part.title for part in parts}


@check
def an_object_that_is_selected_opens_the_tab_of_the_scene(hand: Hand) -> None:
    app, (number, shape) = hand.window.app, ball(hand)
    hand.turn_to("Compare")
    click(hand, shape.center)
    hand.ctx.yield_(3)
    assert (app.selected, app.preferences.tab) == (number, "Scene")
    hand.turn_to("Compare")
    hand.ctx.yield_(5)
    assert app.preferences.tab == "Compare", "it can be left"
    app.selected = None


@check
def a_control_that_is_found_by_words_opens_its_tab(hand: Hand) -> None:
    app = hand.window.app
    press(hand, imgui.Key.k, CTRL)
    hand.ctx.key_chars("gradient")
    hand.ctx.yield_(3)
    press(hand, imgui.Key.enter)
    hand.ctx.yield_(4)
    assert app.preferences.tab == "Light"
    assert has(hand, "gradient")


@check
def the_next_start_has_the_same_tab_and_folded_parts(hand: Hand) -> None:
    app, file = hand.window.app, hand.window.app.preferences_file
    hand.ctx.item_click("//Controls/Light##tab")
    hand.ctx.yield_(3)
    hand.ctx.item_close("//Controls/Sun")
    hand.until(lambda: json.loads(file.read_text()).get("folded") == ["Sun"])
    kept, problem = load_preferences(file)
    assert (kept.tab, kept.folded, problem) == ("Light", ("Sun",), "")
    hand.there(lambda: app.prefer(replaced(kept, tab="Light", folded=("Lamps", "Sun"))))
    hand.ctx.yield_(3)
    assert not has(hand, "intensity##lamp"), "as it was kept"
    hand.ctx.item_open("//Controls/Lamps")
    hand.ctx.yield_(2)
    assert has(hand, "intensity##lamp")
    assert app.preferences.folded == ("Sun",)


@check
def each_tab_stays_where_it_was_scrolled(hand: Hand) -> None:
    with sized(hand, SMALLEST):
        hand.turn_to("Window")
        hand.ctx.scroll_to_bottom("//Controls")
        hand.ctx.yield_(3)
        panel = hand.ctx.window_info("//Controls").window
        place = panel.scroll.y
        assert place > 0
        hand.turn_to("Compare")
        assert panel.scroll.y == 0
        hand.turn_to("Window")
        assert abs(panel.scroll.y - place) < 2
