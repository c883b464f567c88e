"""Recovery files of windows that ended without a save."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from glrt.view.recovery.claims import Claim
from glrt.view.recovery.headers import Header, header_of, is_gone

KEPT = 30 * 86_400.0  # seconds for which the edits of a scene that is gone are kept


@dataclass(frozen=True)
class Offer:
    """A recovery file that this window has claimed, so that no other offers it."""

    file: Path
    header: Header
    claim: Claim

    def discard(self) -> None:
        """Remove the file."""
        with suppress(OSError):
            self.file.unlink(missing_ok=True)
        self.claim.remove()

    def leave(self) -> None:
        """Leave the file to the next window of this scene."""
        self.claim.release()


def lock_of(file: Path) -> Path:
    """Return the file that is locked while a window writes a recovery file."""
    return file.with_suffix(".lock")


def offers_for(key: str, folder: Path) -> list[Offer]:
    """Return claimed recovery files of a scene, the newest first; not those of open windows."""
    return sorted(_claimed(key, folder), key=lambda it: it.header.saved, reverse=True)


def prune(folder: Path, now: float) -> None:
    """Remove recovery files older than KEPT whose scene is gone; `now` in seconds since 1970.

    Files of open windows stay, and so do those whose scene is there: its next window offers them.
    """
    for file in folder.glob("[!.]*.toml"):
        header = header_of(file)
        if header is None or now - header.saved < KEPT or not is_gone(header.source):
            continue
        with suppress(OSError):  # a window that is open has locked it
            Offer(file, header, Claim(lock_of(file))).discard()


def _claimed(key: str, folder: Path) -> Iterator[Offer]:
    for file in folder.glob("[!.]*.toml") if key else ():
        header = header_of(file)
        if header is None or header.source != key:
            continue
        with suppress(OSError):  # a window that is open has locked it
            claim = Claim(lock_of(file))
            if file.exists():
                yield Offer(file, header, claim)
            else:
                claim.remove()
