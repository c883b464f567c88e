"""File dialogs of the desktop; where no program draws them, the panel's text boxes serve."""

import os
import shutil
import sys
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from imgui_bundle import portable_file_dialogs

PROGRAMS = ("zenity", "kdialog", "matedialog", "qarma")  # that draw dialogs on Linux
SCENES = [
    "Scenes, models and rendered pictures",
    "*.toml *.glb *.gltf *.obj *.ply *.stl *.png *.exr",
]
SCENE = ["Scene", "*.toml"]
PICTURE = ["Picture", "*.png *.exr *.npy"]

Dialog = portable_file_dialogs.open_file | portable_file_dialogs.save_file
Use = Callable[[str], None]


def are_there() -> bool:
    """Whether this desktop can show a file dialog."""
    return sys.platform in ("win32", "darwin") or _finds(PROGRAMS, os.environ.get("PATH"))


@lru_cache
def _finds(programs: tuple[str, ...], path: str | None) -> bool:
    return any(shutil.which(program, path=path) for program in programs)


class Dialogs:
    """At most one dialog at a time; the window goes on while it is open."""

    def __init__(self) -> None:
        """None is open."""
        self._dialog: Dialog | None = None
        self._use: Use | None = None

    @property
    def is_open(self) -> bool:
        """Whether a dialog waits for the user."""
        return self._dialog is not None

    def ask_open(self, title: str, kinds: list[str], use: Use) -> None:
        """Ask for a file that there is; `use` gets its path, unless the dialog is cancelled."""
        self._begin(portable_file_dialogs.open_file(title, str(Path.cwd()), kinds), use)

    def ask_save(self, title: str, path: str, kinds: list[str], use: Use) -> None:
        """Ask for a file to write; the dialog itself asks before it replaces one."""
        whole = str(Path(path).absolute())
        self._begin(portable_file_dialogs.save_file(title, whole, kinds), use)

    def poll(self) -> None:
        """Once a frame: use what was chosen, if the user is done."""
        if not (self._dialog and self._use and self._dialog.ready(0)):
            return
        chosen, use = self._dialog.result(), self._use
        self._dialog = self._use = None
        path = chosen if isinstance(chosen, str) else next(iter(chosen), "")
        if path:
            use(path)

    def close(self) -> None:
        """End a dialog that is open: the window does not wait for it."""
        if self._dialog:
            self._dialog.kill()
        self._dialog = self._use = None

    def _begin(self, dialog: Dialog, use: Use) -> None:
        self.close()
        self._dialog, self._use = dialog, use
