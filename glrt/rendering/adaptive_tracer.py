"""A tracer whose pixels get samples in proportion to their noise (glrt/image/allotment.py).

A dispatch adds the same number of samples to each pixel of a list, from the pixel's next one on.
Pixels that are not listed cost nothing, and lanes of the driver stay full. Up to the floor, all
pixels are listed. Then a frame raises the mean. It begins with a copy of the film, to which its
dispatches add: first a unit for each pixel that needs one, then a second one, and so on.
"""

import time

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import RenderError
from glrt.gpu.program import TILE, Images, Pace, Resource, tile_count
from glrt.image.allotment import Counts, counts_of, floor_of, shares_of, unit_of
from glrt.plan.plan import Plan
from glrt.rendering.film import Film
from glrt.rendering.kernel_switch import KernelSwitch
from glrt.rendering.pass_film import Size
from glrt.rendering.pipelines import Fast
from glrt.rendering.schedule import (
    HEADLESS,
    DispatchPolicy,
    DispatchRange,
    Schedule,
    iterations_per_sample,
    stride_of,
)
from glrt.rendering.tracer import Tracer
from glrt.settings import Settings

GROUP = TILE * TILE  # pixels of a work group
HEAD = 2  # uint32 in front of the list of the kernel
Places = NDArray[np.uint32]


class _Copy:
    """The frame that is under way: dispatches read and write its textures."""

    def __init__(self, film: Film, begun: int) -> None:
        """`begun`: samples that the listed pixels got in this frame."""
        self._film, self.samples, self.next_sample = film, film.samples, begun

    def images(self) -> Images:
        """The textures by the names of the kernel's images: sources are the targets."""
        images = self._film.images()
        targets = {name: it for name, it in images.items() if name.startswith("target_")}
        return {name.replace("target_", "source_", 1): it for name, it in targets.items()} | targets


