"""A background in an image: turned and tinted in the panel, with nothing that would lose it."""

import numpy as np
import pytest

from glrt.scene.lights.clear_sky import ClearSky
from glrt.settings import Cost
from glrt.view.controls import replaced
from tests.support.builders import plane
from tests.support.sky_images import random_sky, under
from tests.window.gestures import move
from tests.window.hand import Hand, check


@check
def an_image_of_the_sky_is_turned_and_tinted(hand: Hand) -> None:
    ctx, session = hand.ctx, hand.session
    sky = under(random_sky(8, 4), plane([0, -1, 0], [0, 1, 0], "m"))
    scene = replaced(sky, camera=session.scene.camera)
    hand.there(lambda: hand.window.app.edit_scene("", lambda _: scene))
    hand.settle()
    ctx.set_ref("Controls")
    ctx.item_open("Background")
    hand.ctx.yield_(2)
    assert not ctx.item_exists("gradient"), "it would take the place of the image"
    assert ctx.item_exists("another photo...")
    move(hand, "rotation##background", 90.0)
    hand.settle()
    assert session.scene.background.rotation == 90.0
    assert session.last_cost is Cost.RESTART
    move(hand, "color##background/##color/$$1", 0.5)
    hand.settle()
    assert session.scene.background.color == (1.0, 0.5, 1.0)
    assert session.scene.background.image == scene.background.image
    move(hand, "intensity##background", 2.0)
    hand.settle()
    assert session.scene.lights["background"] == 2.0
    ctx.item_close("Background")


@check
def a_clear_sky_comes_with_its_sun_and_goes_without_a_change_of_it(hand: Hand) -> None:
    ctx, session = hand.ctx, hand.session
    ctx.set_ref("Controls")
    ctx.item_open("Background")
    ctx.item_open("Sun")
    hand.ctx.yield_(2)
    assert ctx.item_exists("photo...")
    move(hand, "clear sky", None)
    hand.settle()
    assert session.scene.background.sky == ClearSky()
    assert session.scene.sun
    assert session.scene.sun.irradiance is None
    noon = session.scene.sun_irradiance
    move(hand, "elevation##sun", 10.0)
    move(hand, "turbidity##sky", 5.0)
    hand.settle()
    assert session.scene.background.sky == ClearSky(turbidity=5.0)
    evening = session.scene.sun_irradiance
    assert max(evening) < max(noon)
    restarts, session.last_cost = session.restarts, None
    move(hand, "scale##sky", 3.0)
    hand.settle()
    if session.context.has_compute:
        assert session.last_cost is Cost.RELIGHT
        assert session.restarts == restarts
    move(hand, "clear sky", None)
    hand.settle()
    assert session.scene.background.sky is None
    assert session.scene.sun
    assert session.scene.sun.irradiance == pytest.approx(3 * np.array(evening))
    assert not session.problem
    ctx.item_close("Sun")
    ctx.item_close("Background")
