"""The light of a scene: what emits how much, and in which light group."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from glrt.scene.lights.sky_image import SkyPicture, sky_picture
from glrt.scene.materials.base import Opaque
from glrt.scene.schema.fields import SceneFields
from glrt.scene.shapes.base import Object
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.twins import shown
from glrt.scene.values import BLACK, Radiance

SKY_GROUP = "background"
SUN_GROUP = "sun"


def media_group(name: str) -> str:
    """Return the light group of the emission of a medium."""
    return f"media.{name}"


class Finish(NamedTuple):
    """Material, light group and emitting side of an object; a material may have several."""

    material: str
    group: str = ""  # light group of its emission; empty if it emits nothing
    is_one_sided: bool = False  # whether it emits from its front alone


class LitScene(SceneFields):
    """The fields of a scene, and what they say about its light."""

    @property
    def shown(self) -> tuple[int, ...]:
        """Numbers of the objects that rays can meet: not hidden, and not covered by a twin."""
        return shown(self.objects, self.materials)

    @property
    def visible(self) -> tuple[Shape, ...]:
        """The objects that rays can meet."""
        return tuple(self.objects[n] for n in self.shown)

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """The visible meshes."""
        return tuple(thing for thing in self.visible if isinstance(thing, Mesh))

    @property
    def hidden_backs(self) -> list[str]:
        """Files of the visible meshes whose triangles rays pass from behind."""
        names = [mesh.file.file for mesh in self.meshes if mesh.hides_backs]
        return list(dict.fromkeys(names))

    def finish(self, thing: Object) -> Finish:
        """Return the finish of an object's surface."""
        return self._finish(thing.material, thing.group, thing.is_one_sided)

    def _finish(self, name: str, group: str | None, is_one_sided: bool) -> Finish:
        material = self.materials.get(name)  # a missing one is reported elsewhere
        if not isinstance(material, Opaque) or not material.emits:
            return Finish(name)
        return Finish(name, group or material.group or name, is_one_sided)

    def _finishes(self, things: Iterable[Object]) -> list[Finish]:
        """Return the finishes of objects, each once, in the order of materials in the file."""
        places = {name: place for place, name in enumerate(self.materials)}
        told = dict.fromkeys((it.material, it.group, it.is_one_sided) for it in things)
        found = dict.fromkeys(self._finish(*one) for one in told)
        return sorted(found, key=lambda finish: places.get(finish.material, -1))

    @property
    def finishes(self) -> list[Finish]:
        """Finishes of the visible objects, each once, in the order of materials in the file."""
        return self._finishes(self.visible)

    @property
    def light_groups(self) -> dict[str, float]:
        """Intensity of every light group: the lamps' groups in order, then sun and background."""
        suns = [SUN_GROUP] if self.sun else []
        media = [media_group(name) for name, medium in self.media.items() if medium.emits]
        groups = [*self._lamp_groups(), *media, *suns, SKY_GROUP]
        return {group: self._intensity(group) for group in groups}

    @property
    def background_colors(self) -> tuple[Radiance, ...]:
        """Radiance of the background's gradient, from below to above, intensity included."""
        intensity = self._intensity(SKY_GROUP)
        return tuple(_scaled(color, intensity) for color in self.background.gradient)

    @property
    def sun_radiance(self) -> Radiance:
        """Radiance of the sun, intensity included; black without a sun."""
        if self.sun is None:
            return BLACK
        return _scaled(self.sun.radiance(self.sun_irradiance), self._intensity(SUN_GROUP))

    @property
    def sun_irradiance(self) -> Radiance:
        """Irradiance of a surface that faces the sun, at intensity 1: given, or the sky model's."""
        sky = self.background.sky
        if self.sun is None:
            return BLACK
        return self.sun.irradiance or (sky.sun(self.sun.towards) if sky else BLACK)

    @property
    def sky(self) -> SkyPicture | None:
        """The image of the sky in all directions; None for a background of colour or gradient."""
        return sky_picture(self.background, self.sun)

    def emission(self, finish: Finish) -> Radiance:
        """Return the radiance of a finish, its group's intensity included; black if no lamp."""
        material = self.materials.get(finish.material)
        if not finish.group or not isinstance(material, Opaque):
            return BLACK
        return _scaled(material.emission, self._intensity(finish.group))

    @property
    def media_in_use(self) -> list[str]:
        """Names of the media that fill visible objects or all of space, in the order of `media`."""
        used = {self.medium, *(thing.medium for thing in self.visible)}
        return [name for name in self.media if name in used]

    def emissions_of_medium(self, name: str) -> tuple[Radiance, ...]:
        """Return `Medium.emissions` of a medium, its group's intensity included."""
        intensity = self._intensity(media_group(name))
        return tuple(_scaled(color, intensity) for color in self.media[name].emissions)

    def emission_of(self, thing: Object) -> Radiance:
        """Return the radiance of an object, intensity of its light group included."""
        return self.emission(self.finish(thing))

    def _intensity(self, group: str) -> float:
        return self.lights.get(group, 1.0)

    def _lamp_groups(self) -> Iterator[str]:
        """Yield the lamps' groups by material; a lamp material that no object uses has one, too."""
        found: dict[str, dict[str, None]] = {name: {} for name in self.materials}
        for finish in self._finishes(self.objects):
            if finish.group:
                found[finish.material][finish.group] = None
        for name, material in self.materials.items():
            if isinstance(material, Opaque) and material.emits:
                yield from found[name] or (material.group or name,)


def _scaled(color: Radiance, factor: float) -> Radiance:
    return (color[0] * factor, color[1] * factor, color[2] * factor)