class PixelList:
    """The pixels that a dispatch adds samples to, in a buffer of the kernel."""

    def __init__(self, gl: moderngl.Context, size: Size) -> None:
        """List all pixels, tile by tile in the order of dispatches; RenderError without room."""
        self._order = _tile_order(size)
        try:
            self.buffer = gl.buffer(reserve=4 * (HEAD + 2 * self._order.size))
        except moderngl.Error as error:
            raise RenderError(f"the driver has no room for a list of pixels: {error}") from error
        self._is_whole = False
        self.list_all()

    def list_all(self) -> None:
        """List all pixels, which have the samples of the film."""
        if not self._is_whole:
            self._write(self._order, np.zeros_like(self._order))
            self.shorten(self._order.size)
            self._is_whole = True

    def list_missing(self, before: Counts, after: Counts, unit: int) -> list[int]:
        """List the pixels that lack samples, in the order of how many they lack, most first.

        Returns how many lack at least one unit, at least two, and so on.
        """
        lacking = ((after - before) // unit).ravel()[self._order]
        order = np.argsort(-lacking, kind="stable")[: np.count_nonzero(lacking > 0)]
        places, self._is_whole = self._order[order], False
        self._write(places, before.ravel()[places].astype(np.uint32))
        most = int(lacking.max(initial=0))
        return [int(np.count_nonzero(lacking >= number)) for number in range(1, most + 1)]

    def shorten(self, count: int) -> None:
        """Let the next dispatches see the first `count` pixels of the list alone."""
        self.buffer.write(np.array([count, 0], np.uint32))

    def _write(self, places: Places, begun: Places) -> None:
        if places.size:
            rows = np.ascontiguousarray(np.stack([places, begun], axis=1))
            self.buffer.write(rows, offset=4 * HEAD)


class _Frame:
    """The rest of a frame: a unit of samples for each pixel of ever shorter lists."""

    def __init__(self, samples: int, counts: Counts, sizes: list[int], unit: int) -> None:
        self.samples, self.counts = samples, counts  # of the film, when it is complete
        self._sizes, self._unit = sizes, unit
        self._rounds = self._done = 0  # units of samples, and samples of the next one
        self.schedule: Schedule | None = None  # of the next samples

    @property
    def is_complete(self) -> bool:
        """Whether no pixel lacks samples."""
        return self._rounds == len(self._sizes)

    @property
    def listed(self) -> int:
        """Pixels that get the next samples."""
        return self._sizes[self._rounds]

    @property
    def groups(self) -> int:
        """Work groups of these pixels."""
        return -(-self.listed // GROUP)

    @property
    def begun(self) -> int:
        """Samples that these pixels got in this frame."""
        return self._rounds * self._unit + self._done

    @property
    def remaining(self) -> int:
        """Samples that these pixels get in this round."""
        return self._unit - self._done

    def add(self, samples: int) -> None:
        """Note that all listed pixels got samples."""
        self._done += samples
        if self._done == self._unit:
            self._rounds, self._done, self.schedule = self._rounds + 1, 0, None


class AdaptiveTracer(Tracer):
    """Adds samples to all pixels up to a floor, and then where the noise of neighbours is."""

    _frame: _Frame | None = None

    def drop_frame(self) -> None:
        """Discard the frame that is under way."""
        super().drop_frame()
        self._frame = None

    def use_fast(self, tier: Fast) -> bool:
        """Switch to a faster kernel; False if this one is as fast, or if there is none."""
        self.drop_frame()  # the first dispatch writes to it
        return super().use_fast(tier)

    def step(self, samples: int) -> None:
        """Add `samples` to the mean over pixels."""
        self.drop_frame()
        target = self.film.samples + samples
        if self.film.samples < self._floor:
            self._list.list_all()
            super().step(min(target, self._floor) - self.film.samples)
        while self.film.samples < target:
            self._work_on_picture(target - self.film.samples, HEADLESS.limit / 2, HEADLESS)

    def _work_on_picture(self, remaining: int, planned: float, policy: DispatchPolicy) -> None:
        short = self._floor - self.film.samples
        if short > 0:
            self._list.list_all()
            super()._work_on_picture(min(remaining, short), planned, policy)
            return
        most = max(self._unit, int(self.film.samples * policy.share))
        frame = self._frame or self._begun(min(remaining, most))
        if not frame.is_complete:
            self._work_on_frame(frame, planned, policy)
        if self._frame and frame.is_complete:
            self._advance(frame.samples - self.film.samples)
            self.film.counts = frame.counts
            self._frame = None

    def _begun(self, more: int) -> _Frame:
        """Begin a frame that raises the mean by `more` samples."""
        film, settings, unit = self.film, self._plan.settings, self._unit
        if not film.shares.size:
            floor = film.read()
            film.shares = shares_of(floor.mean, floor.variance)
            film.counts = np.full(film.shares.shape, film.samples, np.int32)
        samples = film.samples + more
        counts = np.maximum(counts_of(film.shares, samples, settings), film.counts)
        sizes = self._list.list_missing(film.counts, counts, unit)
        film.copy_to_targets()
        self._frame = _Frame(samples, counts, sizes, unit)
        return self._frame

    def _work_on_frame(self, frame: _Frame, planned: float, policy: DispatchPolicy) -> None:
        """Run one dispatch of a frame."""
        if not frame.schedule:
            frame.schedule = Schedule(frame.groups, self.most_samples, self._rounds_of_sample)
            frame.schedule.follow(self._pace)
            self._list.shorten(frame.listed)
        part = frame.schedule.next_dispatch(frame.remaining, planned, self.film.samples, policy)
        copy, start = _Copy(self.film, frame.begun), time.perf_counter()
        kernel, groups = self.switch.kernel, frame.groups
        self.device_scene.dispatch(kernel, copy, self._plan, part, groups, self._own(part))
        self._context.finish()
        if not self._fits(part.samples):
            self.drop_frame()
        elif frame.schedule.record(part, time.perf_counter() - start):
            frame.add(part.samples)

    def _own(self, part: DispatchRange) -> dict[str, Resource]:
        return super()._own(part) | {"List": self._list.buffer}

    def _compiled(self) -> KernelSwitch:
        settings: Settings = self._plan.settings
        self._floor, self._unit = floor_of(settings), unit_of(settings)
        self._rounds_of_sample = iterations_per_sample(self._plan)
        self._list = PixelList(self._context.gl, settings.size)
        try:
            return super()._compiled()
        except RenderError:
            self._list.buffer.release()
            raise

    @property
    def _pace(self) -> Pace:
        return self.switch.kernel.pace

    def _release_own(self) -> None:
        super()._release_own()
        self._list.buffer.release()


def kind_of(plan: Plan) -> type[Tracer]:
    """The tracer that a plan needs."""
    return AdaptiveTracer if plan.needs.adaptive else Tracer


def _tile_order(size: Size) -> Places:
    """Pixels as x + width y, tile by tile, with the tiles in the order of dispatches."""
    width, height = size
    tiles = tile_count(width, height)
    columns = -(-width // TILE)
    tile = np.arange(tiles, dtype=np.int64) * stride_of(tiles) % tiles
    inside = np.arange(GROUP)
    x = TILE * (tile % columns)[:, None] + inside % TILE
    y = TILE * (tile // columns)[:, None] + inside // TILE
    return np.asarray((x + width * y)[(x < width) & (y < height)], np.uint32)
