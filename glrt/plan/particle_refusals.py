"""Why particles from lamps cannot be followed in a scene."""

from collections.abc import Iterator

import numpy as np

from glrt.plan.facts import SceneFacts
from glrt.plan.methods import METHODS
from glrt.scene.shapes.kinds import SAMPLED, Shape
from glrt.scene.shapes.plane import Plane
from glrt.settings import Settings


def refusal(facts: SceneFacts, settings: Settings) -> str | None:
    """Return why requested particles cannot be followed; None if they can or none are requested."""
    return next(_refusals(facts, settings), None) if settings.caustics == "on" else None


def _refusals(facts: SceneFacts, settings: Settings) -> Iterator[str]:
    particles = facts.particles
    if not METHODS[settings.method].weighs_particles:
        yield f"particles are weighed by the method mis alone, not by {settings.method}"
    if not (particles.lamps or particles.sun_sends or particles.sky_sends):
        yield f"no {', '.join(SAMPLED)}, sun or sky shines: particles leave these alone"
    if facts.has_many_lights:
        yield f"of {facts.sampled_lamps} lamps, too many to choose among for each particle"
    if facts.lobes.holed:
        yield "some surfaces have holes, which particles do not follow yet"
    if facts.scene.hidden_backs:
        yield "some meshes hide their backs, which particles would meet from the other side"
    if _shines_in_tinted_glass(facts) or _sun_shines_in_it(facts):
        yield "a lamp, sun or sky is in tinted glass or one with a priority: none starts there"
    if facts.media.names:
        yield "the scene has media, which particles do not follow yet"
    if facts.camera_glass.counts:
        yield "the camera is in glass with a priority, where nothing is linked to it"


def _dense(facts: SceneFacts) -> list[Shape]:
    """Return the visible shapes of tinted glass or of glass with a priority."""
    glasses = facts.glasses.items()
    dense = {name for name, it in glasses if any(it.absorption) or it.priority is not None}
    return [thing for thing in facts.scene.visible if thing.material in dense]


def _shines_in_tinted_glass(facts: SceneFacts) -> bool:
    around = _dense(facts)
    lamps = facts.particles.lamps if around else []
    centers = [np.array(lamp.middle, np.float64) for lamp in lamps]
    return any(glass.holds(center) for glass in around for center in centers)


def _sun_shines_in_it(facts: SceneFacts) -> bool:
    """Return whether the sun or part of a sky is on the inner side of a plane of `_dense` glass."""
    planes, sun = [it for it in _dense(facts) if isinstance(it, Plane)], facts.scene.sun
    if facts.particles.sky_sends:
        return bool(planes)
    return sun is not None and any(float(np.dot(plane.normal, sun.towards)) < 0 for plane in planes)
