"""Light as a weighted sum: which layers a film keeps, and what weights a change of light means.

Radiance is linear in emission and is a sum over the lengths of paths. What was traced can so show
other intensities and colours of its lamps, or fewer bounces, at the cost of a sum.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.plan.facts import SceneFacts, facts_of
from glrt.plan.features import needs_of
from glrt.scene.instancing import Apart, after_moves
from glrt.scene.materials.base import Opaque
from glrt.scene.nameless import less_names
from glrt.scene.scene import SKY_GROUP, SUN_GROUP, Scene
from glrt.scene.values import Radiance
from glrt.settings import Cost, Settings, cost_of_change

Layering = Literal["none", "groups", "lengths"]
Weight = tuple[float, float, float]  # a factor for each channel
Weights = tuple[Weight, ...]  # one for each layer; one alone weighs the whole picture

MOST_LAYERS = read_constants(read("film/most_layers.glsl"))["MOST_LAYERS"]
ONE: Weight = (1.0, 1.0, 1.0)
NONE: Weight = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Plan:
    """What is traced onto a film by layers, and the weights that make it what is wanted."""

    scene: Scene
    settings: Settings
    layering: Layering
    weights: Weights = (ONE,)
    first_sample: int = 0  # above 0 for a part of a render
    apart: Apart = "repeated"  # which meshes have trees of their own

    @property
    def facts(self) -> SceneFacts:
        """What is in its scene."""
        return facts_of(self.scene, self.apart)

    @property
    def layers(self) -> int:
        """How many layers the film keeps beside its mean: none where the mean alone suffices."""
        counts = {
            "none": 0,
            "groups": len(set(layer_of_group(self.scene).values())),
            "lengths": min(self.settings.bounces + 1, MOST_LAYERS),
        }
        return counts[self.layering] if counts[self.layering] > 1 else 0

    def constants(self) -> dict[str, bool | int]:
        """The prelude of a kernel that fills the layers."""
        layer_of = layer_of_group(self.scene) if self.layers else {}
        return {
            "LAYERS": self.layers,
            "BY_LENGTH": self.layering == "lengths",
            "BACKGROUND_LAYER": layer_of.get(SKY_GROUP, 0),
            "SUN_LAYER": layer_of.get(SUN_GROUP, 0),
        }

    def relit(self, scene: Scene, settings: Settings, layering: Layering) -> "Plan | None":
        """The same film under other weights; None if what is wanted must be traced anew."""
        weights = _weights(self, scene, settings) if layering == self.layering else None
        return replace(self, weights=weights) if weights else None

    def cost_of(self, scene: Scene, settings: Settings, layering: Layering) -> Cost:
        """What it costs to trace or show that instead."""
        if relit := self.relit(scene, settings, layering):
            return Cost.FREE if relit == self else Cost.RELIGHT
        after = self.followed_by(scene, settings, layering, self.first_sample)
        needs = (needs_of(plan.scene, plan.settings, plan.facts) for plan in (self, after))
        is_same = len(set(needs)) == 1 and self.constants() == after.constants()
        return Cost.RESTART if is_same else Cost.RECOMPILE

    def followed_by(
        self, scene: Scene, settings: Settings, layering: Layering, first_sample: int
    ) -> "Plan":
        """What to trace after an edit."""
        apart = after_moves(self.apart, self.scene.meshes, scene.meshes)
        return plan_for(scene, settings, layering, first_sample, apart)

    def alone(self, length: int) -> Weights:
        """The light of the paths of one length; the last layer holds all that are longer."""
        shown = min(length, self.layers - 1)
        return tuple(ONE if layer == shown else NONE for layer in range(self.layers))


def plan_for(
    scene: Scene,
    settings: Settings,
    layering: Layering,
    first_sample: int = 0,
    apart: Apart = "repeated",
) -> Plan:
    """What to trace: with light groups apart, lamps that are off are traced at 1.

    So one that is turned on is there at once.
    """
    intensities = scene.light_groups
    dark = [group for group in emitters(scene) if intensities[group] == 0]
    plan = Plan(scene, settings, layering, first_sample=first_sample, apart=apart)
    if layering != "groups" or not dark:
        return plan
    lights = {**scene.lights, **dict.fromkeys(dark, 1.0)}
    plan = replace(plan, scene=scene.model_copy(update={"lights": lights}))
    return plan.relit(scene, settings, layering) or plan


def emitters(scene: Scene) -> dict[str, list[Radiance]]:
    """The light groups of the lamps and of a sky that shines, with their emissions at 1.

    Lamps that are black count, so that the kernel is the same when they shine.
    """
    found: dict[str, list[Radiance]] = {}
    for finish in scene.finishes:
        material = scene.materials[finish.material]
        if finish.group and isinstance(material, Opaque):
            found.setdefault(finish.group, []).append(material.emission)
    if any(scene.sun_irradiance):
        found.setdefault(SUN_GROUP, []).append(scene.sun_irradiance)
    if any(map(any, scene.background.gradient)):
        found[SKY_GROUP] = list(scene.background.gradient)
    return found


def layer_of_group(scene: Scene) -> dict[str, int]:
    """The layer of each light group that shines; what is beyond the last layer shares it."""
    return {group: min(n, MOST_LAYERS - 1) for n, group in enumerate(emitters(scene))}


def are_trivial(weights: Weights) -> bool:
    """Whether the film's mean is the sum."""
    return all(weight == ONE for weight in weights)


