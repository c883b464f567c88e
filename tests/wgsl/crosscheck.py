"""Both versions stage by stage, and how far they agree: a difference shows where it arose."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.support.ulps import ulps, words
from tests.wgsl.device import Device
from tests.wgsl.display import DisplayPass
from tests.wgsl.program import RayTracer
from tests.wgsl.stages import STAGE, WgslStages, glsl_stages
from tests.wgsl.text import Fault
from tests.wgsl.tracer import Tracer

Array = np.ndarray[Any, Any]
Record = Mapping[str, list[Array]]  # of each stage, arrays (H, W, n)

FRAMES = 16


class Agreement(NamedTuple):
    """How far two versions agree in a stage."""

    stage: str
    identical: float  # share of the pixels whose every bit is the same
    distance: int  # the largest difference: in ulps, in the display pass of 255


class WgslVersion:
    """The thesis's tracer, compiled once for all scenes."""

    def __init__(self, device: Device, *faults: Fault, tracer: type[Tracer] = Tracer) -> None:
        """Compile; `faults` are planted into the text, `tracer` may be one with other faults."""
        self._stages = WgslStages(device, *faults)
        self._raytracer = RayTracer(device, *faults)
        self._display = DisplayPass(device, *faults)
        self._tracer = tracer

    def record(self, scene: Scene, settings: Settings) -> Record:
        """All stages of a scene."""
        tracer = self._tracer(self._raytracer, scene, settings)
        first, last = tracer.render(1).image(), tracer.render(FRAMES).image()
        shown = self._display.codes(tracer.picture, settings)
        return _record(self._stages.run(scene, settings), first, last, shown)


def glsl_record(context: Context, scene: Scene, settings: Settings) -> Record:
    """All stages of a scene by the kernel."""
    stages = glsl_stages(context, scene, settings)
    renderer = Renderer(scene, settings, context)
    first, last = renderer.render(1).image(), renderer.render(FRAMES).image()
    shown = renderer.display()
    renderer.release()
    return _record(stages, first, last, shown)


def agreements(one: Record, other: Record) -> Iterator[Agreement]:
    """Stage by stage, from the first random number to the colours of the screen."""
    for stage, parts in one.items():
        pairs = list(zip(parts, other[stage], strict=True))
        same = np.logical_and.reduce([_is_same(a, b) for a, b in pairs])
        distance = max(int(_distance(a, b).max()) for a, b in pairs)
        yield Agreement(stage, float(same.mean()), distance)


def flipped(one: Array, other: Array) -> float:
    """Share of the pixels of one sample that differ by more than 1 %: another branch was taken."""
    apart = np.abs(one - other) > 0.01 * np.maximum(np.abs(one), np.abs(other))
    return float(apart.any(axis=-1).mean())


def relative_rms(one: Array, other: Array, independent: Array) -> float:
    """Difference of two pictures in the noise between the second and one of another seed."""
    return float(np.linalg.norm(one - other) / np.linalg.norm(independent - other))


def _record(stages: Array, first: Image, last: Image, shown: Array) -> Record:
    traced = {
        stage: [_as_planes(stages[stage][part]) for part in STAGE[stage].names or ()]
        for stage in STAGE.names or ()
    }
    images = {
        name: [image.radiance, image.stderr]
        for name, image in (("1 sample", first), (f"{FRAMES} samples", last))
    }
    return {**traced, **images, "display": [shown]}


def _as_planes(part: Array) -> Array:
    planes: Array = part.reshape(*part.shape[:2], -1)
    return planes


def _is_same(a: Array, b: Array) -> Array:
    same: Array = (a == b if a.dtype == np.uint8 else words(a) == words(b)).all(axis=-1)
    return same


def _distance(a: Array, b: Array) -> Array:
    if a.dtype == np.float32:
        return ulps(a, b)
    apart: Array = np.abs(a.astype(np.int64) - b.astype(np.int64))
    return apart if a.dtype == np.uint8 else apart != 0
