"""Particles from lamps: which they leave, what they are aimed at, and where they cannot go."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from glrt.plan.facts import SceneFacts, facts_of, is_sampled
from glrt.plan.methods import METHODS
from glrt.scene.glasses import around_camera, glasses_of, holds
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Array, Object
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import Settings

BITS = 31  # of a number in the shaders that stand for spheres
TOUCHING = 1e-6  # of a radius: what reaches no deeper into a sphere touches it
MOST_TARGETS = 8  # balls around other shapes, at which particles are aimed
ROUGHEST = 0.4**2  # alpha of metal that makes caustics: roughness 0.4
GROUP = 64  # particles that one work group follows at a time: shaders_glsl/particles.comp


class Ball(NamedTuple):
    """Around shapes, in the scene's coordinates."""

    center: Array  # (3,) float64
    radius: float

    def holds(self, other: "Ball") -> bool:
        """Whether another ball lies within."""
        apart = float(np.linalg.norm(other.center - self.center))
        return apart + other.radius <= self.radius * (1 + TOUCHING)


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
    """The lamps that particles leave, beside the sun."""
    known = (thing for thing in scene.visible if isinstance(thing, Sphere | Quad | Disk | Mesh))
    return [thing for thing in known if is_sampled(scene.materials[thing.material])]


def sun_sends_particles(scene: Scene) -> bool:
    """Whether the sun shines on shapes that a ball holds."""
    finite = any(not isinstance(thing, Plane) for thing in scene.visible)
    return finite and any(scene.sun_radiance)


def sky_sends_particles(scene: Scene) -> bool:
    """Whether the sky does: it shines on shapes that a ball holds, and nothing else sends any."""
    finite = any(not isinstance(thing, Plane) for thing in scene.visible)
    others = bool(emitters_of(scene)) or any(scene.sun_radiance)
    return finite and not others and any(map(any, scene.background_colors))


def targets_of(scene: Scene) -> list[Ball]:
    """Balls around boxes, cylinders and meshes that make caustics: particles are aimed there.

    The largest come first; one within another is left out, as are those beyond MOST_TARGETS.
    """
    solids = (thing for thing in scene.visible if isinstance(thing, Box | Cylinder | Mesh))
    casters = (thing for thing in solids if makes_caustics(scene.materials[thing.material]))
    found: list[Ball] = []
    for ball in sorted(map(_ball, casters), key=lambda ball: -ball.radius):
        if len(found) < MOST_TARGETS and not any(other.holds(ball) for other in found):
            found.append(ball)
    return found


def ball_around(scene: Scene) -> Ball | None:
    """Around all shapes but planes: where particles from afar go. None where there are none."""
    balls = [_ball(thing) for thing in scene.visible if not isinstance(thing, Plane)]
    if not balls:
        return None
    centers = np.array([ball.center for ball in balls])
    radii = np.array([ball.radius for ball in balls])
    low, high = (centers - radii[:, None]).min(axis=0), (centers + radii[:, None]).max(axis=0)
    center = (low + high) / 2
    return Ball(center, float((np.linalg.norm(centers - center, axis=1) + radii).max()))


def _ball(thing: Object) -> Ball:
    return Ball(np.array(thing.middle, np.float64), thing.reach)


def caster_bits(scene: Scene) -> int:
    """The spheres that make caustics, at which particles can be aimed: a bit for each.

    By its number among the spheres. Those beyond bit 30 are left out, and all where there are so
    many that rays find them by a tree.
    """
    spheres = [thing for thing in scene.visible if isinstance(thing, Sphere)]
    known = [] if facts_of(scene).has_sphere_tree else spheres[:BITS]
    return sum(1 << n for n, it in enumerate(known) if makes_caustics(scene.materials[it.material]))


def link_bits(scene: Scene) -> int:
    """The spheres through which particles can be linked to the camera: a bit for each.

    Of those that particles are aimed at, but smooth ones alone, and not of thin glass, of glass
    with a priority, of glass that lies in denser one, of glass in part, and of those within which
    something lies.
    """
    spheres = [thing for thing in scene.visible if isinstance(thing, Sphere)]
    bits = caster_bits(scene)
    found = [(1 << n, it) for n, it in enumerate(spheres[:BITS]) if bits >> n & 1]
    return sum(bit for bit, it in found if _bends_as_known(scene, it) and _is_empty(scene, it))


def _bends_as_known(scene: Scene, sphere: Sphere) -> bool:
    material = scene.materials[sphere.material]
    if not isinstance(material, Dielectric):
        return isinstance(material, Metal) and material.alpha == 0
    is_plain = not material.thin and material.priority is None
    return is_plain and material.ior >= 1 and material.alpha == 0


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


def makes_caustics(material: Material) -> bool:
    """Whether light comes by it in few directions: by glass, or by metal that is not too rough."""
    if isinstance(material, Principled):
        is_metal = material.metallic > 0.5 and 0 < material.facet_alpha <= ROUGHEST
        return material.glass is not None or is_metal
    if isinstance(material, Metal):
        return material.alpha <= ROUGHEST
    return isinstance(material, Dielectric)


def refusal(scene: Scene, settings: Settings) -> str | None:
    """Why particles that are asked for cannot be followed; None if they can, or if none are."""
    return next(_refusals(scene, settings), None) if settings.caustics == "on" else None


def _refusals(scene: Scene, settings: Settings) -> Iterator[str]:
    found = facts_of(scene)
    if not METHODS[settings.method].weighs_particles:
        yield f"particles are weighed by the method mis alone, not by {settings.method}"
    sends = emitters_of(scene) or sun_sends_particles(scene) or sky_sends_particles(scene)
    if not sends:
        yield "no sphere, quad, disk, mesh, sun or sky shines: particles leave these alone"
    if found.has_many_lights:
        yield f"of {found.sampled_lamps} lamps, too many to choose among for each particle"
    for what, there in _beyond(found).items():
        if there:
            yield f"{what}, which particles do not follow yet"
    if _shines_in_tinted_glass(scene) or _sun_shines_in_it(scene):
        yield "a lamp, sun or sky is in tinted glass or one with a priority: none starts there"
    if around_camera(scene, scene.finishes).counts:
        yield "the camera is in glass with a priority, where nothing is linked to it"


def _beyond(found: SceneFacts) -> dict[str, bool]:
    return {
        "some surfaces have holes": bool(found.holed),
    }


def _dense(scene: Scene) -> list[Shape]:
    """What is of tinted glass or of glass with a priority."""
    glasses = glasses_of(scene, scene.finishes)
    dense = {n for n, it in glasses.items() if any(it.absorption) or it.priority is not None}
    return [thing for thing in scene.visible if thing.material in dense]


def _shines_in_tinted_glass(scene: Scene) -> bool:
    around = _dense(scene)
    centers = [np.array(lamp.middle, np.float64) for lamp in emitters_of(scene)] if around else []
    return any(holds(glass, center) for glass in around for center in centers)


def _sun_shines_in_it(scene: Scene) -> bool:
    """Whether it stands on the inner side of a plane of such glass; of the sky, a part does."""
    planes = [thing for thing in _dense(scene) if isinstance(thing, Plane)]
    if sky_sends_particles(scene):
        return bool(planes)
    return scene.sun is not None and any(
        float(np.dot(plane.normal, scene.sun.towards)) < 0 for plane in planes
    )
