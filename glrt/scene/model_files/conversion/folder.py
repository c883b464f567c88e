"""Where the files lie that a file names, and which of them may be read."""

import os
from dataclasses import dataclass, field
from pathlib import Path

from glrt.scene.model_files.conversion.reports import LeftOut


@dataclass
class Folder:
    """The folder of a file: `base` holds all that may be read."""

    root: Path  # the file
    base: Path
    allow_outside: bool
    left: LeftOut
    layers: list[str] = field(default_factory=list)  # other files that were read, from the root's

    def may_read(self, path: str) -> bool:
        """Return whether a file lies in the folder, without links that lead out."""
        if self.allow_outside:
            return True
        return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(self.base))

    def relative(self, path: str) -> str:
        """Return the path of a file from the folder of the root, with '/'."""
        return Path(os.path.relpath(path, self.root.parent)).as_posix()
