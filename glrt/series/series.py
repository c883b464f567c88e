"""The frames of a series: of an animation, of a turntable, or of sweeps."""

import itertools
import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from glrt.core.errors import UsageError
from glrt.core.text import number
from glrt.scene.camera import Camera
from glrt.scene.frames import with_phong_of, with_values
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import sine_and_cosine
from glrt.series.motion import Motion, motion_of
from glrt.series.sweeps import Sweep, is_setting, is_whole, setting_changes
from glrt.settings import Settings, settings_for

TURN = 360.0  # degrees
SHUTTER = ("camera", "shutter")
SEEDS = 1 << 32


class Still(NamedTuple):
    """A frame as a scene and settings, with a label for people."""

    scene: Scene
    settings: Settings
    label: str
    motion: Motion = "shapes"  # from frame to frame of its series


@dataclass(frozen=True)
class Series:
    """Frames of a scene, from 0: of its animation, of `turns` round it, or of sweeps.

    With `varies_seed` each frame has a seed of its own: the settings' plus its number.
    """

    scene: Scene
    settings: Settings
    turns: int | None = None  # frames of a turntable
    sweeps: tuple[Sweep, ...] = ()  # the last one changes fastest
    varies_seed: bool = False
    steps: tuple[tuple[int, ...], ...] = field(init=False)  # of sweeps, for each frame

    def __post_init__(self) -> None:
        """List the steps of all sweeps."""
        steps = itertools.product(*(range(sweep.steps) for sweep in self.sweeps))
        object.__setattr__(self, "steps", tuple(steps) if self.sweeps else ())

    @property
    def count(self) -> int:
        """The number of frames."""
        return len(self.steps) or self.turns or self.scene.frames

    @cached_property
    def motion(self) -> Motion:
        """Whether places or sizes of shapes change from frame to frame, or neither."""
        if self.turns is not None:
            return motion_of(self.scene, [("camera", "position")])
        keys = [sweep.keys for sweep in self.sweeps] or self.scene.moved
        return motion_of(self.scene, keys)

    def columns(self, count: int) -> int:
        """Return columns of a sheet: steps of the second of two sweeps, else a near square."""
        if len(self.sweeps) > 1:
            return min(self.sweeps[-1].steps, count)
        return math.ceil(math.sqrt(count))

    @property
    def idle_shutter(self) -> str:
        """A caution about an open shutter that blurs nothing, since no frame moves; else ""."""
        is_still = bool(self.sweeps) or self.turns is not None
        if not (is_still and self.scene.animation and self.scene.camera.shutter):
            return ""
        kind = "sweep" if self.sweeps else "turntable"
        return (
            f"camera.shutter {number(self.scene.camera.shutter)} blurs nothing: a frame of a "
            f"{kind} shows a moment of the [animation]. Leave out --{kind} to film what moves, or "
            "leave out the shutter."
        )

    def check(self) -> None:
        """Raise the errors of `still` for the steps of sweeps; animations check their keys.

        Raises `UsageError` for a whole number that takes a step with a fraction.
        """
        for sweep in self.sweeps:
            if sweep.keys == SHUTTER:
                raise UsageError(
                    f"--sweep {sweep.text}: all frames would be equal, as a frame of a sweep shows "
                    "a moment, which a shutter does not blur. Give the shutter in the scene file, "
                    "and film its [animation] without --sweep."
                )
            if sweep.broken is not None and is_whole(self.scene, sweep.keys):
                raise UsageError(
                    f"--sweep {sweep.text}: {sweep.name} is a whole number, and a step would be "
                    f"{number(sweep.broken)} there. The nearest sweep of whole steps is --sweep "
                    f"{sweep.whole}."
                )
        for frame in range(len(self.steps)):
            self.still(frame)

    def still(self, number: int) -> Still:
        """Return a frame.

        Raises `SceneError` for values out of range and `UsageError` for such settings.
        """
        settings = self.settings
        if self.varies_seed:
            settings = settings_for(settings, seed=(settings.seed + number) % SEEDS)
        if self.sweeps:
            return self._swept(number, settings)
        if self.turns is None:
            scene = self.scene.at_frame(number)
            settings = with_phong_of(scene, self.scene.moved, settings)
            return Still(scene, settings, self._moment(number), self.motion)
        scene = self.scene.at_frame(0).still
        degrees = TURN * number / self.turns
        camera = turned(scene.camera, degrees)
        scene = scene.model_copy(update={"camera": camera})
        return Still(scene, settings, f"{degrees:g} degrees", self.motion)

    def _moment(self, number: int) -> str:
        animation = self.scene.animation
        return f"{animation.moment(number):.4g} s" if animation else "still"

    def _swept(self, number: int, settings: Settings) -> Still:
        steps = self.steps[number]
        pairs = list(zip(self.sweeps, steps, strict=True))
        label = ", ".join(sweep.label(step) for sweep, step in pairs)
        values: dict[tuple[str, ...], Any] = {s.keys: s.value(step) for s, step in pairs}
        changes = setting_changes(values)
        of_scene = {keys: value for keys, value in values.items() if not is_setting(keys)}
        first = self.scene.at_frame(0).still
        scene = with_values(first, of_scene, f"frame {number}")
        settings = with_phong_of(scene, of_scene, settings_for(settings, **changes))
        return Still(scene, settings, label, self.motion)


def chosen(count: int, frames: tuple[int, int] | None) -> range:
    """Return the numbers of the frames to render, first and last given; UsageError beyond."""
    first, last = frames or (0, count - 1)
    if last >= count:
        raise UsageError(f"--frames {first}-{last}: the series has frames 0 to {count - 1}.")
    return range(first, last + 1)


def turned(camera: Camera, degrees: float) -> Camera:
    """Return the camera turned about the axis `up` through the point it looks at.

    Seen from above it moves counter-clockwise; 0 degrees leave it as it is, bit for bit.
    """
    if degrees == 0:
        return camera
    axis = np.array(camera.up) / np.linalg.norm(camera.up)
    arm = np.array(camera.position) - np.array(camera.look_at)
    sine, cosine = sine_and_cosine(degrees)
    along = (arm @ axis) * axis
    moved = along + cosine * (arm - along) + sine * np.cross(axis, arm)  # Rodrigues' formula
    x, y, z = (float(value) for value in np.array(camera.look_at) + moved)
    return camera.model_copy(update={"position": (x, y, z)})


def describe(series: Series) -> dict[str, Any]:
    """Return what makes the series, as plain values for the recipe of a film."""
    if series.sweeps:
        rows = [[s.name, list(s.start), list(s.end), s.steps] for s in series.sweeps]
        return {"sweep": rows}
    if series.turns is not None:
        return {"turntable": series.turns}
    return {"animation": series.count}
