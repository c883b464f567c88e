"""Use faster kernels while nothing is edited, one after the other.

Another process compiles each first, into the driver's cache, so that the window does not freeze.
"""

import time
from collections.abc import Callable

from glrt.core.errors import RenderError
from glrt.plan.facts import MOST_BAKED
from glrt.rendering.pipelines import Fast
from glrt.rendering.renderer import Renderer
from glrt.view.state.compile_ahead import CompileAhead

# Seconds without an edit: about the processor time of compiling ahead. "placed" is 1.1 to 2.4 times
# as fast as "generic" and stays while things move; "baked" is up to 1.2 times as fast as that.
PAUSES: dict[Fast, float] = {"placed": 1.0, "baked": 5.0}
MOST = 0.25  # seconds: after a longer freeze of the window, kernels are no longer taken


class IdleKernel:
    """Gives a renderer faster kernels once nothing is edited."""

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        begin: Callable[[Renderer, Fast], CompileAhead] = CompileAhead,
    ) -> None:
        """`begin` starts the process that compiles."""
        self._clock, self._begin = clock, begin
        self._picture = -1
        self._since = 0.0
        self._process: CompileAhead | None = None
        self._is_decided = False  # for this picture
        self._is_off = False  # on this machine

    def follow(self, renderer: Renderer, picture: int) -> bool:
        """Compile or take a faster kernel; return whether that took the time of this frame.

        Call it once a frame. `picture` is a number that changes when an edit restarts the picture.
        """
        if picture != self._picture:
            self.end()
            self._picture, self._since, self._is_decided = picture, self._clock(), False
        if self._is_off or self._is_decided or renderer.is_baked:
            return False
        tier: Fast = "placed" if renderer.running_tier == "generic" else "baked"
        if self._process is None:
            self._start(renderer, tier)
            return False
        return self._process.is_over and self._take(renderer, tier, self._process)

    def end(self) -> None:
        """Stop the process that compiles."""
        if self._process:
            self._process.end()
        self._process = None

    def _start(self, renderer: Renderer, tier: Fast) -> None:
        plan = renderer.plan
        # The other process has no meshes, and their triangles are never constants.
        if len(plan.scene.objects) > MOST_BAKED or plan.facts.triangles:
            self._is_decided = True
        elif self._clock() - self._since >= PAUSES[tier]:
            try:
                self._process = self._begin(renderer, tier)
            except OSError:
                self._is_off = True

    def _take(self, renderer: Renderer, tier: Fast, process: CompileAhead) -> bool:
        self._process, self._is_decided = None, tier == "baked" or not process.succeeded
        if not process.succeeded:  # such as after an error in an edited shader
            return False
        start = self._clock()
        try:
            renderer.bake(tier)
        except RenderError:
            self._is_off = True
        self._is_off |= self._clock() - start > MOST
        return True
