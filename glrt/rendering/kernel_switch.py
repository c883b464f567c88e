"""Two kernels of one scene: a generic one that survives edits, and a baked one between edits."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.gpu.programs import AnyKernel
from glrt.rendering.pipelines import compiled
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
        self._generic: AnyKernel | None = None

    @property
    def uses_fast_kernel(self) -> bool:
        """Whether the baked kernel is in use."""
        return self._generic is not None

    def use_fast(self, shaders: Sequence[Source]) -> None:
        """Use a baked kernel from the next frame on; after a RenderError the old one stays."""
        self.schedule.drop()  # the first dispatch writes to the frame that has begun
        faster = ready(self._context, shaders, self._dispatch)
        faster.pace.learn(self.kernel.pace)
        self._generic, self.kernel = self.kernel, faster
        self.schedule.follow(faster.pace)

    def release(self) -> None:
        """Give the programs back to the context."""
        for kernel in (self.kernel, self._generic):
            if kernel:
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
