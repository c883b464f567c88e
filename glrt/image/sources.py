"""Find the SCENE of a command line: a scene file, a name, a picture with its recipe, or `-`."""

import os
import sys
from functools import lru_cache
from pathlib import Path
from typing import TextIO

from glrt.errors import UsageError
from glrt.files import reason
from glrt.image.image import read_recipe
from glrt.image.recipe import Recipe
from glrt.scene.catalog import PICTURES, find
from glrt.scene.scene import Scene
from glrt.scene.toml import LARGEST, decode_scene, read_scene
from glrt.scene.validation import scene_error
from glrt.settings import Settings
from glrt.text import escaped

STANDARD_INPUT = "-"  # as a SCENE
_ITS_NAME = "standard input"


def load(source: str | Path) -> Scene:
    """The scene of a TOML file, of a name in the folder `scenes`, or of a rendered picture.

    A path comes first, then a name with or without `.toml`; a name may contain folders, as
    `methods/glass`. `-` is a TOML file on standard input. Raises `SceneError` with one paragraph if
    there is no such scene or it is wrong, `UsageError` for a picture without recipe.
    """
    return load_recipe(source)[0]


def load_recipe(source: str | Path) -> tuple[Scene, Settings | None]:
    """`load`, and the settings of a picture's recipe with the samples that it really took.

    The settings are None for a scene file, whose wishes are in `scene.render`.
    """
    if _is_standard_input(source):
        return _scene_of(sys.stdin), None
    recipe = recipe_of(source)
    if recipe is None:
        return read_scene(find(source)), None
    return recipe.scene, recipe.taken


def recipe_of(source: str | Path) -> Recipe | None:
    """The recipe of a rendered picture; None for a scene file, which has none."""
    if _is_standard_input(source):
        return None
    path = find(source)
    return read_recipe(path) if path.suffix.lower() in PICTURES else None


def scene_file_of(source: str | Path) -> Path | None:
    """The scene file that a path or a name means; None for a picture, and for standard input."""
    if _is_standard_input(source):
        return None
    path = find(source)
    return None if path.suffix.lower() in PICTURES else path


def shown(source: str | Path) -> str:
    """What messages call a SCENE."""
    return _ITS_NAME if _is_standard_input(source) else escaped(str(source))


def check_not_scene(output: str | Path, source: str | Path) -> None:
    """Raise UsageError for an output that would replace the scene file, be it through a link."""
    file = scene_file_of(source)
    if file is None or not os.path.exists(output) or not os.path.samefile(output, file):
        return
    raise UsageError(
        f"Cannot write {output}: it is the scene file itself, or a link to it, {file}. Choose "
        "another name."
    )


def _is_standard_input(source: str | Path) -> bool:
    return str(source) == STANDARD_INPUT


@lru_cache(maxsize=1)  # it can be read once, and a command asks for its scene several times
def _scene_of(stream: TextIO | None) -> Scene:
    if stream is None:
        raise scene_error(_ITS_NAME, "it is closed; send a scene, as in `< room.toml`")
    try:
        if stream.isatty():
            text = "glrt: caution: reading the scene from standard input, which is a terminal: "
            print(f"{text}type it, then Ctrl-D, or leave with Ctrl-C.", file=sys.stderr, flush=True)
        content = stream.buffer.read(LARGEST + 1)
    except (OSError, ValueError) as error:
        raise scene_error(_ITS_NAME, f"cannot be read: {reason(error)}") from None
    if not content.strip():
        raise scene_error(_ITS_NAME, "it is empty; send a scene, as in `< room.toml`")
    return decode_scene(content, _ITS_NAME)
