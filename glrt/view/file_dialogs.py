"""File dialogs of the desktop, or one inside the window if the desktop has none."""

import os
import shutil
import sys
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from imgui_bundle import ImVec2, hello_imgui, imgui, portable_file_dialogs

from glrt.core.text import escaped
from glrt.scene.files.named_grids import SUFFIXES
from glrt.view.state.folders import Listing, listing, nearest_folder

_WIDTH, _ROWS = 34.0, 14.0  # in heights of a letter
_DOUBLE = imgui.SelectableFlags_.allow_double_click | imgui.SelectableFlags_.no_auto_close_popups


class FileBrowser:
    """A popup that shows a folder; each call of `answer` draws it."""

    def __init__(self, title: str, act: str, suffixes: tuple[str, ...], path: Path) -> None:
        """`act` is the text of the button, `path` the folder to show or the file to propose."""
        self._title, self._act, self._suffixes = f"{title}###file browser", act, suffixes
        self._name = "" if path.is_dir() else path.name
        self._answer: str | None = None
        self._is_open, self._is_new = False, True
        self._go(path if path.is_dir() else path.parent)

    def _go(self, folder: Path) -> None:
        self._folder = nearest_folder(folder)
        self._typed = escaped(str(self._folder))
        self._listing: Listing = listing(self._folder, self._suffixes)

    def answer(self) -> str | None:
        """Draw the popup; return the chosen path, "" if cancelled, None until the user chooses."""
        if not self._is_open:
            imgui.open_popup(self._title)
            self._is_open = True
        center = imgui.get_main_viewport().get_center()
        imgui.set_next_window_pos(center, imgui.Cond_.appearing.value, ImVec2(0.5, 0.5))
        flags = imgui.WindowFlags_.always_auto_resize.value
        if not imgui.begin_popup_modal(self._title, None, flags)[0]:
            return ""  # Escape closed it
        self._draw_folder()
        self._draw_names()
        self._draw_answers()
        if self._answer is not None:
            imgui.close_current_popup()
        imgui.end_popup()
        return self._answer

    def close(self) -> None:
        """Do nothing: the popup closes when it is no longer drawn."""

    def _draw_folder(self) -> None:
        if imgui.button("up"):
            self._go(self._folder.parent)
        imgui.same_line()
        if imgui.button("home"):
            self._go(Path.home())
        imgui.same_line()
        imgui.set_next_item_width(-1)
        flags = imgui.InputTextFlags_.enter_returns_true.value
        is_entered, self._typed = imgui.input_text("##folder", self._typed, flags)
        if is_entered:
            self._go(Path(self._typed))

    def _draw_names(self) -> None:
        size = ImVec2(hello_imgui.em_size(_WIDTH), hello_imgui.em_size(_ROWS))
        if imgui.begin_child("names", size, imgui.ChildFlags_.borders.value):
            if self._listing.problem:
                imgui.text_wrapped(escaped(self._listing.problem))
            for name in self._listing.folders:
                if self._row(f"{name}/"):
                    self._go(self._folder / name)
                    break
            for name in self._listing.files:
                is_chosen = self._row(name)
                if is_chosen is not None:
                    self._name = name
                if is_chosen:
                    self._answer = str(self._folder / name)
        imgui.end_child()

    def _row(self, name: str) -> bool | None:
        """Draw a row of the list; None without a click, else whether it was a double click."""
        is_picked = imgui.selectable(escaped(name), name == self._name, int(_DOUBLE))[0]
        left = imgui.MouseButton_.left.value
        return imgui.is_mouse_double_clicked(left) if is_picked else None

    def _draw_answers(self) -> None:
        imgui.set_next_item_width(hello_imgui.em_size(_WIDTH - 12))
        if self._is_new:
            imgui.set_keyboard_focus_here()  # a name can be typed at once
            self._is_new = False
        flags = int(
            imgui.InputTextFlags_.enter_returns_true | imgui.InputTextFlags_.auto_select_all
        )
        shown = escaped(self._name)
        is_entered, typed = imgui.input_text("##name", shown, flags)
        self._name = self._name if typed == shown else typed
        imgui.same_line()
        imgui.begin_disabled(not self._name)
        is_pressed = imgui.button(self._act)
        imgui.end_disabled()
        if self._name and (is_pressed or is_entered):
            self._choose(self._folder / Path(self._name).expanduser())
        imgui.same_line()
        if imgui.button("cancel"):
            self._answer = ""

    def _choose(self, path: Path) -> None:
        """Choose a file as the answer, or show a folder that was typed."""
        if path.is_dir():
            self._name = ""
            self._go(path)
        else:
            self._answer = str(path)


PROGRAMS = ("zenity", "kdialog", "matedialog", "qarma")  # programs that draw dialogs on Linux
SCENES = [
    "Scenes, models, pictures and images of the sky",
    "*.toml *.glb *.gltf *.obj *.ply *.stl *.usd *.usda *.usdc *.usdz *.mtlx *.png *.exr *.hdr",
]
MODELS = ["Models", "*.glb *.gltf *.obj *.ply *.stl *.usd *.usda *.usdc *.usdz *.mtlx"]
GRIDS = ["Grids of densities", " ".join(f"*{suffix}" for suffix in SUFFIXES)]
PHOTOS = ["Images of radiance", "*.hdr *.exr"]
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
