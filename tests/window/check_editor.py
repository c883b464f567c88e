"""Objects, materials and lamps: added, copied, renamed, changed and removed, as a user does it."""

from PIL import Image

from tests.window.hand import Hand, check


@check
def cornell_gets_a_metal_ball_in_five_clicks(hand: Hand) -> None:
    ctx, session = hand.ctx, hand.session
    before = hand.pixels()
    ctx.set_ref("Controls")
    ctx.item_click("add")
    ctx.yield_(2)
    ctx.set_ref("//$FOCUSED")
    ctx.item_click("sphere")
    ctx.yield_(2)
    ctx.set_ref("Controls")
    ctx.yield_(2)
    ctx.combo_click("type##material sphere/metal")
    hand.settle()
    Image.fromarray(hand.screen()).save("/tmp/editor.png")
    assert session.scene.objects[-1].material == "sphere"
    assert session.scene.materials["sphere"].type == "metal"
