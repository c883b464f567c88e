"""Reasons why a scene is slow that the user can change."""

from glrt.core.text import counted
from glrt.plan.facts import MOST_LAMPS, SceneFacts
from glrt.plan.methods import CLASSIC, METHODS
from glrt.settings import Settings

MOST_PLANES = 32  # a kernel holds as many shapes as constants
LONG = 16  # bounces: longer paths have hardly any light left


def slow_because(facts: SceneFacts, settings: Settings) -> list[str]:
    """Return a text for each reason: what takes the time, and what to do."""
    found = (
        _one_by_one(facts),
        _unsampled(facts, settings),
        _no_roulette(settings),
        _particles_of_a_crop(settings),
    )
    return [text for text in found if text]


def _one_by_one(facts: SceneFacts) -> str:
    """Return the advice for many planes, which no BVH holds; empty for few."""
    planes = facts.shapes["plane"]
    if planes <= MOST_PLANES:
        return ""
    return (
        f"each ray is compared with {counted(planes, 'plane')} one by one: what has no end has no "
        "place in a tree. Quads have: use them for planes that need not be endless."
    )


def _unsampled(facts: SceneFacts, settings: Settings) -> str:
    """Return the advice for emitting triangles that are too many to be sampled; else empty."""
    if not METHODS[settings.method].uses_lamps or facts.bright_triangles == facts.lamp_triangles:
        return ""
    return (
        f"{facts.bright_triangles:,} triangles emit light, and a scene may have {MOST_LAMPS:,} "
        "lamps that are sampled: the light of meshes is found by scattering alone, and noisy. Use "
        "a mesh of fewer triangles for the lamp, or a quad."
    )


def _no_roulette(settings: Settings) -> str:
    if settings.roulette or settings.bounces < LONG or settings.method in CLASSIC:
        return ""
    return (
        f"--no-roulette follows every path to its limit of {counted(settings.bounces, 'bounce')}, "
        "though it has hardly any light left: leave it out, or allow fewer --bounces."
    )


def _particles_of_a_crop(settings: Settings) -> str:
    if settings.crop is None or settings.caustics == "off":
        return ""
    columns, rows = settings.size
    share = 100 * columns * rows / (settings.width * settings.height)
    return (
        f"the crop is {share:.2g} % of the frame, and the particles of all of it are followed: "
        "--caustics off may be faster."
    )
