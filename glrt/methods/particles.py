"""Particles from lamps: which they leave, what they are aimed at, and where they cannot go."""

from collections.abc import Iterator

import numpy as np

from glrt.methods.contents import Contents, contents_of, is_sampled
from glrt.methods.table import METHODS
from glrt.scene.glasses import glasses_of, holds
from glrt.scene.materials import Dielectric, Material, Metal
from glrt.scene.objects import Array, Object
from glrt.scene.scene import Scene
from glrt.scene.shapes import Plane, Quad, Sphere
from glrt.settings import Settings

BITS = 31  # of a number in the shaders that stand for spheres
TOUCHING = 1e-6  # of a radius: what reaches no deeper into a sphere touches it
GROUP = 64  # particles that one work group follows at a time: shaders_glsl/particles.comp


def particle_groups(settings: Settings) -> int:
    """How many work groups follow the particles of one sample of each pixel of the frame."""
    return max(1, round(settings.particles * settings.width * settings.height / GROUP))


def particles_a_sample(settings: Settings) -> float:
    """How many particles there are for each sample of a pixel: whole work groups of them."""
    return particle_groups(settings) * GROUP / (settings.width * settings.height)


def linked_groups(settings: Settings) -> int:
    """How many of the work groups link their particles through spheres, too."""
    if not settings.linked:
        return 0
    return max(1, round(settings.linked * particle_groups(settings)))


def emitters_of(scene: Scene) -> list[Object]:
    """The lamps that particles leave."""
    flat = (thing for thing in scene.visible if isinstance(thing, Sphere | Quad))
    return [thing for thing in flat if is_sampled(scene.materials[thing.material])]


def caster_bits(scene: Scene) -> int:
    """The spheres of smooth glass or metal, at which particles can be aimed: a bit for each.

    By its number among the spheres. Those beyond bit 30 are left out, and all where there are so
    many that rays find them by a tree.
    """
    spheres = [thing for thing in scene.visible if isinstance(thing, Sphere)]
    known = [] if contents_of(scene).has_sphere_tree else spheres[:BITS]
    return sum(1 << n for n, it in enumerate(known) if is_smooth(scene.materials[it.material]))


def link_bits(scene: Scene) -> int:
    """The spheres through which particles can be linked to the camera: a bit for each.

    Of those that particles are aimed at, but not of thin glass, of glass that lies in denser one,
    and of those within which something lies.
    """
    spheres = [thing for thing in scene.visible if isinstance(thing, Sphere)]
    bits = caster_bits(scene)
    found = [(1 << n, it) for n, it in enumerate(spheres[:BITS]) if bits >> n & 1]
    return sum(bit for bit, it in found if _bends_as_known(scene, it) and _is_empty(scene, it))


def _bends_as_known(scene: Scene, sphere: Sphere) -> bool:
    material = scene.materials[sphere.material]
    return not isinstance(material, Dielectric) or (not material.thin and material.ior >= 1)


def _is_empty(scene: Scene, sphere: Sphere) -> bool:
    """Whether nothing, nor the box around it, reaches into a sphere."""
    others: dict[type[Object], list[list[float]]] = {}
    for thing in scene.visible:
        if thing is not sphere:
            others.setdefault(type(thing), []).append(thing.row)
    center = np.array(sphere.center, np.float64)
    nearest = (
        float(_distances(kind, np.array(rows, np.float64), center).min())
        for kind, rows in others.items()
    )
    return all(distance >= sphere.radius * (1 - TOUCHING) for distance in nearest)


def _distances(kind: type[Object], rows: Array, point: Array) -> Array:
    """From a point to shapes of a kind, or to the boxes around them, (n,)."""
    if kind is Plane:
        away = ((point - rows[:, :3]) * rows[:, 3:]).sum(axis=1)
        return np.asarray(np.abs(away) / np.linalg.norm(rows[:, 3:], axis=1))
    if kind is Sphere:
        return np.asarray(np.linalg.norm(point - rows[:, :3], axis=1) - rows[:, 3])
    return np.asarray(np.linalg.norm(point - np.clip(point, *kind.bounds(rows)), axis=1))


def is_smooth(material: Material) -> bool:
    """Whether light passes it, or comes by it, in one direction alone."""
    if isinstance(material, Dielectric):
        return material.thin or material.alpha == 0
    return isinstance(material, Metal) and material.alpha == 0


def refusal(scene: Scene, settings: Settings) -> str | None:
    """Why particles that are asked for cannot be followed; None if they can, or if none are."""
    return next(_refusals(scene, settings), None) if settings.caustics == "on" else None


def _refusals(scene: Scene, settings: Settings) -> Iterator[str]:
    found = contents_of(scene)
    if not METHODS[settings.method].weights_both:
        yield f"particles are weighed by the method mis alone, not by {settings.method}"
    if not emitters_of(scene):
        yield "no sphere and no quad shines: particles leave these alone"
    if found.has_many_lights:
        yield f"of {found.sampled_lamps} lamps, too many to choose among for each particle"
    for what, there in _beyond(found).items():
        if there:
            yield f"{what}, which particles do not follow yet"
    if _shines_in_tinted_glass(scene):
        yield "a lamp lies in tinted glass, where particles do not know what they lose"


def _beyond(found: Contents) -> dict[str, bool]:
    return {
        "there are meshes with smooth normals": found.is_smooth,
        "there are normal maps": "normal" in found.mapped,
        "some surfaces have holes": bool(found.holed),
        "some glasses overlap by priority": bool(found.media),
    }


def _shines_in_tinted_glass(scene: Scene) -> bool:
    glasses = glasses_of(scene, scene.finishes)
    names = {name for name, glass in glasses.items() if any(glass.absorption)}
    tinted = [thing for thing in scene.visible if thing.material in names]
    centers = [np.array(lamp.middle, np.float64) for lamp in emitters_of(scene)]
    return any(holds(glass, center) for glass in tinted for center in centers)
