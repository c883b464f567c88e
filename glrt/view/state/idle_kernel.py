"""Use a baked kernel while nothing is edited.

Another process compiles it first, into the driver's cache, so that the window does not stand still.
"""

import time
from collections.abc import Callable

from glrt.core.errors import RenderError
from glrt.rendering.pipelines import MOST_BAKED
from glrt.rendering.renderer import Renderer
from glrt.view.state.compile_ahead import CompileAhead

PAUSE = 1.0  # seconds without an edit: about what compiling ahead takes of a processor
MOST = 0.25  # seconds that the window stood still once, and never again


class IdleKernel:
    """Notices that nothing is edited, and lets a renderer make use of it."""

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        begin: Callable[[Renderer], CompileAhead] = CompileAhead,
    ) -> None:
        """`begin` starts the process."""
        self._clock, self._begin = clock, begin
        self._picture = -1
        self._since = 0.0
        self._process: CompileAhead | None = None
        self._is_decided = False  # for this picture
        self._is_off = False  # on this machine

    def follow(self, renderer: Renderer, picture: int) -> bool:
        """Once a frame; whether the frame's time went into the baked kernel.

        `picture` is another number whenever an edit has begun another picture.
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
        """Stop the process."""
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
        if not process.succeeded:  # as where a shader file is broken meanwhile
            return False
        start = self._clock()
        try:
            renderer.bake()
        except RenderError:
            self._is_off = True
        self._is_off |= self._clock() - start > MOST
        return True
