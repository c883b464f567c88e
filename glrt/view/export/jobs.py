"""A picture or a film that another process renders, by `glrt render` or `glrt film`."""

import io
import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from threading import Lock, Thread
from typing import IO, Any

from glrt.core.errors import GlrtError
from glrt.core.files import reason, write_whole
from glrt.core.text import escaped
from glrt.view.export.wishes import JPEG, Order

Prepare = Callable[[Path], list[str]]  # writes the source to a folder; returns words that name it

_GLRT = (sys.executable, "-m", "glrt")
_PATIENCE = 5.0  # seconds for which the end of the window waits for the process
_QUALITY = 92  # of JPEG, 0 to 100
_NOT_REACHED = 1  # exit code of an error that was not reached: the picture is there


class Job:
    """An export on its way; `share`, `left` and `figures` say how far it is.

    The process ends if the window does: nobody reads its progress any more.
    """

    def __init__(self, order: Order, prepare: Prepare) -> None:
        """Begin at once, on a thread; `prepare` runs on it, too."""
        self.order = order
        self.share, self.left = 0.0, None  # of the work; seconds to go, if they are known
        self.figures: dict[str, Any] = {}  # of the last line of progress
        self.problem = ""  # why it failed
        self.note = ""  # what is to be said about a file that is there
        self.is_cancelled = False
        self._prepare = prepare
        self._process: subprocess.Popen[str] | None = None
        self._lock = Lock()
        self._thread = Thread(target=self._work, daemon=True)
        self._thread.start()

    left: float | None

    @property
    def is_over(self) -> bool:
        """Whether the file is there, or will not come."""
        return not self._thread.is_alive()

    def cancel(self) -> None:
        """End the process. A film keeps its complete frames; nothing of a picture stays."""
        with self._lock:
            self.is_cancelled = True
            if self._process:
                end = self._process.terminate if self.order.kind == "film" else self._process.kill
                end()

    def end(self) -> None:
        """Cancel it, and wait for that for a while: the window closes."""
        self.cancel()
        self._thread.join(_PATIENCE)

    def _work(self) -> None:
        try:
            with TemporaryDirectory(prefix="glrt-export-") as name:
                folder = Path(name)
                made = self._made(folder)
                words = ["render" if self.order.kind == "picture" else "film"]
                words += [*self._prepare(folder), "-o", str(made), *self.order.options]
                self._run([*_GLRT, *words, "--progress", "--json", "--quiet"])
                if self.order.kind == "picture" and not (self.problem or self.is_cancelled):
                    _put(made, self.order.path)
        except GlrtError as error:
            self.problem = str(error)
        except (OSError, MemoryError) as error:
            self.problem = f"The export failed: {reason(error)}."

    def _made(self, folder: Path) -> Path:
        """Return the file that the command writes: a film its own, a picture one to be moved."""
        path = self.order.path
        if self.order.kind == "film":
            return path.absolute()
        suffix = path.suffix.lower()
        return folder / f"picture{'.png' if suffix in JPEG else suffix}"

    def _run(self, command: list[str]) -> None:
        """Run the command to its end, and take its progress in."""
        with TemporaryFile("w+", encoding="utf-8", errors="backslashreplace") as told:
            with self._lock:
                if self.is_cancelled:
                    return
                pipe = subprocess.PIPE
                self._process = subprocess.Popen(
                    command, stdin=subprocess.DEVNULL, stdout=pipe, stderr=told, text=True
                )
            with self._process as process:
                assert process.stdout
                for line in process.stdout:
                    self._hear(line)
            if not self.is_cancelled:
                self._ended(process.returncode, told)

    def _hear(self, line: str) -> None:
        with suppress(ValueError):
            figures = json.loads(line)
            if "progress" in figures:  # other lines report what is done
                self.figures = figures
                self.share, self.left = figures["progress"], figures["seconds_left"]

    def _ended(self, code: int, told: IO[str]) -> None:
        """Take in why the command did not end well, or what it warns of."""
        told.seek(0)
        lines = [line for line in told.read().splitlines() if line.startswith("glrt: ")]
        if not code:
            self.note = escaped(" ".join(map(_warning, lines)))
            return
        text = lines[-1].removeprefix("glrt: ") if lines else f"glrt ended with code {code}."
        if code == _NOT_REACHED:
            self.note = escaped(text)
        else:
            self.problem = escaped(text)


def _warning(line: str) -> str:
    text = line.removeprefix("glrt: ").removeprefix("caution: ")
    return text[:1].upper() + text[1:]


def _put(made: Path, path: Path) -> None:
    """Write the picture to its place, whole or not at all; RenderError if that fails."""
    if path.suffix.lower() in JPEG:
        write_whole(path, lambda file: _write_jpeg(made, file))
    else:
        write_whole(path, lambda file: _copy(made, file))


def _copy(made: Path, file: Path) -> None:
    shutil.copyfile(made, file)


def _write_jpeg(made: Path, file: Path) -> None:
    """Write a PNG file as JPEG, with colours at full resolution and without a recipe."""
    from PIL.PngImagePlugin import PngImageFile

    from glrt.scene.images.metadata import bare_png

    with PngImageFile(io.BytesIO(bare_png(made.read_bytes()))) as picture:
        picture.convert("RGB").save(file, "JPEG", quality=_QUALITY, subsampling=0)
