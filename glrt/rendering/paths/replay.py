"""Trace samples of single pixels again, and record all that happens on their paths.

The text of the path tracer is that of a render. So are the random numbers, which depend on seed,
sampler, place of the pixel and number of the sample. Software drivers therefore give the same bits.
"""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from glrt.core.errors import ContextError, UsageError
from glrt.core.version import VERSION
from glrt.gpu.context import Choice, Context, open_context
from glrt.image.particle_film import observations_of
from glrt.image.recipe import Recipe
from glrt.plan.combinations import check_render
from glrt.plan.methods import METHODS, traits_of
from glrt.plan.particles import GROUP as PARTICLE_GROUP
from glrt.plan.particles import particle_groups
from glrt.plan.plan import Plan, prepare
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.passes import PARTICLE_PATHS, PATHS
from glrt.rendering.paths.recorder import TOGETHER, PathRecorder, Pixel
from glrt.rendering.paths.records import particle_of, paths_of
from glrt.rendering.paths.values import NUMBERS, Path, PixelParticles, PixelPaths
from glrt.rendering.pipelines import KernelOptions, Tier
from glrt.rendering.schedule import dispatch_limits
from glrt.scene.instancing import Apart
from glrt.scene.scene import Scene
from glrt.settings import Settings

Array = np.ndarray[Any, Any]

LOST = NUMBERS["END_CUT_LOOP"]
FOLLOWED = 1 << 16  # particles of a dispatch


class PathReplay:
    """Traces samples of a plan again.

    `scene` is the plan's scene on the driver; its owner releases it. The plan's crop has no effect:
    pixels are numbered in the full frame.
    """

    def __init__(self, context: Context, plan: Plan, scene: DeviceScene) -> None:
        """Compile the kernels; UsageError for a method without recorded paths, or RenderError."""
        check_followed(plan)
        self._plan = plan
        self._paths = PathRecorder(context, plan, scene, PATHS)
        self._particles: PathRecorder | None = None
        if plan.settings.caustics == "on":
            with ExitStack() as refused:
                refused.callback(self._paths.release)
                self._particles = PathRecorder(context, plan, scene, PARTICLE_PATHS)
                refused.pop_all()

    def radiances(self, pixel: Pixel, samples: int) -> Array:
        """Radiance of the samples 0 to `samples` - 1, (samples, 3) float32; NaN for a lost one."""
        found = np.empty((samples, 3), np.float32)
        for first in range(0, samples, TOGETHER):
            count = min(TOGETHER, samples - first)
            batch = self._paths.records(pixel, first, count, vertices=False, lights=False)
            is_lost = batch.samples["end"][:, None] == LOST
            found[first : first + count] = np.where(is_lost, np.nan, batch.samples["radiance"])
        return found

    def paths(self, pixel: Pixel, numbers: Sequence[int]) -> tuple[Path, ...]:
        """The paths of the samples with these numbers, in this order."""
        found: dict[int, Path] = {}
        for first, count in _runs(sorted(set(numbers))):
            batch = self._paths.records(pixel, first, count)
            for path in paths_of(self._plan.scene, first, *batch):
                found[path.sample] = path
        return tuple(found[number] for number in numbers)

    def particles(self, pixel: Pixel) -> PixelParticles | None:
        """All particles of all samples that reach the pixel, without their paths; None without any.

        The samples make whole observations, as in a render.
        """
        if self._particles is None:
            return None
        samples, points = self._plan.settings.samples, self._plan.settings.division.points
        samples = points * observations_of(samples, points)
        return arrived([*self.arriving(pixel, samples)])

    def arriving(self, pixel: Pixel, samples: int) -> Iterator[Array]:
        """Yield the records for `arrived`, one array for each sample; nothing without particles."""
        count = self._particle_count if self._particles else 0
        for sample in range(samples if self._particles else 0):
            found = []
            for lane in range(0, count, FOLLOWED):
                lanes = lane, min(lane + FOLLOWED, count)
                assert self._particles
                batch = self._particles.records(pixel, sample, 1, lanes, vertices=False)
                found.append(batch.lights)
            yield np.concatenate(found)

    def particle_path(self, pixel: Pixel, sample: int, number: int) -> Path | None:
        """The path of a particle by its sample and number; None if it does not arrive."""
        if self._particles is None or number >= self._particle_count:
            return None
        batch = self._particles.records(pixel, sample, 1, (number, number + 1))
        if not len(batch.lights):
            return None
        return particle_of(self._plan.scene, sample, number, batch.vertices, batch.lights)

    @property
    def _particle_count(self) -> int:
        """Number of particles for one sample of all pixels of the frame."""
        return PARTICLE_GROUP * particle_groups(self._plan.settings)

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._paths.release()
        if self._particles:
            self._particles.release()


def arrived(records: Sequence[Array]) -> PixelParticles:
    """The particles that reach a pixel and what each brings; `records` has those of each sample."""
    lights = np.concatenate(records)
    lights = lights[np.isfinite(lights["added"]).all(axis=1)]
    lights = lights[np.lexsort((lights["number"], lights["lane"], lights["sample_index"]))]
    names = zip(lights["sample_index"].tolist(), lights["lane"].tolist(), strict=True)
    brought: dict[tuple[int, int], Array] = {}
    for name, light in zip(names, lights, strict=True):
        brought[name] = brought.get(name, np.zeros(3, np.float32)) + light["added"]
    radiances = np.array([*brought.values()], np.float32).reshape(-1, 3)
    return PixelParticles(len(records), tuple(brought), radiances, ())


