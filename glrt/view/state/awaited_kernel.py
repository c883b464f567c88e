"""Let an edit wait until another process has compiled its kernel, so that the window goes on."""

import time
from collections.abc import Callable
from typing import Protocol

from glrt.core.memo import kept_for_the_same
from glrt.packing.scene_tree import SceneTree
from glrt.plan.plan import Layering
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.view.edits.edited_state import State

PAUSE = 0.25  # seconds without another edit, after an edit that ended a compilation
_SAME = {  # settings that no kernel depends on
    *("width", "height", "samples", "seed", "exposure", "tonemap", "crop", "denoise"),
}


class Work(Protocol):
    """A process that compiles a kernel, or the look for a kernel that the driver has."""

    @property
    def is_over(self) -> bool:
        """Whether the driver has the kernel, or no process can compile it."""

    def end(self) -> None:
        """Stop it: its kernel is no longer needed."""

    def learn(self, seconds: float) -> None:
        """Note the processor seconds in which the window then had the kernel."""


Begin = Callable[[State, Layering, SceneTree | None], Work]  # with the tree of the scene before


class AwaitedKernel:
    """The compilation that the newest edit waits for."""

    def __init__(self, begin: Begin, clock: Callable[[], float] = time.perf_counter) -> None:
        """`begin` starts to compile; nothing is compiled yet."""
        self._begin, self._clock = begin, clock
        self._wanted: tuple[object, ...] | None = None
        self._since = 0.0  # time from which on the next process may begin
        self._work: Work | None = None

    def holds(self, wanted: State, layering: Layering, before: SceneTree | None) -> bool:
        """Whether an edit that needs another kernel must wait; call it once a frame."""
        key = _anywhere(wanted.scene), _settings_of(wanted), layering
        if key != self._wanted:
            was_busy = self._work is not None
            self.end()
            self._wanted, self._since = key, self._clock() + PAUSE * was_busy
        if self._work is None:
            if self._clock() < self._since:
                return True
            self._work = self._begin(wanted, layering, before)
        return not self._work.is_over

    def took(self, seconds: float) -> None:
        """Note that the edit is done, in so many processor seconds."""
        if self._work and self._work.is_over:
            self._work.learn(seconds)
        self.end()

    def end(self) -> None:
        """Stop the process, if there is one."""
        if self._work:
            self._work.end()
        self._work = self._wanted = None


_ANYWHERE = Camera(position=(0.0, 0.0, 1.0), look_at=(0.0, 0.0, 0.0))


@kept_for_the_same
def _anywhere(scene: Scene) -> Scene:
    """Return the scene with a camera that is always the same: no kernel depends on it."""
    return scene.model_copy(update={"camera": _ANYWHERE})


def _settings_of(wanted: State) -> tuple[object, ...]:
    return tuple(value for name, value in wanted.settings if name not in _SAME)
