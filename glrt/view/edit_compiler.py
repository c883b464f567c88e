"""The kernel of an edit, compiled by another process while the window goes on."""

from collections.abc import Callable
from threading import Thread

from glrt.core.errors import GlrtError
from glrt.packing.scene_tree import SceneTree, tree_of
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import Layering
from glrt.view.edits.edited_state import State
from glrt.view.kernel_notes import Driver, Note
from glrt.view.scene_compiler import Part, compile_for, note_on


class _EndedError(Exception):
    """Nobody waits for the kernel any more."""


class EditCompiler:
    """Asks the notes for a kernel on a thread, and lets another process compile an unknown one.

    The thread also assembles the text of the kernel, which the window then need not.
    """

    def __init__(self, part: Part, before: SceneTree | None) -> None:
        """Begin at once; `before` is the BVH of the scene before the edit."""
        self._part, self._before = part, before
        self._note: Note | None = None
        self._is_ended = False
        self._thread = Thread(target=self._work, daemon=True)
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether the driver has the kernel, or no process can compile it."""
        return not self._thread.is_alive()

    def end(self) -> None:
        """Stop the process at the next look at it, in a moment."""
        self._is_ended = True

    def learn(self, seconds: float) -> None:
        """Note whether the driver had the kernel, by the processor seconds of the edit."""
        if self._note:
            self._note.learn(seconds)

    def _work(self) -> None:
        scene = self._part[0]
        try:
            note = note_on(self._part, tree_of(SceneFacts(scene, "moved"), self._before))
        except (GlrtError, ValueError, MemoryError):  # the window meets it, too, and reports it
            return
        try:
            if not note.is_there and compile_for(self._part, self._goes_on):
                note.compiled()
        except (_EndedError, OSError):
            return
        self._note = note

    def _goes_on(self) -> None:
        if self._is_ended:
            raise _EndedError


def begin_for(
    driver: Callable[[], Driver], state: State, layering: Layering, before: SceneTree | None
) -> EditCompiler:
    """Begin to compile the kernel of a state for the driver of a window."""
    return EditCompiler((state.scene, state.settings, layering, driver()), before)
