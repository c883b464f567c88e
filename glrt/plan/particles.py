"""Particles from lamps: lamps that send them, targets at which they are aimed, and their limits."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from glrt.core.memo import computed_once
from glrt.scene.lights.sky_image import bright_share
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material, glass_of
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Array, Object
from glrt.scene.shapes.kinds import SAMPLED
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import Settings

BITS = 31  # bits of a number in the shaders, one for each sphere
TOUCHING = 1e-6  # share of a radius: a shape that reaches no deeper into a sphere touches it
MOST_TARGETS = 8  # balls around other shapes, at which particles are aimed
ROUGHEST = 0.4**2  # alpha of metal that makes caustics: roughness 0.4
LEAST_BRIGHT = 0.05  # of the sky's flux, below which it sends none next to other lights
GROUP = 64  # particles that one work group follows at a time: shaders_glsl/particles.comp


class Ball(NamedTuple):
    """A ball around shapes, in scene coordinates."""

    center: Array  # (3,) float64
    radius: float

    def holds(self, other: "Ball") -> bool:
        """Return whether another ball lies within this one, up to rounding."""
        apart = float(np.linalg.norm(other.center - self.center))
        return apart + other.radius <= self.radius * (1 + TOUCHING)


def particle_groups(settings: Settings) -> int:
    """Return how many work groups follow the particles of one sample of each pixel of the frame."""
    return max(1, round(settings.particles * settings.width * settings.height / GROUP))


def particles_a_sample(settings: Settings) -> float:
    """Return the number of particles for each sample of a pixel, in whole work groups."""
    return particle_groups(settings) * GROUP / (settings.width * settings.height)


def linked_groups(settings: Settings) -> int:
    """Return how many of the work groups also link their particles through spheres."""
    if not settings.linked:
        return 0
    return max(1, round(settings.linked * particle_groups(settings)))


def is_sampled(material: Material) -> bool:
    """Return whether a material emits and can be sampled: no textured emission, no holes."""
    if isinstance(material, Principled) and material.has_holes:
        return False
    return material.emits and not (isinstance(material, Opaque) and "emission" in material.textures)


@dataclass(frozen=True)
class ParticleFacts:
    """Facts of a scene that particles need, derived when they are first used."""

    scene: Scene
    has_sphere_tree: bool  # whether rays find spheres by a BVH

    @computed_once
    def lamps(self) -> list[Object]:
        """Lamps that send particles, in addition to the sun or the sky."""
        known = (thing for thing in self.scene.visible if thing.shape in SAMPLED)
        return [thing for thing in known if is_sampled(self.scene.materials[thing.material])]

    @computed_once
    def _is_finite(self) -> bool:
        return any(thing.is_bounded for thing in self.scene.visible)

    @property
    def sun_sends(self) -> bool:
        """Whether the sun sends particles: it shines, and some shape has bounds."""
        return self._is_finite and any(self.scene.sun_radiance)

    @computed_once
    def sky_sends(self) -> bool:
        """Whether the sky sends particles; some shape must have bounds.

        It does where it is the only light. Next to lamps or the sun, its image must have bright
        spots, and no plane may be of tinted glass or have a priority: the sky is behind it, too.
        """
        if not self._is_finite or not any(map(any, self.scene.background_colors)):
            return False
        if not self.lamps and not any(self.scene.sun_radiance):
            return True
        planes = (thing for thing in self.scene.visible if not thing.is_bounded)
        return self.bright_sky >= LEAST_BRIGHT and not any(map(self._is_dense, planes))

    def _is_dense(self, thing: Object) -> bool:
        """Return whether light weakens or ranks behind an object: no particles start there."""
        glass = glass_of(self.scene.materials[thing.material])
        return glass is not None and (any(glass.absorption) or glass.priority is not None)

    @property
    def bright_sky(self) -> float:
        """The share of the sky's flux from bright spots of its image; 0 for other skies."""
        image = self.scene.background.image
        return 0.0 if image is None or image.pixels is None else bright_share(image.pixels)

    @computed_once
    def targets(self) -> list[Ball]:
        """Balls around boxes, cylinders and meshes that make caustics: particles are aimed there.

        The largest come first. A ball within another is left out, as are balls beyond MOST_TARGETS.
        """
        materials = self.scene.materials
        others = (
            it
            for it in self.scene.visible
            if it.has_inside and it.is_bounded and not isinstance(it, Sphere)
        )
        casters = (thing for thing in others if makes_caustics(materials[thing.material]))
        found: list[Ball] = []
        for ball in sorted(map(_ball, casters), key=lambda ball: -ball.radius):
            if len(found) < MOST_TARGETS and not any(other.holds(ball) for other in found):
                found.append(ball)
        return found

    @computed_once
    def bounds(self) -> Ball | None:
        """A ball around all shapes except planes, or None without such shapes."""
        return ball_around(self.scene)

    @computed_once
    def casters(self) -> int:
        """Bits of the spheres that make caustics, at which particles can be aimed.

        Bit k stands for sphere k among the visible spheres. Spheres beyond bit 30 are left out, and
        all spheres where rays find them through a BVH.
        """
        spheres = [thing for thing in self.scene.visible if isinstance(thing, Sphere)]
        known = [] if self.has_sphere_tree else spheres[:BITS]
        materials = self.scene.materials
        return sum(1 << n for n, it in enumerate(known) if makes_caustics(materials[it.material]))

    @computed_once
    def links(self) -> int:
        """Bits of the spheres through which particles can be linked to the camera.

        They are smooth casters. Thin glass is left out, and so are glass with a priority, glass
        with dispersion or an index below 1, glass in part, and spheres that something reaches into.
        """
        scene = self.scene
        spheres = [thing for thing in scene.visible if isinstance(thing, Sphere)]
        found = [(1 << n, it) for n, it in enumerate(spheres[:BITS]) if self.casters >> n & 1]
        return sum(bit for bit, it in found if _bends_as_known(scene, it) and _is_empty(scene, it))


