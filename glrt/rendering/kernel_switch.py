"""Kernels of one scene: one that survives edits, and faster ones between edits."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.gpu.programs import AnyKernel
from glrt.rendering.pipelines import Fast, compiled
from glrt.rendering.schedule import DispatchRange, Schedule

Dispatch = Callable[[AnyKernel, DispatchRange], None]


class KernelSwitch:
    """The kernel in use, and the schedule of its dispatches."""

    def __init__(
        self, context: Context, shaders: Sequence[Source], schedule: Schedule, dispatch: Dispatch
    ) -> None:
        """Take the generic kernel; RenderError if the driver refuses it."""
        self._context, self._dispatch = context, dispatch
        start = time.perf_counter()
        self.kernel, self.schedule = ready(context, shaders, dispatch), schedule
        schedule.follow(self.kernel.pace)
        self.compile_seconds = time.perf_counter() - start
        self._slow = self.kernel
        self.fast: Fast | None = None  # the tier of the faster kernel in use

    def use_fast(self, shaders: Sequence[Source], tier: Fast) -> None:
        """Use a faster kernel from the next frame on; after a RenderError the old one stays."""
        self.schedule.drop()  # the first dispatch writes to the frame that has begun
        faster, before = ready(self._context, shaders, self._dispatch), self.kernel
        faster.pace.learn(before.pace)
        self.kernel, self.fast = faster, tier
        self.schedule.follow(faster.pace)
        if before is not self._slow:
            self._context.programs.give_back(before)

    def take_up(self, tier: Fast, shaders: Callable[[Fast], list[Source] | None]) -> None:
        """Use the fastest kernel that is compiled already, up to a tier; `shaders` are its own.

        After an edit it is there if the kernel has nothing of the edit as a constant.
        """
        tiers: tuple[Fast, ...] = ("placed",) if tier == "placed" else ("baked", "placed")
        for fast in tiers:
            text = shaders(fast)
            if text and self._context.programs.has(text):
                self.use_fast(text, fast)
                return

    def release(self) -> None:
        """Give the programs back to the context."""
        for kernel in (self.kernel, self._slow) if self.fast else (self.kernel,):
            self._context.programs.give_back(kernel)


def ready(context: Context, shaders: Sequence[Source], dispatch: Dispatch) -> AnyKernel:
    """A compiled kernel from the context's programs; RenderError if the driver refuses it.

    The caller gives it back to `context.programs`.
    """

    def fresh() -> AnyKernel:
        kernel = compiled(context.gl, shaders)
        try:
            with context.checked("a shader"):
                dispatch(kernel, DispatchRange(0, 0, 1))  # drivers compile here; it adds nothing
                context.finish()
        except RenderError:
            kernel.release()
            raise
        return kernel

    return context.programs.take(shaders, fresh)


@contextmanager
def taken(context: Context, shaders: Sequence[Source], dispatch: Dispatch) -> Iterator[AnyKernel]:
    """Lend a kernel of `ready` for the duration of a with statement."""
    kernel = ready(context, shaders, dispatch)
    try:
        yield kernel
    finally:
        context.programs.give_back(kernel)
