"""Nothing is edited for a while: another kernel, compiled by another process, takes over."""

from glrt.rendering.renderer import Renderer
from glrt.view.state.idle_kernel import IdleKernel
from tests.support.images import same_bits
from tests.window.hand import Hand, check


@check
def a_rest_and_its_end_show_in_no_bit(hand: Hand) -> None:
    session = hand.session
    hand.there(lambda: setattr(session, "rest", IdleKernel()))
    assert hand.there(lambda: is_rested(hand) is False)
    rest(hand)
    assert hand.there(lambda: is_as_headless(hand))
    restarts = session.restarts
    hand.there(lambda: hand.window.app.turn(0.05, 0.02, about_camera=False))
    hand.until(lambda: session.restarts > restarts, frames=2)
    assert not is_rested(hand)
    assert session.samples > 0, "in the frame of the edit"
    assert hand.there(lambda: is_as_headless(hand))
    rest(hand)
    assert hand.there(lambda: is_as_headless(hand))


def is_rested(hand: Hand) -> bool:
    return bool(hand.session.renderer and hand.session.renderer.is_baked)


def rest(hand: Hand) -> None:
    """Wait until the other kernel has its turn, and some samples."""
    hand.until(lambda: is_rested(hand))
    samples = hand.session.samples
    hand.until(lambda: hand.session.samples > samples + 20)


def is_as_headless(hand: Hand) -> bool:
    """Whether the picture has the bits of one kernel."""
    session = hand.session
    assert session.renderer
    context = session.renderer.context
    plain = Renderer(session.renderer.scene, session.renderer.settings, context, layering="groups")
    expected, image = plain.render(session.samples).image(), session.image()
    plain.release()
    return same_bits(image.radiance, expected.radiance) and image.recipe == expected.recipe