def ball_around(scene: Scene) -> Ball | None:
    """Return a ball around all shapes except planes, or None without such shapes."""
    balls = [_ball(thing) for thing in scene.visible if thing.is_bounded]
    if not balls:
        return None
    centers = np.array([ball.center for ball in balls])
    radii = np.array([ball.radius for ball in balls])
    low, high = (centers - radii[:, None]).min(axis=0), (centers + radii[:, None]).max(axis=0)
    center = (low + high) / 2
    return Ball(center, float((np.linalg.norm(centers - center, axis=1) + radii).max()))


def _ball(thing: Object) -> Ball:
    return Ball(np.array(thing.middle, np.float64), thing.reach)


def _bends_as_known(scene: Scene, sphere: Sphere) -> bool:
    material = scene.materials[sphere.material]
    if not isinstance(material, Dielectric):
        return isinstance(material, Metal) and material.alpha == 0
    is_plain = not material.thin and material.priority is None and material.spread == 0
    return is_plain and material.ior >= 1 and material.alpha == 0


def _is_empty(scene: Scene, sphere: Sphere) -> bool:
    """Return whether no other shape, nor the box around it, reaches into a sphere."""
    others: dict[type[Object], list[list[float]]] = {}
    for thing in scene.visible:
        if thing is not sphere:
            others.setdefault(type(thing), []).append(thing.row)
    center = np.array(sphere.center, np.float64)
    nearest = (
        float(kind.gaps(np.array(rows, np.float64), center).min()) for kind, rows in others.items()
    )
    return all(distance >= sphere.radius * (1 - TOUCHING) for distance in nearest)


def makes_caustics(material: Material) -> bool:
    """Return whether a material focuses light: glass, or metal that is not too rough."""
    if isinstance(material, Principled):
        is_metal = material.metallic > 0.5 and material.facet_alpha <= ROUGHEST
        return material.glass is not None or is_metal
    if isinstance(material, Metal):
        return material.alpha <= ROUGHEST
    return isinstance(material, Dielectric)
