"""Bands that have arrived, in a folder next to the picture until that is written.

A band counts only for the same scene, settings, version of glrt and driver: their digest is in the
name of its file.
"""

import hashlib
import json
import re
from contextlib import suppress
from pathlib import Path
from typing import Any, Protocol

from glrt.core.errors import GlrtError, RenderError
from glrt.core.version import VERSION
from glrt.image.image import Image
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import scene_to_dict
from glrt.settings import Settings

_NAME = re.compile(r"([0-9a-f]{16})-(\d{1,2})\.exr")


class Subject(Protocol):
    """The picture that the bands are of."""

    @property
    def scene(self) -> Scene:
        """Its scene, with the files that it names."""

    @property
    def settings(self) -> Settings:
        """Its settings."""


class KeptBands:
    """The finished bands of a picture; with `OUT.exr` they lie in `OUT.exr.bands`."""

    def __init__(self, output: Path) -> None:
        """Look at nothing yet."""
        self.folder = output.with_name(f"{output.name}.bands")
        self.count = 0  # of bands that are kept

    def found(self, subject: Subject, renderer: str) -> dict[int, Image]:
        """Return the bands that stand, by their number; damaged files are left out."""
        self._digest = _digest(subject, renderer)
        bands = dict[int, Image]()
        for path in sorted(self.folder.glob("*.exr")):
            match = _NAME.fullmatch(path.name)
            if match and match[1] == self._digest:
                with suppress(GlrtError):
                    bands[int(match[2])] = Image.load(path)
        self.count = len(bands)
        return bands

    def keep(self, number: int, band: Image) -> None:
        """Save a band; raises `RenderError` if it cannot be written."""
        try:
            self.folder.mkdir(exist_ok=True)
        except OSError as error:
            raise RenderError(f"cannot make {self.folder}: {error.strerror}.") from error
        band.save(self.folder / f"{self._digest}-{number}.exr")
        self.count += 1

    def remove(self) -> None:
        """Remove the folder with all bands in it, of other scenes, too; other files stay."""
        with suppress(OSError):
            for path in self.folder.glob("*.exr"):
                if _NAME.fullmatch(path.name):
                    path.unlink()
            self.folder.rmdir()


def _digest(subject: Subject, renderer: str) -> str:
    made: list[Any] = [scene_to_dict(subject.scene), hashes_of(subject.scene), VERSION, renderer]
    text = json.dumps([*made, subject.settings.model_dump(mode="json")], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]
