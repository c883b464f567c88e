"""Put a picture on the clipboard of the desktop, by a program of it."""

import os
import shutil
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread

from glrt.core.errors import GlrtError, RenderError, UsageError
from glrt.core.files import reason
from glrt.image.image import Image

_PNG = "image/png"
_WAYLAND = ("WAYLAND_DISPLAY", "wl-copy", ("--type", _PNG), "wl-clipboard")
_X11 = ("DISPLAY", "xclip", ("-selection", "clipboard", "-t", _PNG, "-i"), "xclip")
_PATIENCE = 20.0  # seconds for the program, which stays behind on its own


def command_for(
    environment: Mapping[str, str], find: Callable[[str], str | None] = shutil.which
) -> list[str]:
    """Return the command that takes a PNG file on its standard input to the clipboard.

    Raises `UsageError` that names the package to install if there is none.
    """
    wanted = ""
    for variable, program, options, package in (_WAYLAND, _X11):
        if not environment.get(variable):
            continue
        if find(program):
            return [program, *options]
        wanted = wanted or package
    if not wanted:
        raise UsageError(
            "Pictures are copied to the clipboard of X11 and Wayland alone. Save the picture, and "
            "copy it in another program."
        )
    raise UsageError(
        f"A picture is copied by the program {wanted}, which is not installed: type `sudo apt-get "
        f"install {wanted}`, or save the picture."
    )


class Copy:
    """A picture on its way to the clipboard, on a thread; it carries its recipe."""

    def __init__(self, image: Image) -> None:
        """Begin at once; raises `UsageError` if no program is there."""
        self._image = image
        self._command = command_for(os.environ)
        self.problem = ""
        self._thread = Thread(target=self._work, daemon=True)
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether the picture is on the clipboard, or cannot be put there."""
        return not self._thread.is_alive()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, in pixels."""
        height, width = self._image.radiance.shape[:2]
        return width, height

    def _work(self) -> None:
        try:
            with TemporaryDirectory(prefix="glrt-copy-") as folder:
                file = Path(folder) / "picture.png"
                self._image.save(file)
                _give(self._command, file)
        except GlrtError as error:
            self.problem = str(error)
        except (OSError, subprocess.SubprocessError, MemoryError) as error:
            self.problem = f"The picture cannot be copied: {reason(error)}."


def _give(command: list[str], file: Path) -> None:
    """Let the program take the file; RenderError if it refuses it.

    It goes on in the background, and must not keep a pipe of this process open.
    """
    nowhere = subprocess.DEVNULL
    with file.open("rb") as content:
        done = subprocess.run(
            command, stdin=content, stdout=nowhere, stderr=nowhere, timeout=_PATIENCE, check=False
        )
    if done.returncode:
        raise RenderError(
            f"The picture cannot be copied: {command[0]} ended with code {done.returncode}."
        )
