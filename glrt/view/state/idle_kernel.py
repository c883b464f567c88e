"""Use a baked kernel while nothing is edited.

Another process compiles it first, into the driver's cache, so that the window does not freeze.
"""

import time
from collections.abc import Callable

from glrt.core.errors import RenderError
from glrt.rendering.pipelines import MOST_BAKED
from glrt.rendering.renderer import Renderer
from glrt.view.state.compile_ahead import CompileAhead

PAUSE = 1.0  # seconds without an edit: about the processor time of compiling ahead
MOST = 0.25  # seconds: after a longer freeze of the window, kernels are no longer baked


class IdleKernel:
    """Bakes the kernel of a renderer once nothing is edited."""

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        begin: Callable[[Renderer], CompileAhead] = CompileAhead,
    ) -> None:
        """`begin` starts the process that compiles."""
        self._clock, self._begin = clock, begin
        self._picture = -1
        self._since = 0.0
        self._process: CompileAhead | None = None
        self._is_decided = False  # for this picture
        self._is_off = False  # on this machine

    def follow(self, renderer: Renderer, picture: int) -> bool:
        """Compile or take the baked kernel; return whether that took the time of this frame.

        Call it once a frame. `picture` is a number that changes when an edit restarts the picture.
        """
        if picture != self._picture:
            self.end()
            self._picture, self._since, self._is_decided = picture, self._clock(), False
        if self._is_off or self._is_decided or renderer.is_baked:
            return False
        if self._process is None:
            self._start(renderer)
            return False
        return self._process.is_over and self._take(renderer, self._process)

    def end(self) -> None:
        """Stop the process that compiles."""
        if self._process:
            self._process.end()
        self._process = None

    def _start(self, renderer: Renderer) -> None:
        plan = renderer.plan
        # The other process has no meshes, and their triangles are never constants.
        if len(plan.scene.objects) > MOST_BAKED or plan.facts.triangles:
            self._is_decided = True
        elif self._clock() - self._since >= PAUSE:
            try:
                self._process = self._begin(renderer)
            except OSError:
                self._is_off = True

    def _take(self, renderer: Renderer, process: CompileAhead) -> bool:
        self._process, self._is_decided = None, True
        if not process.succeeded:  # such as after an error in an edited shader
            return False
        start = self._clock()
        try:
            renderer.bake()
        except RenderError:
            self._is_off = True
        self._is_off |= self._clock() - start > MOST
        return True
