"""Save pictures and paths; a thread writes a picture while the window goes on."""

import os
from collections.abc import Callable
from pathlib import Path
from threading import Thread

from glrt.core.errors import GlrtError
from glrt.core.files import reason, unused, write_text
from glrt.image.image import Image
from glrt.rendering.paths.file import paths_to_json
from glrt.rendering.paths.values import PixelPaths
from glrt.view.file_dialogs import PICTURE, Dialogs
from glrt.view.file_places import where
from glrt.view.messages import Messages, Then
from glrt.view.state.session import Session


class PictureWriter:
    """A picture on its way to its file, which then is whole, or stays as it was."""

    def __init__(self, image: Image, path: str) -> None:
        """Begin at once; the picture is a copy, which later samples do not change."""
        self.path, self.problem = path, ""
        self._image = image
        self._thread = Thread(target=self._work)  # the end of the program waits for it
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether the file is there, or cannot be written."""
        return not self._thread.is_alive()

    def wait(self) -> None:
        """Wait for the end."""
        self._thread.join()

    def _work(self) -> None:
        try:
            self._image.save(self.path)
        except GlrtError as error:
            self.problem = str(error)
        except (OSError, MemoryError) as error:
            self.problem = f"{self.path} cannot be saved: {reason(error)}."


class PictureFiles:
    """Saves pictures and paths of a session; replaces no file without asking."""

    session: Session
    messages: Messages
    dialogs: Dialogs
    picture_path: str
    picture_name: str  # name that numbers are appended to
    writer: PictureWriter | None = None  # of the picture that is being saved
    is_compared: Callable[[], bool] = bool  # whether another picture, A, is shown with this one, B

    def save_picture(self, path: str = "") -> None:
        """Save the picture with its recipe to a path, by default that of the text box.

        A thread writes it; `follow_picture` reports the end.
        """
        self.finish_picture()  # the next free name is known then
        path = path or self.picture_path
        if not self.session.samples:
            return self.messages.complain("There is no picture yet.")
        with self.messages.reporting():
            self.writer = PictureWriter(self.session.image(), path)
        return None

    def follow_picture(self) -> None:
        """Report a picture that was saved, or why it was not, once that is known."""
        if not self.writer or not self.writer.is_over:
            return None
        writer, self.writer = self.writer, None
        if writer.problem:
            return self.messages.complain(writer.problem)
        alone = ": B alone, without A" if self.is_compared() else ""
        self.messages.report(f"Saved {where(Path(writer.path))}{alone}")
        if writer.path != self.picture_path:
            self.picture_name = writer.path
        self.picture_path = unused(self.picture_name)
        return None

    def finish_picture(self) -> None:
        """Wait for the picture that is being saved, if there is one."""
        if self.writer:
            self.writer.wait()
            self.follow_picture()

    def ask_save_picture(self, path: str, is_agreed: bool = False) -> None:
        """Save the picture; ask before an existing file is replaced."""
        self.unless_there(path, is_agreed, lambda: self.save_picture(path))

    def browse_picture(self) -> None:
        """Show a dialog to choose where the picture is saved."""
        given = "Save the picture", self.picture_path, PICTURE, ".png"
        self.dialogs.ask_save(*given, self.ask_save_picture)

    def save_paths(self, found: PixelPaths) -> None:
        """Save the paths of a pixel to a new file, which `glrt paths --replay` traces again."""
        path = Path(unused("paths.json"))
        with self.messages.reporting():
            write_text(path, paths_to_json(found) + "\n")
            self.messages.report(f"Saved {where(path)}")

    def unless_there(self, path: str, is_agreed: bool, act: Then) -> None:
        """Act; ask before that if a file is there that would be replaced."""
        if os.path.exists(path) and not is_agreed:
            self.messages.ask("Replace it?", f"{where(Path(path))} is there already.", replace=act)
        else:
            act()
