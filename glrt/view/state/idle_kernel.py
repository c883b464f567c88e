"""Swap the generic kernel for a faster one while nothing is edited.

It is compiled ahead by another process, and taken where that showed two things: that the window
stands still for no more than a frame, and that the picture stays the same to the last bit.
"""

import time
from collections.abc import Callable

from glrt.core.errors import RenderError
from glrt.rendering.pipelines import MOST_BAKED
from glrt.rendering.renderer import Renderer
from glrt.view.state.idle_compile import TrialCompile

PAUSE = 1.0  # seconds without an edit: about what compiling ahead takes of a processor
LONGEST = 0.1  # seconds that the window may stand still
MOST = 0.25  # seconds that it stood still once, and never again


class IdleKernel:
    """Notices that nothing is edited, and lets a renderer make use of it."""

    def __init__(
        self,
        clock: Callable[[], float] = time.perf_counter,
        begin: Callable[[Renderer], TrialCompile] = TrialCompile,
    ) -> None:
        """`begin` starts a rehearsal."""
        self._clock, self._begin = clock, begin
        self._picture = -1
        self._since = 0.0
        self._rehearsal: TrialCompile | None = None
        self._is_decided = False  # for this picture
        self._is_vain = False  # on this machine

    def follow(self, renderer: Renderer, picture: int) -> bool:
        """Once a frame; whether the frame's time went into the faster kernel.

        `picture` is another number whenever an edit has begun the picture anew.
        """
        if picture != self._picture:
            self.end()
            self._picture, self._since, self._is_decided = picture, self._clock(), False
        if self._is_vain or self._is_decided or renderer.is_baked:
            return False
        if self._rehearsal is None:
            self._rehearse(renderer)
            return False
        return self._rehearsal.is_over and self._take(renderer, self._rehearsal)

    def end(self) -> None:
        """Stop what goes on."""
        if self._rehearsal:
            self._rehearsal.end()
        self._rehearsal = None

    def _rehearse(self, renderer: Renderer) -> None:
        plan = renderer.plan
        # The other process has no meshes, and their triangles are never constants.
        if len(plan.scene.objects) > MOST_BAKED or plan.facts.triangles:
            self._is_decided = True
        elif self._clock() - self._since >= PAUSE:
            try:
                self._rehearsal = self._begin(renderer)
            except OSError:
                self._is_vain = True

    def _take(self, renderer: Renderer, rehearsal: TrialCompile) -> bool:
        finding = rehearsal.finding()
        self._rehearsal, self._is_decided = None, True
        if finding is None:  # as where a shader file is broken meanwhile
            return False
        if not finding.is_same or finding.seconds > LONGEST:
            self._is_vain = True
            return False
        start = self._clock()
        try:
            renderer.bake()
        except RenderError:
            self._is_vain = True
        self._is_vain |= self._clock() - start > MOST
        return True
