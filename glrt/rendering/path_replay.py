"""Samples of single pixels traced again, with all that happens on their paths.

The path text is that of a render, and so are the random numbers, which hang on seed, sampler, place
of the pixel and number of the sample: on software drivers the same bits come out.
"""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

import moderngl
import numpy as np

from glrt.errors import ContextError, RenderError, UsageError
from glrt.gpu.context import Choice, Context, open_context
from glrt.gpu.program import Images, Resource
from glrt.image.recipe import Recipe
from glrt.methods.combinations import check_render
from glrt.methods.light_layers import Plan, plan_for
from glrt.methods.table import METHODS
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.kernel_switch import AnyKernel, ready
from glrt.rendering.passes import PATHS
from glrt.rendering.path_records import RECORDS, paths_of
from glrt.rendering.path_values import NUMBERS, Path, PixelPaths
from glrt.rendering.pipelines import KernelOptions, Tier
from glrt.rendering.schedule import DispatchRange
from glrt.rendering.tracer import dispatch_limits
from glrt.scene.own_trees import Apart
from glrt.scene.scene import Scene
from glrt.settings import Settings
from glrt.version import VERSION

Array = np.ndarray[Any, Any]
Pixel = tuple[int, int]  # column and row in the full frame, from 0, row 0 on top

GROUP = 32  # samples of a work group, as paths.comp has it
TOGETHER = 512  # samples of a dispatch
HEAD = 32  # bytes of the block before its samples
LOST = NUMBERS["END_CUT_LOOP"]
FIRST_ROWS = 4096  # of vertices and of lights, until more are needed


class Batch(NamedTuple):
    """Samples from number `first` on: their records, those of vertices and lights in any order."""

    first: int
    samples: Array
    vertices: Array
    lights: Array


@dataclass
class _Numbered:
    """What a dispatch sees in place of a film: the number of its first sample."""

    next_sample: int
    samples: int = 0

    def images(self) -> Images:
        return {}


