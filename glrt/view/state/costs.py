"""What an edit costs at present: by what the film keeps apart."""

from glrt.methods.light_layers import emitters, layer_of_group
from glrt.scene.scene import SKY_GROUP, Scene
from glrt.scene.values import Radiance
from glrt.settings import Cost
from glrt.view.memo import kept_for_the_same
from glrt.view.state.session import Session


def cost_of_light(session: Session, group: str, is_tint: bool = False) -> Cost:
    """Of another intensity of a light group, or of another colour of one lamp."""
    layers, lamps = _lamps(session.scene)
    shares = [other for other in layers if layers[other] == layers.get(group)]
    is_weighed = len(shares) == 1 and not (is_tint and len(lamps.get(group, [])) > 1)
    if is_weighed and session.layering == "groups":
        return Cost.RELIGHT
    return Cost.RECOMPILE if group == SKY_GROUP else Cost.RESTART


def cost_of_fewer_bounces(session: Session) -> Cost:
    """Of a lower bounce limit."""
    return Cost.RELIGHT if session.layering == "lengths" else Cost.RESTART


@kept_for_the_same
def _lamps(scene: Scene) -> tuple[dict[str, int], dict[str, list[Radiance]]]:
    """The layer of each light group, and what its lamps emit."""
    return layer_of_group(scene), emitters(scene)
