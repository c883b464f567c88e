"""A scene as a frozen value, and the checks that its parts fit together."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Self

from pydantic import model_validator

from glrt.core.errors import SceneError, UsageError
from glrt.core.files import write_text
from glrt.core.text import number, quoted, unknown
from glrt.scene.animation.tracks import Animation
from glrt.scene.camera import Camera
from glrt.scene.files.assets import AssetFolder
from glrt.scene.frames import animation_problems, with_values
from glrt.scene.lights.background import Background
from glrt.scene.lights.sun import Sun
from glrt.scene.lit_scene import SKY_GROUP, SUN_GROUP, LitScene
from glrt.scene.loading.file_copies import copy_files
from glrt.scene.loading.scene_files import with_files
from glrt.scene.materials.kinds import Material
from glrt.scene.medium import Medium
from glrt.scene.misfits import medium_problems, object_problems, sun_problems
from glrt.scene.nesting import nesting_problems
from glrt.scene.schema.tables import to_tables, toml_text
from glrt.scene.schema.validation import MisfitError, Place, validated
from glrt.scene.shapes.kinds import Shape
from glrt.scene.values import LARGEST, Number
from glrt.scene.volumes import has_ranks
from glrt.settings import RenderSettings


class Scene(LitScene):
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
        """Return a frame of the animation, from 0, with the values of its moment.

        It is a still, unless the shutter is open: then it keeps what moves, in an animation of one
        frame. Raises `UsageError` for a frame that the animation lacks, and `SceneError` if a curve
        leaves the range of its value between two keys.
        """
        if not 0 <= number < self.frames:
            has = f"frames 0 to {self.frames - 1}" if self.animation else "frame 0 alone"
            raise UsageError(f"there is no frame {number}: the scene has {has}")
        if self.animation is None:
            return self
        moment = self.animation.moment(number)
        still = self._at(moment, f"frame {number}")
        begun = self.animation.model_copy(update={"start": moment})
        return still.model_copy(update={"animation": begun}).exposed

    def in_shutter(self, share: float) -> Self:
        """Return the still at a share, 0 to 1, of the time for which the shutter is open.

        It opens at frame 0. Raises `SceneError` if a curve leaves the range of its value.
        """
        if self.animation is None:
            return self
        return self._at(self.animation.moment(share * self.camera.shutter), "with the shutter open")

    def _at(self, moment: float, source: str) -> Self:
        tracks = self.animation.tracks if self.animation else ()
        return with_values(self.still, {it.keys: it.at(moment) for it in tracks}, source)

    @property
    def is_blurred(self) -> bool:
        """Whether the shutter is open while something changes."""
        return bool(self.camera.shutter and self.animation and self.animation.tracks)

    @property
    def exposed(self) -> Self:
        """Frame 0 with the values that the scene holds: a still, or with what the shutter blurs."""
        if not (self.is_blurred and self.animation):
            return self.still
        return self.model_copy(
            update={"animation": self.animation.model_copy(update={"frames": 1})}
        )

    @property
    def moved(self) -> list[tuple[str, ...]]:
        """The keys of each value that its animation changes."""
        return [track.keys for track in self.animation.tracks] if self.animation else []

    @property
    def still(self) -> Self:
        """The scene without its animation, with the values that it holds itself."""
        return self.model_copy(update={"animation": None}) if self.animation else self

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        nesting = [] if has_ranks(self) else nesting_problems(self.materials, self.visible)
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
    glows = any(scene.media[name].emits for name in scene.media_in_use)
    shines = scene.sun or any(map(any, scene.background.gradient)) or glows
    if not scene.visible and not shines:
        yield (), "there is nothing to see: add an object, or a background that is not black"
