"""Pictures of a test: rendered, compared with their references, and shown where they differ."""

import hashlib
import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import pytest

from glrt.api import render
from glrt.comparison.heatmap import save_picture
from glrt.comparison.html import Compared, entry_of
from glrt.comparison.result import Comparison
from glrt.comparison.verdict import compare
from glrt.core import files
from glrt.core.errors import GlrtError, UsageError
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.setting_options import FrameOptions
from glrt.settings import settings_for

SAMPLES = 64  # samples per pixel of a picture, unless a test gives another number
TIMES = 4  # as many samples has its reference
FOLDER, FAILED = "references", "failed"  # next to the test file


@dataclass
class Pictures:
    """The fixture `picture`: checks pictures of one test.

    References are in the folder `references`, and pictures of failures in `failed`, both next to
    the test file. Every failure says how to accept the new picture.
    """

    folder: Path  # of the test file
    test: str  # the node id of the test
    alpha: float  # largest chance that an equal picture is called different, of each picture
    most: int = 1  # number of pictures among which the run's chance is divided, for this test
    update: bool = False  # whether missing and different references are written
    parts: Path | None = None  # the folder that collects what the page shows
    written: list[Path] = field(default_factory=list)  # references, by this test
    checked: int = 0

    def check(
        self,
        scene: Scene | str | Path,
        name: str | None = None,
        samples: int = SAMPLES,
        strict: bool = False,
        **settings: Unpack[FrameOptions],
    ) -> Comparison | None:
        """Fail the test if a render of `scene` differs from its reference by more than noise.

        `scene` is a Scene, the path of a scene file from the test file, or the name of a scene of
        glrt. `name` is that of the reference; by default that of the file, or of the test.
        `settings` are fields of Settings. The reference has four times the samples, and another
        seed. With `strict` the test also fails if a change of all light by 1 % might go unseen.
        Returns the comparison; None if `--glrt-update` wrote the reference.
        """
        scene, name = self._begun(scene, name)
        with _failures():
            file, reference = self._reference(name, ".exr")
            image = render(scene, samples, _context(), **settings)
            has_its_size = reference and reference.radiance.shape == image.radiance.shape
            found = compare(image, reference, self.alpha) if reference and has_its_size else None
            if self.parts and reference and found is not None:
                self._add_to_page(entry_of(Compared(name, image, reference, found)))
            passing = ("same",) if strict else ("same", "undecided")
            if found is not None and found.verdict in passing:
                self._forget(name)
                return found
            if self.update:
                seed = settings_for(scene.render, **settings).seed + 1
                more: FrameOptions = {**settings, "seed": seed}
                self._write(render(scene, TIMES * samples, _context(), **more), file)
                return None
            assert reference
            self._show(name, image, reference)
            if found is None:
                raise self._failure(f"the reference {file} has another size", name)
            save_picture(found, self._failed(f"{name}-difference.png"))
            raise self._failure(f"{found}; pictures are in {self.folder / FAILED}", name)

    def same_bits(
        self,
        scene: Scene | str | Path,
        name: str | None = None,
        samples: int = SAMPLES,
        **settings: Unpack[FrameOptions],
    ) -> Image:
        """Fail the test if a render of `scene` has other bits than its reference.

        Arguments are those of `check`. Equal bits are promised on one driver and by one version of
        glrt; a reference of another one fails the test. Returns the picture.
        """
        scene, name = self._begun(scene, name)
        with _failures():
            file, reference = self._reference(name, ".bits.exr")
            image = render(scene, samples, _context(), **settings)
            is_same = reference is not None and _bits(reference) == _bits(image)
            if self.parts and reference:
                self._add_bits_to_page(name, image, reference, is_same)
            if is_same:
                self._forget(name)
                return image
            if self.update:
                self._write(image, file)
                return image
            assert reference
            if foreign := _foreign(image, reference):
                raise self._failure(f"{file} was rendered by {foreign}", name)
            self._show(name, image, reference)
            places = self.folder / FAILED
            raise self._failure(f"its bits are not those of {file}; pictures are in {places}", name)

    def _begun(self, scene: Scene | str | Path, name: str | None) -> tuple[Scene, str]:
        self.checked += 1
        if self.checked > self.most:
            pytest.fail(
                f"this test checks more than {self.most} pictures, among which the chance of a "
                f"false alarm is divided: mark it with @pytest.mark.pictures({self.checked}).",
                pytrace=False,
            )
        if isinstance(scene, Scene):
            return scene, name or _plain(self.test.rpartition("::")[2])
        file = self.folder / scene
        with _failures():
            return load(file if file.exists() else str(scene)), name or file.stem

    def _reference(self, name: str, ending: str) -> tuple[Path, Image | None]:
        file = self.folder / FOLDER / f"{name}{ending}"
        if file.exists():
            return file, Image.load(file)
        if self.update:
            return file, None
        raise self._failure(f"the reference {file} is missing", name)

    def _add_bits_to_page(self, name: str, image: Image, reference: Image, is_same: bool) -> None:
        """Add a picture whose bits were compared, if `compare` can compare it up to noise."""
        try:
            found = compare(image, reference, self.alpha)
        except UsageError:
            return
        entry = entry_of(Compared(f"{name}, bits", image, reference, found))
        entry["verdict"] = "same" if is_same else "different"
        entry["text"] = "equal bits" if is_same else f"the bits differ; up to noise {found}"
        self._add_to_page(entry)

    def _add_to_page(self, entry: dict[str, Any]) -> None:
        assert self.parts
        self.parts.mkdir(parents=True, exist_ok=True)
        number = hashlib.sha256(self.test.encode()).hexdigest()[:16]
        files.write_text(self.parts / f"{number}-{self.checked}.json", json.dumps(entry))

    def _write(self, image: Image, file: Path) -> None:
        file.parent.mkdir(parents=True, exist_ok=True)
        image.save(file)
        self.written.append(file)

    def _show(self, name: str, image: Image, reference: Image) -> None:
        image.save(self._failed(f"{name}.png"))
        reference.save(self._failed(f"{name}-reference.png"))

    def _failed(self, name: str) -> Path:
        file = self.folder / FAILED / name
        file.parent.mkdir(parents=True, exist_ok=True)
        return file

    def _forget(self, name: str) -> None:
        """Delete the pictures of an earlier failure."""
        for kind in ("", "-reference", "-difference"):
            (self.folder / FAILED / f"{name}{kind}.png").unlink(missing_ok=True)

    def _failure(self, reason: str, name: str) -> BaseException:
        return pytest.fail.Exception(
            f"{name}: {reason}. If the new picture is right, write the reference: "
            f"pytest --glrt-update '{self.test}'",
            pytrace=False,
        )


def _plain(text: str) -> str:
    """The name of a file: letters, digits and underscores."""
    return re.sub(r"\W+", "_", text).strip("_")


@contextmanager
def _failures() -> Iterator[None]:
    """Turn errors of glrt into failures of the test, without a traceback."""
    try:
        yield
    except GlrtError as error:
        raise pytest.fail.Exception(str(error), pytrace=False) from None


@cache
def _context() -> Context:
    """One context for all pictures of a process: opening one takes longer than a small picture."""
    return open_context()


def _bits(image: Image) -> tuple[tuple[int, ...], bytes, bytes]:
    parts = (np.ascontiguousarray(it, np.float32) for it in (image.radiance, image.stderr))
    radiance, stderr = (part.tobytes() for part in parts)
    return image.radiance.shape, radiance, stderr


def _foreign(image: Image, reference: Image) -> str | None:
    """The driver and the version of a reference, if the picture has others."""
    own, other = (_maker(it.recipe) for it in (image, reference))
    return None if own == other else f"{other}, and the picture by {own}"


def _maker(recipe: Any) -> str:
    return f"glrt {recipe.version} on {recipe.renderer}" if recipe else "an unknown program"
