"""The paths of a pixel: asked for by a click, drawn, reported, stored."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imgui_bundle import imgui

from glrt.rendering.paths.file import paths_from_json
from glrt.rendering.paths.replay import Selection, path_replay, pixel_paths
from glrt.rendering.paths.values import PixelPaths
from glrt.settings import settings_for
from glrt.view.state.path_explorer import FOLLOWED
from tests.window.gestures import ball, click, press, reported_lines
from tests.window.hand import SMALL, Hand, check

PLACE = (0.645, 0.935)  # on the floor, under the glass ball


def ask(hand: Hand, place: tuple[float, float] = PLACE) -> None:
    """Click a pixel, after the key that says what a click means."""
    app, ctx = hand.window.app, hand.ctx
    if not app.paths.is_choosing:
        press(hand, imgui.Key.p)
    left, top, width, height = app.rectangle
    before = app.paths.found
    ctx.mouse_move_to_pos((left + place[0] * width, top + place[1] * height))
    ctx.mouse_click(0)
    hand.until(lambda: app.paths.found is not before or bool(hand.session.problem))
    ctx.yield_(3)


@check
def paths_are_shown_or_refused_by_name(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    before = hand.screen()
    ask(hand)
    if session.pipeline == "fragment":
        assert "4.3" in session.problem
        assert app.paths.found is None
        return
    assert app.paths.found
    assert app.paths.found.pixel == tuple(int(p * SMALL["width"]) for p in PLACE)
    assert app.selected is None  # the click selected nothing
    assert np.abs(hand.screen().astype(int) - before).max(axis=2).astype(bool).mean() > 0.05


@check
def replayed_samples_are_those_of_the_picture_to_the_bit(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.until(lambda: session.samples >= 20)
    session.paused = True
    hand.ctx.yield_(2)
    ask(hand)
    found = app.paths.found
    assert found
    assert len(found.radiances) == session.samples
    x, y = found.pixel
    assert np.array_equal(found.mean, hand.there(session.image).radiance[y, x])
    assert found.paths[0].sample == found.brightest(1)[0]


@check
def samples_are_stepped_through_and_more_pixels_compile_nothing(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.until(lambda: hand.session.samples >= 20)
    ask(hand)
    ctx.set_ref("Controls")
    ctx.item_input_value("sample", 7)
    ctx.yield_(2)
    assert app.paths.shown
    assert app.paths.shown.sample == 7
    first = app.paths.found
    assert first
    listed = first.paths[1].sample
    hand.there(lambda: app.paths.show(listed))
    assert app.paths.shown == first.paths[1]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("glrt.view.state.path_explorer.path_replay", None)
        ask(hand, (0.2, 0.5))
    assert not hand.session.problem
    assert app.paths.found is not first


@check
def a_scene_that_changed_since_is_reported_and_a_camera_that_moved_is_not(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    ask(hand)
    press(hand, imgui.Key.w)
    assert app.paths.is_of(session.scene)
    hand.there(lambda: app.add("box"))
    assert not app.paths.is_of(session.scene)
    hand.settle()
    ask(hand, (0.5, 0.5))
    assert app.paths.is_of(session.scene)


@check
def the_view_from_outside_is_turned_by_a_drag(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    ask(hand)
    camera, before = hand.session.scene.camera, app.outside
    ctx.mouse_move("//Picture/outside")
    x, y = imgui.get_io().mouse_pos
    ctx.mouse_down(0)
    ctx.mouse_move_to_pos((x + 40, y + 10))
    ctx.mouse_up(0)
    assert app.outside != before
    assert hand.session.scene.camera == camera


@check
def paths_are_stored_as_a_test(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.until(lambda: hand.session.samples >= 4)
    ask(hand)
    ctx.item_click("//Controls/save as a test")
    ctx.yield_(2)
    file = Path.cwd() / "paths.json"
    stored = paths_from_json(file.read_text(), "paths.json")
    found = app.paths.found
    assert found
    assert (stored.pixel, stored.paths) == (found.pixel, found.paths)
    assert stored.recipe.scene == found.recipe.scene
    assert "paths.json" in app.messages.last

    def again() -> bool:
        recipe = stored.recipe
        with path_replay(recipe.scene, recipe.settings, hand.session.context) as (replay, _):
            numbers = [path.sample for path in stored.paths]
            return replay.paths(stored.pixel, numbers) == stored.paths

    assert hand.there(again)
    ctx.item_click("//Controls/forget##paths")
    assert app.paths.found is None


@check
def particles_of_a_pixel_are_listed_apart_as_the_command_does(hand: Hand) -> None:
    app, ctx, session = hand.window.app, hand.ctx, hand.session
    hand.until(lambda: session.samples >= 20)
    session.paused = True
    samples, restarts = session.samples, session.restarts
    ask(hand)
    assert app.paths.found
    assert app.paths.found.particles is None
    ctx.item_click("//Controls/particles")
    ask(hand)
    hand.until(lambda: not app.paths.is_waiting)
    found = app.paths.found
    assert found
    assert found.particles
    recipe = found.recipe
    assert recipe.settings.caustics == "on"

    followed = min(samples, FOLLOWED)

    def again() -> PixelPaths:
        settings = settings_for(recipe.settings, samples=followed)
        wanted = Selection((), particles=8)
        return pixel_paths(recipe.scene, settings, found.pixel, wanted, session.context)

    expected = hand.there(again)
    assert expected.particles
    assert found.particles.samples == expected.particles.samples == -(-followed // 16) * 16
    assert found.particles.numbers == expected.particles.numbers
    assert np.array_equal(found.particles.radiances, expected.particles.radiances)
    assert found.particles.paths == expected.particles.paths
    assert len(found.particles.paths) > 0
    assert session.settings.caustics == "off"  # the picture is as it was
    assert (session.samples, session.restarts) == (samples, restarts)
    path = found.particles.paths[-1]
    before = hand.screen()
    ctx.item_click(f"//Controls/###sample {path.sample}, particle {path.particle}")
    ctx.yield_(2)
    assert app.paths.shown is path
    assert (hand.screen() != before).any()


@check
def paths_and_particles_of_a_picture_that_has_them_make_up_its_pixel(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.there(lambda: session.edit(caustics="on", samples=32, bounces=4))
    hand.until(lambda: session.is_done)
    ask(hand)
    hand.until(lambda: not app.paths.is_waiting)
    found = app.paths.found
    assert found
    assert found.particles
    assert len(found.radiances) == found.particles.samples == 32
    x, y = found.pixel
    whole = found.mean + found.particles.mean
    assert whole == pytest.approx(hand.there(session.image).radiance[y, x], rel=1e-5)


@check
def a_scene_whose_particles_cannot_be_followed_is_reported(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.there(lambda: session.edit(method="nee"))
    hand.settle()
    app.paths.with_particles = True
    press(hand, imgui.Key.p)
    hand.there(lambda: app.ask_paths(*PLACE))
    hand.until(lambda: bool(session.problem))
    assert "particles are weighed by the method mis alone" in session.problem
    assert app.paths.found is None


@check
def escape_ends_the_choice_of_a_pixel_and_then_removes_its_paths(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    with reported_lines() as lines:
        press(hand, imgui.Key.p)
        assert any("click a pixel" in line and "Escape" in line for line in lines)
        press(hand, imgui.Key.escape)
        assert not app.paths.is_choosing
        ask(hand)
        x, y = app.paths.found.pixel if app.paths.found else (-1, -1)
        lines.clear()
        ctx.yield_(2)
        assert f"paths of pixel {x}, {y}; Escape: clicks select objects again" in lines
        press(hand, imgui.Key.escape)
        assert app.paths.found
        lines.clear()
        ctx.yield_(2)
        assert f"paths of pixel {x}, {y}; Escape removes them" in lines
    number, shape = ball(hand)
    click(hand, shape.center)
    assert app.selected == number
    press(hand, imgui.Key.escape)
    assert app.paths.found is None


@check
def lines_of_a_path_report_what_was_added_and_are_not_cut(hand: Hand) -> None:
    """The light added stands first in the line below its strategy."""
    told: list[str] = []
    widths: list[float] = []
    written, dimmed = imgui.text_wrapped, imgui.text_disabled

    def heard(draw: Any) -> Any:
        def draw_it(text: str) -> None:
            told.append(text)
            draw(text)
            room = imgui.get_window_pos().x + imgui.get_window_size().x
            widths.append(imgui.get_item_rect_max().x - room)

        return draw_it

    ask(hand)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(imgui, "text_wrapped", heard(written))
        patch.setattr(imgui, "text_disabled", heard(dimmed))
        hand.until(lambda: any(line.startswith("added ") for line in told))
    below = next(row for row, line in enumerate(told) if line.startswith("added "))
    assert "sampling" in told[below - 1] or "scattering" in told[below - 1]
    assert max(widths) <= 0
