"""Parts stay in sight while the panel scrolls, and rows in use stay where they are."""

from typing import Any

from imgui_bundle import imgui

from glrt.view.tabs.sections import TABS
from tests.window.check_layout import resized
from tests.window.check_newcomer import SMALLEST
from tests.window.check_toolbar import sized
from tests.window.gestures import ball, press, retype, scroll_to
from tests.window.hand import Hand, check

PANEL = "//Controls"
ROW = "bounces"  # the first of its tab
PROBLEM = "Something went wrong."


def panel_of(hand: Hand) -> Any:
    return hand.ctx.window_info(PANEL).window


def place_of(hand: Hand, row: str) -> float:
    """The upper edge of a row, in pixels from that of the window."""
    return float(hand.ctx.item_info(f"{PANEL}/{row}").rect_full.min.y)


def scrolled_down(hand: Hand) -> float:
    """Scroll to the end of the panel, and return how far."""
    hand.ctx.scroll_to_bottom(PANEL)
    hand.ctx.yield_(3)
    return float(panel_of(hand).scroll.y)


def size_of(hand: Hand) -> tuple[int, int]:
    """Width and height of the window, in pixels."""
    width, height = hand.there(lambda: tuple(imgui.get_io().display_size))
    return int(width), int(height)


def refuse(hand: Hand, problem: str) -> None:
    """Make the window show a problem."""
    hand.there(lambda: setattr(hand.session, "problem", problem))
    hand.ctx.yield_(4)


@check
def a_problem_stays_in_sight_while_the_panel_scrolls(hand: Hand) -> None:
    with sized(hand, SMALLEST):
        hand.turn_to("Render")
        refuse(hand, PROBLEM)
        place = place_of(hand, "dismiss")
        scroll = scrolled_down(hand)
        assert scroll > 0
        assert place_of(hand, "dismiss") == place
        hand.ctx.item_click(f"{PANEL}/dismiss")
        assert not hand.session.problem
        assert panel_of(hand).scroll.y > 0


@check
def rows_end_below_the_bar(hand: Hand) -> None:
    """A row scrolled below the bar is neither seen nor clicked through it."""
    ctx, panel, usual = hand.ctx, panel_of(hand), size_of(hand)
    resized(hand, SMALLEST)
    hand.turn_to("Render")
    refuse(hand, PROBLEM)
    ctx.scroll_to_top(PANEL)
    ctx.yield_(2)
    on = place_of(hand, ROW) - place_of(hand, "dismiss")
    hand.there(lambda: imgui.internal.set_scroll_y(panel, on))
    ctx.yield_(3)
    row, button = (ctx.item_info(f"{PANEL}/{name}") for name in (ROW, "dismiss"))
    assert abs(row.rect_full.min.y - button.rect_full.min.y) < 2, "it lies where the button is"
    before = hand.session.state
    ctx.mouse_move_to_pos((row.rect_full.max.x - 8, row.rect_full.get_center().y))
    ctx.mouse_click(0)
    ctx.yield_(3)
    assert hand.session.state == before
    ctx.item_click(f"{PANEL}/dismiss")
    resized(hand, usual)


@check
def keys_that_move_in_the_panel_go_to_no_row_under_the_bar(hand: Hand) -> None:
    ctx, panel = hand.ctx, panel_of(hand)
    usual = size_of(hand)
    resized(hand, SMALLEST)  # where most rows are scrolled away
    ctx.scroll_to_top(PANEL)
    ctx.yield_(3)
    refuse(hand, PROBLEM)
    end = place_of(hand, "Paths") - 1
    buttons = [panel.get_id(name) for name in ("dismiss", *(f"{tab}##tab" for tab in TABS))]
    scrolled_down(hand)
    ctx.item_click(f"{PANEL}/restart")
    press(hand, imgui.Key.f6)
    try:
        for _ in range(25):
            press(hand, imgui.Key.up_arrow)
            here = hand.there(lambda: imgui.get_current_context().nav_id)
            row = ctx.item_info(imgui.test_engine.TestRef(here))
            assert here in buttons or row.rect_full.min.y >= end
    finally:
        press(hand, imgui.Key.escape)
        refuse(hand, "")
        resized(hand, usual)


@check
def a_problem_is_reported_wherever_the_panel_is(hand: Hand) -> None:
    """It pushes the rows down; the one in use stays, and so does the panel's place."""
    ctx = hand.ctx
    scroll_to(hand, f"{PANEL}/tonemap")
    ctx.item_click(f"{PANEL}/tonemap")
    ctx.yield_(2)
    press(hand, imgui.Key.escape)
    before = place_of(hand, "tonemap")
    refuse(hand, "Something went wrong. " * 3)
    assert abs(place_of(hand, "tonemap") - before) < 2
    assert place_of(hand, "dismiss") < before
    ctx.item_click(f"{PANEL}/dismiss")
    ctx.yield_(4)
    assert not hand.session.problem
    assert abs(place_of(hand, "tonemap") - before) < 2


@check
def a_long_problem_leaves_room_for_the_rows(hand: Hand) -> None:
    panel = panel_of(hand)
    refuse(hand, "Something went wrong, and much is to be said about it. " * 60)
    assert place_of(hand, "dismiss") < panel.pos.y + 0.5 * panel.size.y
    hand.ctx.item_click(f"{PANEL}/dismiss")
    hand.ctx.yield_(3)


@check
def a_colour_stays_where_it_is_after_it_was_edited(hand: Hand) -> None:
    """Three numbers and a patch are one row to the hand."""
    app, ctx, session = hand.window.app, hand.ctx, hand.session
    number, shape = ball(hand)
    app.selected = number
    ctx.yield_(2)
    part = f"color##material {shape.material}/##X"
    ctx.set_ref("Controls")
    ctx.item_input_value(part, 0.25)
    ctx.yield_(3)
    before = place_of(hand, part)
    refuse(hand, PROBLEM)
    assert abs(place_of(hand, part) - before) < 2
    ctx.item_click(f"{PANEL}/dismiss")
    hand.there(session.undo)
    app.selected = None


@check
def the_panel_goes_to_the_paths_of_a_pixel_whatever_was_used_before(hand: Hand) -> None:
    app, ctx, (number, shape) = hand.window.app, hand.ctx, ball(hand)
    ctx.item_close(f"{PANEL}/Paths of a pixel")
    app.select(number)
    ctx.yield_(3)
    retype(hand, shape.material, "metal")
    hand.settle()
    left, top, width, height = app.rectangle
    press(hand, imgui.Key.p)
    ctx.mouse_move_to_pos((left + 0.5 * width, top + 0.9 * height))
    ctx.mouse_click(0)
    hand.until(lambda: app.paths.found is not None)
    ctx.yield_(4)
    assert app.preferences.tab == "Inspect"
    first = place_of(hand, "choose a pixel") - panel_of(hand).pos.y
    assert 0 < first < panel_of(hand).size.y
    app.selected = None
