"""File dialogs of the desktop, or one inside the window if the desktop has none."""

import os
import shutil
import sys
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from imgui_bundle import portable_file_dialogs

from glrt.view.file_browser import FileBrowser

PROGRAMS = ("zenity", "kdialog", "matedialog", "qarma")  # programs that draw dialogs on Linux
SCENES = [
    "Scenes, models and rendered pictures",
    "*.toml *.glb *.gltf *.obj *.ply *.stl *.png *.exr",
]
MODELS = ["Models", "*.glb *.gltf *.obj *.ply *.stl"]
SCENE = ["Scene", "*.toml"]
PICTURE = ["Picture", "*.png *.exr *.npy"]

Open = Callable[[str], object]
Save = Callable[[str, bool], object]  # a path, and whether the user agreed to replace a file there


def are_there() -> bool:
    """Whether this desktop can show a file dialog."""
    return sys.platform in ("win32", "darwin") or _finds(PROGRAMS, os.environ.get("PATH"))


@lru_cache
def _finds(programs: tuple[str, ...], path: str | None) -> bool:
    return any(shutil.which(program, path=path) for program in programs)


class _OfDesktop:
    """A dialog of the desktop, in a process of its own."""

    def __init__(
        self, dialog: portable_file_dialogs.open_file | portable_file_dialogs.save_file
    ) -> None:
        self._dialog = dialog

    def answer(self) -> str | None:
        """Return the chosen path, "" if cancelled, None while the user has not chosen."""
        if not self._dialog.ready(0):
            return None
        chosen = self._dialog.result()
        return chosen if isinstance(chosen, str) else next(iter(chosen), "")

    def close(self) -> None:
        self._dialog.kill()


class Dialogs:
    """At most one file dialog at a time; the window keeps drawing while it is open."""

    def __init__(self) -> None:
        """Begin with no open dialog."""
        self._dialog: _OfDesktop | FileBrowser | None = None
        self._use: Save | None = None

    @property
    def is_open(self) -> bool:
        """Whether a dialog waits for the user."""
        return self._dialog is not None

    def ask_open(self, title: str, kinds: list[str], use: Open) -> None:
        """Ask for an existing file; `use` gets its path unless the dialog is cancelled."""
        self.close()
        if are_there():
            self._dialog = _OfDesktop(
                portable_file_dialogs.open_file(title, str(Path.cwd()), kinds)
            )
        else:
            self._dialog = FileBrowser(title, "open", _suffixes(kinds), Path.cwd())
        self._use = lambda path, _: use(path)

    def ask_save(self, title: str, path: str, kinds: list[str], suffix: str, use: Save) -> None:
        """Ask for a file to write; a name without suffix gets `suffix`."""
        self.close()
        whole = Path(path).absolute()
        if are_there():
            self._dialog = _OfDesktop(portable_file_dialogs.save_file(title, str(whole), kinds))
        else:
            self._dialog = FileBrowser(title, "save", _suffixes(kinds), whole)

        def with_suffix(chosen: str, is_agreed: bool) -> None:
            has_one = bool(Path(chosen).suffix)
            use(chosen if has_one else chosen + suffix, is_agreed and has_one)

        self._use = with_suffix

    def poll(self, is_drawn: bool) -> None:
        """Pass the chosen path to `use`, once there is one; `is_drawn`: a frame is being drawn."""
        if not self._dialog or not self._use or isinstance(self._dialog, FileBrowser) != is_drawn:
            return
        path, use = self._dialog.answer(), self._use
        agrees = isinstance(self._dialog, _OfDesktop)  # it asks before a file is replaced
        if path is None:
            return
        self._dialog = self._use = None
        if path:
            use(path, agrees)

    def close(self) -> None:
        """Close an open dialog without an answer."""
        if self._dialog:
            self._dialog.close()
        self._dialog = self._use = None


def _suffixes(kinds: list[str]) -> tuple[str, ...]:
    return tuple(pattern.removeprefix("*") for pattern in kinds[1].split())
