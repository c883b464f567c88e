"""Files of the frames and of the film, by the name that the user gives."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from glrt.core import files
from glrt.core.errors import UsageError
from glrt.core.text import quoted

OutputKind = Literal["frames", "container", "sheet"]
CONTAINERS = (".webp", ".gif", ".mp4")
FRAMES = (".exr", ".png")
_PATTERN = re.compile(r"%(0\d{1,2})?d|#+")
_DIGITS = 4  # of a frame's number


@dataclass(frozen=True)
class Output:
    """Where the frames lie, and the film that is made of them, if one is."""

    path: Path  # as the user gave it
    kind: OutputKind

    @property
    def folder(self) -> Path:
        """The folder of the frames."""
        is_own = self.kind != "frames"
        return self.path.with_name(f"{self.path.name}.frames") if is_own else self.path.parent

    def frame(self, number: int) -> Path:
        """Return the file of a frame."""
        if self.kind != "frames":
            return self.folder / f"{number:0{_DIGITS}d}.exr"
        return self.folder / _PATTERN.sub(lambda found: _digits(found[0], number), self.path.name)

    def check(self, first: int) -> None:
        """Raise `UsageError` if its files cannot be written; makes the folder of the frames."""
        if self.kind != "frames":
            files.check_writable(self.path)
        files.make_folder(self.folder, self.frame(first).name)


def _digits(pattern: str, number: int) -> str:
    return f"{number:0{len(pattern)}d}" if pattern[0] == "#" else pattern % number


def parse_output(text: str) -> Output:
    """Return the output of a name; `UsageError` says which names there are."""
    path = Path(text)
    suffix = path.suffix.lower()
    places = len(_PATTERN.findall(path.name))
    if places == 1 and suffix in FRAMES:
        return Output(path, "frames")
    if places == 0 and suffix in CONTAINERS:
        return Output(path, "container")
    if places == 0 and suffix == ".png":
        return Output(path, "sheet")
    raise UsageError(
        f"Cannot write {quoted(text)}: a film ends in .webp, .gif or .mp4; a sheet of all frames "
        "in .png; frames have a place for their number, as frames/%04d.exr, frames/%04d.png or "
        "frames/####.exr."
    )
