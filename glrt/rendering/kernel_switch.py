"""Two kernels of one scene: a general one, which survives edits, and a faster one for rests."""

import time
from collections.abc import Callable
from copy import copy

from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.gpu.program import FragmentKernel, Kernel
from glrt.rendering.pipelines import compiled
from glrt.rendering.schedule import DispatchRange, Schedule

AnyKernel = Kernel | FragmentKernel
Dispatch = Callable[[AnyKernel, DispatchRange], None]


class KernelSwitch:
    """The kernel in use, and what is known of its dispatches."""

    def __init__(
        self, context: Context, shaders: list[Source], schedule: Schedule, dispatch: Dispatch
    ) -> None:
        """Compile the general kernel; RenderError if the driver refuses it."""
        self._context = context
        start = time.perf_counter()
        self.kernel, self.schedule = ready(context, shaders, dispatch), schedule
        self.compile_seconds = time.perf_counter() - start
        self._waiting: tuple[AnyKernel, Schedule] | None = None

    @property
    def uses_fast_kernel(self) -> bool:
        """Whether the faster kernel is in use."""
        return self._waiting is not None

    def use_fast(self, shaders: list[Source], dispatch: Dispatch) -> None:
        """Continue with a faster kernel from the next frame on; if refused, nothing changes."""
        self.schedule.drop()  # the first dispatch writes to the frame that has begun
        faster = ready(self._context, shaders, dispatch)
        self._waiting = self.kernel, self.schedule
        self.kernel, self.schedule = faster, copy(self.schedule)

    def use_general(self) -> None:
        """Continue with the general kernel; the faster one is freed."""
        if self._waiting:
            self.kernel.release()
            self.kernel, self.schedule = self._waiting
        self._waiting = None

    def release(self) -> None:
        """Free the programs."""
        self.use_general()
        self.kernel.release()


def ready(context: Context, shaders: list[Source], dispatch: Dispatch) -> AnyKernel:
    """A kernel that the driver has compiled; RenderError if it refuses it."""
    kernel = compiled(context.gl, shaders)
    try:
        with context.checked("a shader"):
            dispatch(kernel, DispatchRange(0, 0, 1))  # drivers compile here; it adds nothing
            context.finish()
    except RenderError:
        kernel.release()
        raise
    return kernel
