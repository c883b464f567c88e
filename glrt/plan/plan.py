"""The plan of a render: a film of light layers, and the weights that sum them to a picture.

Radiance is linear in emission and is a sum over the lengths of paths. So a traced film can show
other intensities and colours of its lamps, or fewer bounces, at the cost of a weighted sum.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from glrt.core.memo import computed_once
from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.plan.facts import SceneFacts
from glrt.plan.features import Needs, needs_of
from glrt.plan.methods import has_ambient
from glrt.plan.particles import Ball
from glrt.plan.probe_grid import Grid, grid_of
from glrt.scene.instancing import Apart, after_moves
from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP
from glrt.scene.nameless import less_names
from glrt.scene.scene import Scene
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
    """The scene and settings that are traced onto a film, and the weights of its layers."""

    facts: SceneFacts
    settings: Settings
    layering: Layering
    weights: Weights = (ONE,)
    first_sample: int = 0  # above 0 for a part of a render
    is_blurred: bool = False  # each sample sees a scene of its own, and has a plan of its own

    @property
    def scene(self) -> Scene:
        """The scene that is traced."""
        return self.facts.scene

    @property
    def apart(self) -> Apart:
        """Which meshes have a BVH of their own."""
        return self.facts.apart

    @computed_once
    def needs(self) -> Needs:
        """The features of the kernel."""
        return needs_of(self.facts, self.settings)

    @computed_once
    def grid(self) -> Grid | None:
        """The grid of probes; None for methods without probes."""
        return grid_of(self.scene, self.settings) if self.needs.has_probes else None

    @property
    def bounds(self) -> Ball | None:
        """The ball that particles from the sun or the sky fill, or None without such particles."""
        if not self.needs.has_particles:
            return None
        sends = self.needs.has_sun or self.facts.particles.sky_sends
        return self.facts.particles.bounds if sends else None

    @property
    def layers(self) -> int:
        """Number of layers that the film keeps in addition to its mean; 0 if the mean suffices."""
        counts = {
            "none": 0,
            "groups": len(set(layer_of_group(self.facts).values())),
            "lengths": min(self.settings.bounces + 1, MOST_LAYERS),
        }
        return counts[self.layering] if counts[self.layering] > 1 else 0

    def constants(self) -> dict[str, bool | int]:
        """Return the prelude constants of a kernel that fills the layers."""
        layer_of = layer_of_group(self.facts) if self.layers else {}
        return {
            "LAYERS": self.layers,
            "BY_LENGTH": self.layering == "lengths",
            "BACKGROUND_LAYER": layer_of.get(SKY_GROUP, 0),
            "SUN_LAYER": layer_of.get(SUN_GROUP, 0),
        }

    def relit(self, scene: Scene, settings: Settings, layering: Layering) -> "Plan | None":
        """Return this plan with weights that show the change; None if it must be traced again.

        Weights do not reach terms of light: with these, each change of light is traced.
        """
        weights = _weights(self, scene, settings) if layering == self.layering else None
        if weights is None or (settings.terms and not are_trivial(weights)):
            return None
        return replace(self, weights=weights)

    def cost_of(self, scene: Scene, settings: Settings, layering: Layering) -> Cost:
        """Return the cost of a change to this scene, these settings and this layering."""
        if relit := self.relit(scene, settings, layering):
            return Cost.FREE if relit == self else Cost.RELIGHT
        after = self.followed_by(scene, settings, layering, self.first_sample)
        is_same = self.needs == after.needs and self.constants() == after.constants()
        return Cost.RESTART if is_same else Cost.RECOMPILE

    def followed_by(
        self, scene: Scene, settings: Settings, layering: Layering, first_sample: int
    ) -> "Plan":
        """Return the plan to trace after an edit."""
        apart = after_moves(self.apart, self.scene.meshes, scene.meshes)
        return prepare(scene, settings, layering, first_sample, apart)

    def alone(self, length: int) -> Weights:
        """Return weights that show paths of one length; the last layer holds longer ones too."""
        shown = min(length, self.layers - 1)
        return tuple(ONE if layer == shown else NONE for layer in range(self.layers))


def prepare(
    scene: Scene,
    settings: Settings,
    layering: Layering = "none",
    first_sample: int = 0,
    apart: Apart = "repeated",
) -> Plan:
    """Plan what to trace.

    With layers by light group, groups that are off are traced at intensity 1, so that a lamp that
    is turned on needs no new samples. This holds neither with terms of light nor with ambient light
    that belongs to no group.
    """
    facts, intensities = SceneFacts(scene, apart), scene.light_groups
    plan = Plan(facts, settings, layering, first_sample=first_sample)
    dark = [group for group in facts.emissions if intensities[group] == 0]
    if layering != "groups" or not dark or settings.terms or has_ambient(settings):
        return plan
    lit = scene.model_copy(update={"lights": {**scene.lights, **dict.fromkeys(dark, 1.0)}})
    plan = replace(plan, facts=SceneFacts(lit, apart))
    return plan.relit(scene, settings, layering) or plan


def layer_of_group(facts: SceneFacts) -> dict[str, int]:
    """Return the layer of each light group that shines; groups beyond the last layer share it."""
    return {group: min(n, MOST_LAYERS - 1) for n, group in enumerate(facts.emissions)}


def are_trivial(weights: Weights) -> bool:
    """Return whether all weights are 1, so that the film's mean is the picture."""
    return all(weight == ONE for weight in weights)


