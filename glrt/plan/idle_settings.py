"""Settings that a user gives although they change nothing, in words."""

from collections.abc import Callable, Collection
from typing import NamedTuple

from glrt.plan.methods import METHODS, reuses_points, traits_of
from glrt.settings import Settings


class Rule(NamedTuple):
    """When a setting has an effect, and why it has none elsewhere."""

    acts: Callable[[Settings], bool]
    why: str


_PARTICLES = Rule(lambda it: it.caustics == "on", "only --caustics on sends particles")
_RULES = {
    "effects": Rule(
        lambda it: METHODS[it.method].rasters, "only the method hybrid chooses effects of rays"
    ),
    "roulette": Rule(
        lambda it: traits_of(it).follows and not traits_of(it).splits,
        "only paths that a method follows at random end by roulette",
    ),
    "particles": _PARTICLES,
    "aimed": _PARTICLES,
    "linked": _PARTICLES,
    "probes": Rule(
        lambda it: traits_of(it).has_probes,
        "only the methods ddgi, gather and resampled, and hybrid with the effect gi, have probes",
    ),
    "reuse": Rule(
        lambda it: METHODS[it.method].resamples, "only the method resampled reuses points"
    ),
    "unbiased": Rule(reuses_points, "only the method resampled traces rays to reused points"),
    "march_step": Rule(
        lambda it: METHODS[it.method].marches, "only the method march takes steps of a length"
    ),
}


def idle(settings: Settings, given: Collection[str]) -> list[str]:
    """Return a sentence for each setting among those `given` that changes nothing."""
    return [
        f"--{name.replace('_', '-')} has no effect here: {rule.why}."
        for name, rule in _RULES.items()
        if name in given and not rule.acts(settings)
    ]
