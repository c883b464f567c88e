"""The present view as a picture of one pixel: its recipe is what a command renders again."""

from pathlib import Path

import numpy as np

from glrt.core.version import VERSION
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.image.sources import FileRules
from glrt.scene.files.path_text import name_of
from glrt.scene.loading.file_copies import copy_files
from glrt.scene.loading.scene_files import named_files
from glrt.scene.scene import Scene
from glrt.settings import Settings

_NAME = "view.png"


def write_source(
    folder: Path, scene: Scene, settings: Settings, base: Path | None, rules: FileRules
) -> list[str]:
    """Write the picture to a folder; return its path, and options on where its files are.

    They are read from `base`, the folder of the scene, if all lie there as they were read; else
    copies are made. Raises `UsageError` if one has changed since it was read, `RenderError` if
    something cannot be written.
    """
    recipe = Recipe(
        scene=scene, settings=settings, samples=settings.samples, version=VERSION, renderer=""
    )
    file = folder / _NAME
    black = np.zeros((1, 1, 3), np.float32)
    Image(black, np.full_like(black, np.nan), settings.samples, recipe).save(file)
    if base is None or not _all_lie_in(scene, base):
        copy_files(scene, folder)
        return [str(file)]
    outside = ["--allow-outside"] if rules.allow_outside else []
    return [str(file), "--assets-from", str(base), *outside]


def _all_lie_in(scene: Scene, base: Path) -> bool:
    """Whether each file that a scene names was read where a scene in `base` finds it."""
    return all(
        named.origin is not None and _is_same(named.origin, base / name_of(named.path))
        for _, named in named_files(scene)
    )


def _is_same(first: Path, second: Path) -> bool:
    try:
        return first.samefile(second)
    except OSError:
        return False