class PathReplay:
    """Traces samples of a plan again; `scene` is that of the plan on the driver, and stays its own.

    The plan's crop is of no matter: pixels are numbered in the full frame.
    """

    def __init__(self, context: Context, plan: Plan, scene: DeviceScene) -> None:
        """Compile; UsageError where paths are not recorded, RenderError as ever."""
        check_method(plan.settings)
        self._context, self._plan, self._scene = context, plan, scene
        self._buffers: dict[str, moderngl.Buffer] = {}
        with ExitStack() as refused:
            refused.callback(self._release_buffers)
            self._reserve("Vertices", FIRST_ROWS)
            self._reserve("Lights", FIRST_ROWS)
            self._hold("Replay", HEAD + TOGETHER * RECORDS["SampleRecord"].itemsize)
            shaders = scene.shaders_of(PATHS)
            self._kernel: AnyKernel = ready(context, shaders, self._dispatch_none)
            refused.pop_all()

    def radiances(self, pixel: Pixel, samples: int) -> Array:
        """What the samples 0 to `samples` - 1 bring, (samples, 3) float32; NaN: it is lost."""
        found = np.empty((samples, 3), np.float32)
        for first in range(0, samples, TOGETHER):
            count = min(TOGETHER, samples - first)
            records = self._replayed(pixel, first, count, wants_records=False).samples
            is_lost = records["end"] == LOST
            found[first : first + count] = np.where(is_lost[:, None], np.nan, records["radiance"])
        return found

    def paths(self, pixel: Pixel, numbers: Sequence[int]) -> tuple[Path, ...]:
        """The paths of the samples with these numbers, in this order."""
        found: dict[int, Path] = {}
        for first, count in _runs(sorted(set(numbers))):
            batch = self._replayed(pixel, first, count, wants_records=True)
            for path in paths_of(self._plan.scene, *batch):
                found[path.sample] = path
        return tuple(found[number] for number in numbers)

    def release(self) -> None:
        """Free what the driver holds."""
        self._kernel.release()
        self._release_buffers()

    def _replayed(self, pixel: Pixel, first: int, count: int, wants_records: bool) -> Batch:
        """One dispatch, or two where there are more records than room for them."""
        while True:
            rows = [self._rows(name) if wants_records else 0 for name in _KINDS]
            head = np.array([*pixel, 0, 0, *rows, 0, 0], np.uint32)
            self._buffers["Replay"].write(head.tobytes())
            self._dispatch(self._kernel, first, count, -(-count // GROUP))
            self._context.finish()
            counts = np.frombuffer(self._buffers["Replay"].read(HEAD), np.uint32)[2:4]
            if not wants_records or all(counts <= rows):
                break
            for name, needed in zip(_KINDS, counts, strict=True):
                if needed > self._rows(name):
                    self._reserve(name, int(needed))
        samples = self._read("Replay", "SampleRecord", count, HEAD)
        if not wants_records:
            counts = np.zeros(2, np.uint32)
        read = (self._read(n, _KINDS[n], int(c)) for n, c in zip(_KINDS, counts, strict=True))
        return Batch(first, samples, *read)

    def _dispatch(self, kernel: AnyKernel, first: int, count: int, groups: int) -> None:
        part = DispatchRange(count, 0, groups)
        own: dict[str, Resource] = {**self._buffers}
        self._scene.dispatch(kernel, _Numbered(first), self._plan, part, 1, own)

    def _dispatch_none(self, kernel: AnyKernel, part: DispatchRange) -> None:
        self._dispatch(kernel, 0, part.samples, part.tiles)

    def _rows(self, name: str) -> int:
        return int(self._buffers[name].size) // RECORDS[_KINDS[name]].itemsize

    def _reserve(self, name: str, rows: int) -> None:
        self._hold(name, rows * RECORDS[_KINDS[name]].itemsize)

    def _hold(self, name: str, size: int) -> None:
        most = int(self._context.gl.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])
        if size > most:
            raise RenderError(
                f"no room for the records of paths: they take {size >> 20} MiB in one block, and "
                f"this driver grants {most >> 20}. Ask for fewer samples, or fewer bounces."
            )
        with self._context.checked("the records of paths"):
            buffer = self._context.gl.buffer(reserve=size)
        if name in self._buffers:
            self._buffers[name].release()
        self._buffers[name] = buffer

    def _read(self, name: str, record: str, rows: int, offset: int = 0) -> Array:
        dtype = RECORDS[record]
        if not rows:
            return np.zeros(0, dtype)
        return np.frombuffer(self._buffers[name].read(rows * dtype.itemsize, offset=offset), dtype)

    def _release_buffers(self) -> None:
        for buffer in self._buffers.values():
            buffer.release()


_KINDS = {"Vertices": "VertexRecord", "Lights": "LightRecord"}  # blocks, with what they hold


def check_method(settings: Settings) -> None:
    """UsageError for a method whose paths are not recorded."""
    if METHODS[settings.method].model:
        raise UsageError(
            f"paths are not shown of the method {settings.method}: it is a lighting model, which "
            "sums over all lamps where it ends. Choose naive, nee or mis."
        )


def check_pixel(pixel: Pixel, settings: Settings) -> None:
    """UsageError for a pixel that a render with these settings does not have."""
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
    tier: Tier = "baked",
    apart: Apart = "repeated",
) -> Iterator[tuple[PathReplay, Recipe]]:
    """A replay of a scene of its own, and the recipe of what it traces.

    Raises ContextError without OpenGL 4.3, UsageError, RenderError, and SceneError for a scene
    beyond the driver.
    """
    check_method(settings)
    check_render(scene, settings, "none", False, False)
    with ExitStack() as stack:
        if not isinstance(context, Context):
            context = open_context(context)
            stack.callback(context.gl.release)
        check_context(context)
        stack.enter_context(context.gl)
        plan = plan_for(scene, settings, "none", apart=apart)
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
    """ContextError for an OpenGL that has the fragment pipeline alone."""
    if not context.has_compute:
        raise ContextError(
            f"paths cannot be recorded by the fragment pipeline: {context.renderer} offers OpenGL "
            f"{context.version}, and compute shaders with storage buffers need 4.3."
        )


def pixel_paths(
    scene: Scene,
    settings: Settings,
    pixel: Pixel,
    numbers: Sequence[int] | None = None,
    brightest: int = 0,
    context: Context | Choice = "auto",
    tier: Tier = "baked",
    apart: Apart = "repeated",
) -> PixelPaths:
    """What the samples of the settings bring to a pixel, and the paths of some of them.

    Those with these `numbers` (default: all), or the `brightest` so many, the brightest first.
    """
    check_pixel(pixel, settings)
    check_samples(numbers or (), settings)
    with path_replay(scene, settings, context, tier, apart) as (replay, recipe):
        found = PixelPaths(recipe, pixel, replay.radiances(pixel, settings.samples), ())
        if brightest:
            wanted: Sequence[int] = found.brightest(brightest)
        else:
            wanted = range(settings.samples) if numbers is None else numbers
        return PixelPaths(recipe, pixel, found.radiances, replay.paths(pixel, wanted))


def check_samples(numbers: Sequence[int], settings: Settings) -> None:
    """UsageError for the number of a sample that there is none of."""
    for number in numbers:
        if not 0 <= number < settings.samples:
            raise UsageError(
                f"there is no sample {number}: the pixel has {settings.samples}, numbered from 0 "
                f"to {settings.samples - 1}. Ask for another, or for more --samples."
            )


def _runs(numbers: Sequence[int]) -> Iterator[tuple[int, int]]:
    """First and count of runs of neighbours, TOGETHER at most in each."""
    start = 0
    for end in range(1, len(numbers) + 1):
        is_next = end < len(numbers) and numbers[end] == numbers[end - 1] + 1
        if not is_next or end - start == TOGETHER:
            yield numbers[start], end - start
            start = end