def _weights(film: Plan, scene: Scene, settings: Settings) -> Weights | None:
    """Return weights that show the scene; None if the film lacks some of its light.

    Names in the scene do not matter.
    """
    traced, wanted = less_names(film.scene, scene)
    if film.layering == "lengths":
        return _length_weights(film, settings) if traced == wanted else None
    if cost_of_change(film.settings, settings) is not Cost.FREE:
        return None
    if traced == wanted:
        return (ONE,)
    if film.layering == "none" or has_ambient(settings) or _unlit(traced) != _unlit(wanted):
        return None
    return _group_weights(SceneFacts(traced), SceneFacts(wanted))


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


def _group_weights(film: SceneFacts, wanted: SceneFacts) -> Weights | None:
    """Return a weight for each layer; None if a layer would need two, or light that it lacks."""
    traced, layers = layer_of_group(film), dict[int, Weight]()
    if wanted.emissions.keys() != traced.keys():
        return None
    for group, layer in traced.items():
        weight = _group_weight(film, wanted, group)
        if weight is None or layers.setdefault(layer, weight) != weight:
            return None
    return tuple(layers[layer] for layer in sorted(layers)) or (ONE,)


def _group_weight(film: SceneFacts, wanted: SceneFacts, group: str) -> Weight | None:
    """Return wanted over traced intensity and colour; None if a group's lamps change unequally."""
    tints = set(_tints(film.emissions[group], wanted.emissions[group]))
    if len(tints) != 1 or None in tints:
        return None
    tint = tints.pop()
    assert tint
    ratio = wanted.scene.light_groups[group] / film.scene.light_groups[group]
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
    """Return the scene without anything that a change of light may change, except its lamps."""
    materials = {
        name: m.model_copy(update={"emission": ONE}) if m.emits else m
        for name, m in scene.materials.items()
    }
    ends = ("bottom", "horizon", "top")
    given = {n: NONE for n in ends if getattr(scene.background, n) is not None}
    sky = scene.background.sky and scene.background.sky.model_copy(update={"scale": 1.0})
    background = scene.background.model_copy(update={"color": None, "sky": sky, **given})
    sun = scene.sun.model_copy(update={"irradiance": ONE}) if scene.sun else None
    media = {
        name: it.with_emissions((ONE,) * len(it.emissions)) if it.emits else it
        for name, it in scene.media.items()
    }
    update = {
        "materials": materials,
        "media": media,
        "lights": {},
        "background": background,
        "sun": sun,
    }
    return scene.model_copy(update=update)