def _weights(film: Plan, scene: Scene, settings: Settings) -> Weights | None:
    """What weighs a film so; None where light is wanted that it lacks. Names are none of it."""
    traced, wanted = less_names(film.scene, scene)
    if film.layering == "lengths":
        return _length_weights(film, settings) if traced == wanted else None
    if cost_of_change(film.settings, settings) is not Cost.FREE:
        return None
    if traced == wanted:
        return (ONE,)
    if film.layering == "none" or _unlit(traced) != _unlit(wanted):
        return None
    return _group_weights(traced, wanted)


def _length_weights(film: Plan, settings: Settings) -> Weights | None:
    limit, count = settings.bounces, film.layers
    at_limit = film.settings.model_copy(update={"bounces": limit})
    if cost_of_change(at_limit, settings) is not Cost.FREE:
        return None
    if limit == film.settings.bounces:
        return (ONE,)
    if limit > film.settings.bounces or limit >= MOST_LAYERS - 1:
        return None  # never traced, or mixed with longer paths in the last layer
    return tuple(ONE if length <= limit else NONE for length in range(count))


def _group_weights(film: Scene, wanted: Scene) -> Weights | None:
    """A weight for each layer; None where a layer would need two, or light that it lacks."""
    traced, layers = layer_of_group(film), dict[int, Weight]()
    if emitters(wanted).keys() != traced.keys():
        return None
    for group, layer in traced.items():
        weight = _group_weight(film, wanted, group)
        if weight is None or layers.setdefault(layer, weight) != weight:
            return None
    return tuple(layers[layer] for layer in sorted(layers)) or (ONE,)


def _group_weight(film: Scene, wanted: Scene, group: str) -> Weight | None:
    """Intensity and colour wanted over those traced; None if its lamps do not change alike."""
    tints = set(_tints(emitters(film)[group], emitters(wanted)[group]))
    if len(tints) != 1 or None in tints:
        return None
    tint = tints.pop()
    assert tint
    ratio = wanted.light_groups[group] / film.light_groups[group]
    return (ratio * tint[0], ratio * tint[1], ratio * tint[2])


def _tints(traced: list[Radiance], wanted: list[Radiance]) -> Iterator[Weight | None]:
    for before, after in zip(traced, wanted, strict=True):
        if any(new and not old for old, new in zip(before, after, strict=True)):
            yield None  # no light of this channel was traced
        else:
            red, green, blue = (
                new / old if old else 1.0 for old, new in zip(before, after, strict=True)
            )
            yield (red, green, blue)


def _unlit(scene: Scene) -> Scene:
    """The scene less all that a change of light may change; which lamps there are stays."""
    materials = {
        name: m.model_copy(update={"emission": ONE}) if m.emits else m
        for name, m in scene.materials.items()
    }
    ends = ("bottom", "horizon", "top")
    given = {n: NONE for n in ends if getattr(scene.background, n) is not None}
    sky = scene.background.sky and scene.background.sky.model_copy(update={"scale": 1.0})
    background = scene.background.model_copy(update={"color": None, "sky": sky, **given})
    sun = scene.sun.model_copy(update={"irradiance": ONE}) if scene.sun else None
    update = {"materials": materials, "lights": {}, "background": background, "sun": sun}
    return scene.model_copy(update=update)
