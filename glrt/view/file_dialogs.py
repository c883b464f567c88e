"""File dialogs: those of the desktop, or one inside the window where no program draws them."""

import os
import shutil
import sys
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from imgui_bundle import im_file_dialog, portable_file_dialogs

PROGRAMS = ("zenity", "kdialog", "matedialog", "qarma")  # that draw dialogs on Linux
SCENES = [
    "Scenes, models and rendered pictures",
    "*.toml *.glb *.gltf *.obj *.ply *.stl *.png *.exr",
]
MODELS = ["Models", "*.glb *.gltf *.obj *.ply *.stl"]
SCENE = ["Scene", "*.toml"]
PICTURE = ["Picture", "*.png *.exr *.npy"]

Open = Callable[[str], object]
Save = Callable[[str, bool], object]  # a path, and whether the user agreed to replace what is there
_OPEN, _SAVE = "glrt open", "glrt save"  # of the dialogs inside the window


def are_there() -> bool:
    """Whether this desktop can show a file dialog."""
    return sys.platform in ("win32", "darwin") or _finds(PROGRAMS, os.environ.get("PATH"))


@lru_cache
def _finds(programs: tuple[str, ...], path: str | None) -> bool:
    return any(shutil.which(program, path=path) for program in programs)


class _OfDesktop:
    """A dialog of the desktop, in a process of its own."""

    agrees = True  # it asks before it replaces a file

    def __init__(
        self, dialog: portable_file_dialogs.open_file | portable_file_dialogs.save_file
    ) -> None:
        self._dialog = dialog

    def answer(self) -> str | None:
        """The path that was chosen, "" for none; None while the user has not chosen."""
        if not self._dialog.ready(0):
            return None
        chosen = self._dialog.result()
        return chosen if isinstance(chosen, str) else next(iter(chosen), "")

    def close(self) -> None:
        self._dialog.kill()


class _InWindow:
    """A dialog that Dear ImGui draws: it is drawn as often as it is asked for its answer."""

    agrees = False

    def __init__(self, key: str) -> None:
        self._key = key

    def answer(self) -> str | None:
        """As of the other kind."""
        dialog = im_file_dialog.FileDialog.instance()
        if not dialog.is_done(self._key):
            return None
        chosen = dialog.get_result().path() if dialog.has_result() else ""
        dialog.close()
        return chosen

    def close(self) -> None:
        im_file_dialog.FileDialog.instance().close()


class Dialogs:
    """At most one dialog at a time; the window goes on while it is open."""

    def __init__(self) -> None:
        """None is open."""
        self._dialog: _OfDesktop | _InWindow | None = None
        self._use: Save | None = None

    @property
    def is_open(self) -> bool:
        """Whether a dialog waits for the user."""
        return self._dialog is not None

    def ask_open(self, title: str, kinds: list[str], use: Open) -> None:
        """Ask for a file that there is; `use` gets its path, unless the dialog is cancelled."""
        self.close()
        if are_there():
            self._dialog = _OfDesktop(
                portable_file_dialogs.open_file(title, str(Path.cwd()), kinds)
            )
        else:
            place, dialog = str(Path.cwd()), im_file_dialog.FileDialog.instance()
            dialog.open(_OPEN, title, _filters(kinds), False, place)
            self._dialog = _InWindow(_OPEN)
        self._use = lambda path, _: use(path)

    def ask_save(self, title: str, path: str, kinds: list[str], suffix: str, use: Save) -> None:
        """Ask for a file to write, which gets the suffix if it has none."""
        self.close()
        whole = Path(path).absolute()
        if are_there():
            self._dialog = _OfDesktop(portable_file_dialogs.save_file(title, str(whole), kinds))
        else:
            dialog = im_file_dialog.FileDialog.instance()
            dialog.save(_SAVE, title, _filters(kinds), str(whole.parent))
            self._dialog = _InWindow(_SAVE)

        def with_suffix(chosen: str, is_agreed: bool) -> None:
            has_one = bool(Path(chosen).suffix)
            use(chosen if has_one else chosen + suffix, is_agreed and has_one)

        self._use = with_suffix

    def poll(self, is_drawn: bool) -> None:
        """Use what was chosen, if the user is done; `is_drawn`: within a frame that is drawn."""
        if not self._dialog or not self._use or isinstance(self._dialog, _InWindow) != is_drawn:
            return
        path, agrees, use = self._dialog.answer(), self._dialog.agrees, self._use
        if path is None:
            return
        self._dialog = self._use = None
        if path:
            use(path, agrees)

    def close(self) -> None:
        """End a dialog that is open: the window does not wait for it."""
        if self._dialog:
            self._dialog.close()
        self._dialog = self._use = None


def _filters(kinds: list[str]) -> str:
    """Of the dialog inside the window: "Scene{.toml},.*"."""
    name, patterns = kinds
    return f"{name}{{{patterns.replace('*', '').replace(' ', ',')}}},.*"
