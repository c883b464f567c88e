"""Present cost of an edit, which depends on the layers of the film, and controls with it."""

from typing import Literal

from glrt.core.memo import kept_for_the_same
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import MOST_LAYERS, layer_of_group
from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP, Finish
from glrt.scene.scene import Scene
from glrt.scene.values import Radiance
from glrt.settings import Cost, Settings
from glrt.view.controls import Control, control_of_items, controls_of
from glrt.view.state.session import Session

Reach = tuple[int, Cost]  # the largest value with the usual cost, and the cost beyond it
INTENSITY = control_of_items(Scene, "lights")
BOUNCES = next(control for control in controls_of(Settings) if control.name == "bounces")


def intensity_control(session: Session, group: str, name: str) -> Control:
    """Return the control of a light group's intensity, under a name."""
    return INTENSITY.named(name).costing(cost_of_light(session, group))


def bounces_control(session: Session) -> Control:
    """Return the control of the limit of bounces."""
    reach = reach_of_bounces(session)
    return BOUNCES.costing(Cost.RELIGHT if reach else Cost.RESTART, reach)


def dimmable_lights(scene: Scene) -> dict[str, float]:
    """Return the intensity of each light group; that of the background unless it is black."""
    has_sky = any(map(any, scene.background.gradient))
    return {g: x for g, x in scene.light_groups.items() if g != SKY_GROUP or has_sky}


def cost_of_light(session: Session, group: str) -> Cost:
    """Return the cost of another intensity of a light group."""
    layers, _ = _lamps(session.scene)
    shares = [other for other in layers if layers[other] == layers.get(group)]
    if len(shares) == 1 and session.weighed == "groups":
        return Cost.RELIGHT
    is_sun = group == SUN_GROUP and session.scene.sun is not None
    return Cost.RECOMPILE if is_sun or group == SKY_GROUP else Cost.RESTART


def cost_of_tint(session: Session, name: str) -> Cost:
    """Return the cost of another colour of a material's lamps, in all their light groups."""
    groups = {finish.group for finish in _finishes(session.scene) if finish.material == name}
    _, lamps = _lamps(session.scene)
    is_weighed = groups and all(_is_one_tint(session, group, lamps) for group in groups)
    costs = {cost_of_light(session, group) for group in groups}
    return Cost.RELIGHT if is_weighed and costs == {Cost.RELIGHT} else Cost.RESTART


def reach_of_bounces(session: Session) -> Reach | None:
    """Return the bounces up to which layers are reweighted, and the cost beyond; None: no layers.

    The last layer holds the light of all longer paths together.
    """
    if session.weighed != "lengths":
        return None
    plan = session.renderer.plan if session.renderer else None
    is_traced = plan and plan.layering == "lengths"
    traced = plan.settings.bounces if plan and is_traced else session.settings.bounces
    beyond = Cost.RECOMPILE if traced + 1 < MOST_LAYERS else Cost.RESTART
    return traced if traced < MOST_LAYERS else MOST_LAYERS - 2, beyond


def traced_bounces(session: Session) -> int:
    """Return the bounces that the paths of the film were traced to; the picture may show fewer."""
    renderer = None if session.is_behind else session.renderer
    return renderer.plan.settings.bounces if renderer else session.settings.bounces


def limit_beyond(session: Session) -> int | None:
    """Return `traced_bounces` if the picture shows fewer, else None."""
    traced = traced_bounces(session)
    return None if traced == session.settings.bounces else traced


def reach_of_size(session: Session, side: Literal["width", "height"]) -> Reach | None:
    """Return the largest side with room for layers, and the cost beyond; None without layers."""
    layers = session.room.layers(session.scene, session.settings, session.layering)
    if not layers:
        return None
    most = session.room.largest // (layers if side == "width" else 2)
    return most, Cost.RECOMPILE


def _is_one_tint(session: Session, group: str, lamps: dict[str, list[Radiance]]) -> bool:
    """Whether a colour is a factor of the traced light: of one lamp alone, with no channel 0."""
    plan = session.renderer.plan if session.renderer else None
    traced = plan.facts.emissions.get(group, []) if plan else []
    return len(lamps.get(group, [])) <= 1 and all(all(light) for light in traced)


@kept_for_the_same
def _lamps(scene: Scene) -> tuple[dict[str, int], dict[str, list[Radiance]]]:
    """Return the layer of each light group, and the emissions of its lamps."""
    facts = SceneFacts(scene)
    return layer_of_group(facts), facts.emissions


@kept_for_the_same
def _finishes(scene: Scene) -> list[Finish]:
    return scene.finishes
