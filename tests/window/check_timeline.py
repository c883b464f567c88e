"""The strip of an animated scene: frames by its slider, keys by its button, playback."""

from functools import partial

from imgui_bundle import imgui

from glrt.scene.scene import Scene
from glrt.view.edits.keyframes import frames_of_keys, value_of
from tests.window.gestures import press, reopen
from tests.window.hand import Hand, check

KEYS = ("camera", "fov")


@check
def keys_are_set_at_frames_and_played(hand: Hand) -> None:
    app, ctx, session = hand.window.app, hand.ctx, hand.session
    assert not ctx.item_exists("//Picture/###play")
    press(hand, imgui.Key.t)
    ctx.yield_(2)
    app.timeline.chosen = KEYS
    ctx.item_click("//Picture/set key")
    assert frames_of_keys(session.scene, KEYS) == [0]
    hand.there(partial(session.edit, scene_seen_by(hand, 20.0)))
    ctx.item_input_value("//Picture/##frame", 12)
    assert value_of(session.scene, KEYS) == 38.0, "a frame that is chosen takes the keys' values"
    hand.there(partial(session.edit, scene_seen_by(hand, 20.0)))
    press(hand, imgui.Key.k)
    assert frames_of_keys(session.scene, KEYS) == [0, 12]
    ctx.item_input_value("//Picture/##frame", 6)
    assert value_of(session.scene, KEYS) == 29.0
    ctx.item_click("//Picture/###play")
    hand.until(lambda: app.timeline.frame not in (6, 0))
    ctx.item_click("//Picture/###play")
    assert not app.timeline.is_playing
    hand.there(session.undo)
    assert frames_of_keys(session.scene, KEYS) == [0]
    app.timeline.is_wanted, app.timeline.chosen = False, None
    reopen(hand)


def scene_seen_by(hand: Hand, fov: float) -> Scene:
    scene = hand.session.scene
    camera = scene.camera.model_copy(update={"fov": fov})
    return scene.model_copy(update={"camera": camera})
