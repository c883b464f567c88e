"""A scene as a frozen value, and the checks that its parts fit together."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self

from pydantic import model_validator

from glrt.core.errors import SceneError, UsageError
from glrt.core.files import write_text
from glrt.core.text import number, quoted, unknown
from glrt.scene.animation.tracks import Animation
from glrt.scene.camera import Camera
from glrt.scene.files.assets import AssetFolder
from glrt.scene.frames import animation_problems, with_values
from glrt.scene.lights.background import Background
from glrt.scene.lights.sky_image import SkyPicture, sky_picture
from glrt.scene.lights.sun import Sun
from glrt.scene.loading.file_copies import copy_files
from glrt.scene.loading.scene_files import with_files
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import Material
from glrt.scene.medium import Medium
from glrt.scene.misfits import medium_problems, object_problems, sun_problems
from glrt.scene.nesting import nesting_problems
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.tables import to_tables, toml_text
from glrt.scene.schema.validation import MisfitError, Place, validated
from glrt.scene.shapes.base import Object
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.twins import shown
from glrt.scene.values import BLACK, LARGEST, Number, Radiance
from glrt.settings import RenderSettings

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


class Scene(SceneFields):
    """The contents of a scene file."""

    @classmethod
    def build(
        cls,
        camera: Camera | Mapping[str, Any],
        objects: Iterable[Shape | Mapping[str, Any]] = (),
        *,
        materials: Mapping[str, Material | Mapping[str, Any]] | None = None,
        background: Background | Mapping[str, Any] | None = None,
        sun: Sun | Mapping[str, Any] | None = None,
        media: Mapping[str, Medium | Mapping[str, Any]] | None = None,
        medium: str | None = None,
        lights: Mapping[str, Number] | None = None,
        animation: Animation | Mapping[str, Any] | None = None,
        render: RenderSettings | Mapping[str, Any] | None = None,
        title: str | None = None,
        folder: str | Path = ".",
    ) -> Self:
        """Build a scene from models such as `glrt.Sphere`, or dicts with the keys of scene files.

        Objects name their material by a key of `materials`. A vector or a colour is a list, a tuple
        or an array of shape (3,); a number may also be one of numpy's. Values that are left out
        have the defaults of scene files. Files that the scene names are read from `folder`. Raises
        `SceneError` with one paragraph that names up to three mistakes, as in a file, and the
        number of others.
        """
        tables = to_tables(
            title=title,
            camera=camera,
            render=render,
            background=background,
            sun=sun,
            materials=materials,
            media=media,
            medium=medium,
            lights=lights,
            animation=animation,
            objects=objects,
        )
        source = "Scene.build"
        return with_files(validated(cls, tables, source), AssetFolder(Path(folder)), source)

    def save(self, path: str | Path) -> None:
        """Write a scene file, with a name in .toml, that `load` reads back as an equal scene.

        Files that the scene names are copied next to it if they are not there. Raises `UsageError`
        for another suffix, and if another file has the name of a copy. Raises `RenderError` if a
        file cannot be written: an existing one is then unchanged.
        """
        file = Path(path)
        if file.suffix.lower() != ".toml":
            raise UsageError(f"Cannot write {path}: the name of a scene file must end in .toml.")
        copy_files(self, file.parent)
        write_text(file, toml_text(self))

    @property
    def frames(self) -> int:
        """Number of frames of its animation; 1 without one."""
        return self.animation.count if self.animation else 1

    def at_frame(self, number: int) -> Self:
        """Return the still at a frame of the animation, from 0, with the values of that moment.

        Raises `UsageError` for a frame that the animation lacks, and `SceneError` if a curve leaves
        the range of its value between two keys.
        """
        if not 0 <= number < self.frames:
            has = f"frames 0 to {self.frames - 1}" if self.animation else "frame 0 alone"
            raise UsageError(f"there is no frame {number}: the scene has {has}")
        if self.animation is None:
            return self
        moment = self.animation.moment(number)
        values = {track.keys: track.at(moment) for track in self.animation.tracks}
        return with_values(self.still, values, f"frame {number}")

    @property
    def still(self) -> Self:
        """The scene without its animation, with the values that it holds itself."""
        return self.model_copy(update={"animation": None}) if self.animation else self

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

    def emission_of_medium(self, name: str) -> Radiance:
        """Return the radiance of a medium per unit of length, its group's intensity included."""
        return _scaled(self.media[name].emission, self._intensity(media_group(name)))

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

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        nesting = nesting_problems(self.materials, self.visible)
        lights = [*sun_problems(self), *_light_problems(self)]
        things = [*object_problems(self), *medium_problems(self)]
        problems = [*things, *nesting, *lights, *_emptiness(self)]
        if self.animation:
            problems += animation_problems(self, self.light_groups)
        if problems:
            raise MisfitError(problems)
        return self


def with_lights(scene: Scene, intensities: Mapping[str, float]) -> Scene:
    """Return the scene with other intensities of some light groups.

    Raises `SceneError` for a group that the scene lacks and for an intensity out of range.
    """
    groups = sorted(scene.light_groups)
    for group, intensity in intensities.items():
        if group not in groups:
            raise SceneError(f"Lights: {unknown('light group', group, groups)}")
        if not 0 <= intensity <= LARGEST:
            raise SceneError(
                f"The intensity of light group {quoted(group)} must be a number from 0 to "
                f"{number(LARGEST)}, got {number(intensity)}."
            )
    lights = scene.lights | {group: float(value) for group, value in intensities.items()}
    relit = scene.model_copy(update={"lights": lights})
    for place, text in _light_problems(relit):
        raise SceneError(f"Light group {quoted(str(place[1]))}: {text}.")
    return relit


def _scaled(color: Radiance, factor: float) -> Radiance:
    return (color[0] * factor, color[1] * factor, color[2] * factor)


def _light_problems(scene: Scene) -> Iterator[tuple[Place, str]]:
    for name, material in scene.materials.items():
        group = getattr(material, "group", None) or (name if material.emits else None)
        if group == SKY_GROUP:
            yield ("materials", name, "group"), _SKY_ADVICE
    for index, thing in enumerate(scene.objects):
        if thing.group == SKY_GROUP:
            yield ("objects", index, "group"), _SKY_ADVICE
    groups = scene.light_groups
    for finish in scene.finishes:
        if max(scene.emission(finish)) > LARGEST:
            what = f"emission of material {quoted(finish.material)}"
            yield ("lights", finish.group), _too_bright(what)
    dark = {thing.group for thing in scene.objects}  # groups of objects that may emit later
    for group in scene.lights:
        if group not in groups and group not in dark:
            yield ("lights", group), unknown("light group", group, sorted(groups))
    if max(scene.sun_radiance) > LARGEST:
        yield ("lights", SUN_GROUP), _too_bright("radiance of the sun")
    if max(map(max, scene.background_colors)) > LARGEST:
        yield ("lights", SKY_GROUP), _too_bright("radiance of the background")


_SKY_ADVICE = (
    "must not be 'background', the light group of the background; give the lamp another group, so "
    "that each can be dimmed on its own"
)


def _too_bright(what: str) -> str:
    return f"the intensity times the {what} must be at most {number(LARGEST)}; lower one of them"


def _emptiness(scene: Scene) -> Iterator[tuple[Place, str]]:
    shines = scene.sun or any(map(any, scene.background.gradient)) or _glows(scene)
    if not scene.visible and not shines:
        yield (), "there is nothing to see: add an object, or a background that is not black"


def _glows(scene: Scene) -> bool:
    return scene.medium in scene.media and scene.media[scene.medium or ""].emits
