"""Writes the unsaved edits of this window to a file, and removes it when nothing is unsaved."""

import os
import secrets
import shlex
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from glrt.core.errors import GlrtError
from glrt.core.files import reason, write_text
from glrt.core.text import escaped
from glrt.image.sources import STANDARD_INPUT, shown
from glrt.scene.files.assets import AssetFolder
from glrt.scene.scenefile.toml_writer import scene_with
from glrt.view.edits.edited_state import State
from glrt.view.edits.editing import MOST
from glrt.view.files import Files
from glrt.view.recovery.claims import Claim
from glrt.view.recovery.contents import added_models, scene_of, text_of
from glrt.view.recovery.headers import Header, base_of, key_of
from glrt.view.recovery.offers import lock_of, offers_for, prune

SOON = 3.0  # seconds between two saves
SHARE = 0.05  # largest share of the time that saving takes
AGAIN = 60.0  # seconds until a save that failed is tried again, and a file is looked for


class Recovery:
    """The recovery file of this window, and the files that it offers to restore.

    Each window has a file of its own, with a lock next to it while the window is open.
    """

    def __init__(
        self, files: Files, folder: Path, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        """Offer the edits of earlier windows of this scene; nothing is written yet.

        Recovery files that nothing will ask for are removed; see `prune`.
        """
        self._files, self._folder, self._clock = files, folder, clock
        self.file = folder / f"{os.getpid()}-{secrets.token_hex(4)}.toml"
        self._claim: Claim | None = None
        self._kept: State | None = None  # state in the file
        self._due = self._again = 0.0  # times of the clock
        self._steps = 0  # of undo, when nothing was unsaved
        self._has_complained = False
        self._source = files.source
        prune(folder, time.time())
        self.offers = offers_for(key_of(files.source, files.saved), folder)

    def follow(self) -> None:
        """Write or remove the file if that is due, and offer the edits of a scene opened now."""
        if self._files.source != self._source:
            self._source = self._files.source
            self._leave_offers()
            self.offers = offers_for(key_of(self._source, self._files.saved), self._folder)
        if not self._files.is_other:
            self._steps = self._files.session.history.steps
            self._remove()
        elif self._is_due():
            self.keep()

    def _is_due(self) -> bool:
        now = self._clock()
        if self._kept is not self._files.session.state:
            return now >= self._due
        if now < self._again:
            return False
        self._again = now + AGAIN
        return not self.file.exists()  # another program may have tidied up

    def keep(self) -> bool:
        """Write unsaved edits now; a failure is reported once. Returns whether they are kept."""
        key, start = key_of(self._files.source, self._files.saved), self._clock()
        if not (key and self._files.is_other):
            return False
        problem = self._write(key)
        if problem and not self._has_complained:
            self._has_complained = True
            self._files.messages.complain(
                f"Edits are not kept for a restart: {problem} Save the scene to keep them."
            )
        self._kept = None if problem else self._files.session.state
        now = self._clock()
        wait = AGAIN if problem else max(SOON, (now - start) / SHARE)
        self._due, self._again = now + wait, now + AGAIN
        return not problem

    def _write(self, key: str) -> str:
        """Write the file, and lock it first; returns a problem, "" for none."""
        session, saved = self._files.session, self._files.saved
        steps = session.history.steps
        edits = steps - self._steps if self._steps < steps < MOST else None
        header = Header(key, time.time(), edits, added_models(session.scene, saved))
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._claim = self._claim or Claim(lock_of(self.file))
            write_text(self.file, text_of(header, scene_with(session.scene, session.settings)))
        except GlrtError as error:
            return str(error)
        except OSError as error:
            return f"Cannot write {self.file}: {reason(error)}."
        return ""

    def restore(self) -> None:
        """Restore the edits that are offered, as one step of undo; a failure is reported."""
        offer, files = self.offers[0], self._files
        with files.messages.reporting():
            base = files.rules.folder or base_of(files.source)
            folder = AssetFolder(base, files.rules.allow_outside)
            scene = scene_of(offer.file, offer.header, files.saved, folder)
            files.session.edit(scene, **dict(scene.render))
            if files.session.scene is scene:
                files.show(scene)
                self.offers.pop(0)
                files.messages.report("The edits are back; undo takes them away again")
                is_safe = self.keep() or not files.is_other
                (offer.discard if is_safe else offer.leave)()

    def discard(self) -> None:
        """Remove the edits that are offered."""
        self.offers.pop(0).discard()

    def put_off(self) -> None:
        """Offer the edits no longer in this window; its next start offers them again."""
        self.offers.pop(0).leave()

    def end(self, is_interrupted: bool) -> None:
        """Remove the file, or write it for the next start if a signal ends the window."""
        self._leave_offers()
        if not (is_interrupted and self._files.is_other):
            self._remove()
            return
        self.keep()
        if self._claim:
            self._claim.release()
            self._claim = None

    def last_words(self) -> str:
        """Keep unsaved edits when the display is lost; returns a paragraph on where they are."""
        gone = "the display is gone, and the window with it."
        source = shown(self._files.source)
        if not self._files.is_other:
            return f"{gone} No edits were unsaved."
        if not self.keep():
            return f"{gone} The unsaved edits of {source} could not be kept."
        kept = f"The unsaved edits are kept in {escaped(str(self.file))}"
        again = shlex.quote(source) if self._files.source != STANDARD_INPUT else "-"
        same = " with the same scene" * (again == STANDARD_INPUT)
        return f"{gone} {kept}: `glrt view {again}`{same} offers to restore them."

    def _remove(self) -> None:
        """Remove the file and its lock, if they are there."""
        self._kept, self._due = None, 0.0
        if self._claim:
            with suppress(OSError):
                self.file.unlink(missing_ok=True)
            self._claim.remove()
            self._claim = None

    def _leave_offers(self) -> None:
        while self.offers:
            self.offers.pop().leave()