def check_followed(plan: Plan) -> None:
    """Raise UsageError for a method or a scene whose paths are not recorded."""
    settings = plan.settings
    if settings.adaptive == "on":
        raise UsageError(
            "Paths are not recorded with --adaptive on, where pixels have counts of their own: "
            "give --adaptive off, by which the first samples are the same."
        )
    if METHODS[settings.method].model:
        raise UsageError(
            f"paths are not shown of the method {settings.method}: it is a lighting model, which "
            "sums over all lamps where it ends. Choose naive, nee or mis."
        )
    if METHODS[settings.method].rasters:
        raise UsageError(
            f"paths are not shown of the method {settings.method}: they begin where a raster finds "
            "surfaces. Choose naive, nee or mis."
        )
    if traits_of(settings).has_probes:
        raise UsageError(
            f"paths are not shown of the method {settings.method}: they end where probes give the "
            "rest of the light. Choose naive, nee or mis."
        )


def check_pixel(pixel: Pixel, settings: Settings) -> None:
    """Raise UsageError for a pixel outside the picture or crop of these settings."""
    left, top, width, height = settings.crop or (0, 0, settings.width, settings.height)
    x, y = pixel
    if left <= x < left + width and top <= y < top + height:
        return
    what = "crop" if settings.crop else "picture"
    raise UsageError(
        f"the pixel {x} {y} is not in the {what}: columns are {left} to {left + width - 1}, from "
        f"the left, and rows {top} to {top + height - 1}, from the top of the whole picture."
    )


@contextmanager
def path_replay(
    scene: Scene,
    settings: Settings,
    context: Context | Choice = "auto",
    tier: Tier = "complete",
    apart: Apart = "repeated",
) -> Iterator[tuple[PathReplay, Recipe]]:
    """Open a replay of a scene, and yield it with the recipe of what it traces.

    Raises ContextError without OpenGL 4.3, UsageError, RenderError, and SceneError for a scene
    beyond the driver.
    """
    plan = prepare(scene, settings, apart=apart)
    check_followed(plan)
    check_render(plan.facts, settings, "none", False, False)
    with ExitStack() as stack:
        if not isinstance(context, Context):
            context = open_context(context)
            stack.callback(context.gl.release)
        check_context(context)
        stack.enter_context(context.gl)
        dispatch_limits(context, plan)
        device_scene = DeviceScene(context, plan, KernelOptions("compute", tier))
        stack.callback(device_scene.release)
        replay = PathReplay(context, plan, device_scene)
        stack.callback(replay.release)
        recipe = Recipe(
            scene=scene,
            settings=settings,
            samples=settings.samples,
            version=VERSION,
            renderer=context.renderer,
            tier=device_scene.tier,
            apart="large" if apart == "large" else "repeated",
        )
        yield replay, recipe


def check_context(context: Context) -> None:
    """Raise ContextError for an OpenGL that has the fragment pipeline alone."""
    if not context.has_compute:
        raise ContextError(
            f"paths cannot be recorded by the fragment pipeline: {context.renderer} offers OpenGL "
            f"{context.version}, and compute shaders with storage buffers need 4.3."
        )


class Selection(NamedTuple):
    """The paths of a pixel that are wanted."""

    numbers: Sequence[int] | None = None  # of samples; None: all
    brightest: int = 0  # in place of the numbers: samples with most light, brightest first
    particles: int = 64  # the particles that bring most light


ALL = Selection()


def pixel_paths(
    scene: Scene,
    settings: Settings,
    pixel: Pixel,
    wanted: Selection = ALL,
    context: Context | Choice = "auto",
    tier: Tier = "complete",
) -> PixelPaths:
    """The radiance of all samples of a pixel, and the paths of some of them."""
    check_selection(pixel, wanted, settings)
    with path_replay(scene, settings, context, tier) as (replay, recipe):
        return selected_paths(replay, recipe, pixel, wanted)


def check_selection(pixel: Pixel, wanted: Selection, settings: Settings) -> None:
    """Raise UsageError for a pixel outside the picture, or a sample that does not exist."""
    check_pixel(pixel, settings)
    check_samples(wanted.numbers or (), settings)


def selected_paths(
    replay: PathReplay, recipe: Recipe, pixel: Pixel, wanted: Selection
) -> PixelPaths:
    """The radiance of all samples of a pixel, and the paths of some of them, by an open replay."""
    samples = recipe.settings.samples
    found = PixelPaths(recipe, pixel, replay.radiances(pixel, samples), ())
    if wanted.brightest:
        numbers: Sequence[int] = found.brightest(wanted.brightest)
    else:
        numbers = range(samples) if wanted.numbers is None else wanted.numbers
    arriving = replay.particles(pixel)
    if arriving:
        names = arriving.brightest(wanted.particles)
        traced = (replay.particle_path(pixel, *name) for name in names)
        arriving = replace(arriving, paths=tuple(path for path in traced if path))
    return replace(found, paths=replay.paths(pixel, numbers), particles=arriving)


def check_samples(numbers: Sequence[int], settings: Settings) -> None:
    """Raise UsageError for the number of a sample that does not exist."""
    for number in numbers:
        if not 0 <= number < settings.samples:
            raise UsageError(
                f"there is no sample {number}: the pixel has {settings.samples}, numbered from 0 "
                f"to {settings.samples - 1}. Ask for another, or for more --samples."
            )


def _runs(numbers: Sequence[int]) -> Iterator[tuple[int, int]]:
    """First number and length of runs of consecutive numbers, at most TOGETHER long."""
    start = 0
    for end in range(1, len(numbers) + 1):
        is_next = end < len(numbers) and numbers[end] == numbers[end - 1] + 1
        if not is_next or end - start == TOGETHER:
            yield numbers[start], end - start
            start = end
