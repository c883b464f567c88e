"""Find the SCENE of a command line: a scene file, a name, a model, a rendered picture, or `-`."""

import os
import sys
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, TextIO

from glrt.core.errors import UsageError
from glrt.core.files import reason
from glrt.core.text import escaped
from glrt.image.image import read_recipe
from glrt.image.recipe import Recipe
from glrt.scene.files.assets import AssetFolder
from glrt.scene.loading.scene_files import files_of, with_files
from glrt.scene.model_scene import is_model, model_scene
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import PICTURES, find
from glrt.scene.scenefile.toml import LARGEST, decode_scene, read_scene
from glrt.scene.schema.validation import scene_error
from glrt.settings import Settings

STANDARD_INPUT = "-"  # as a SCENE
_ITS_NAME = "standard input"


class FileRules(NamedTuple):
    """Which files a scene may name, as set by the user, never by a scene or a picture."""

    allow_outside: bool = False  # files outside the folder of the scene
    folder: Path | None = None  # folder of the files, if it is not that of the scene or picture
    accept_changed: bool = False  # files that changed since a picture was made with them
    variant: str | None = None  # of the materials of a model


STRICT = FileRules()


def load(
    source: str | Path,
    *,
    allow_outside: bool = False,
    assets_from: str | Path | None = None,
    accept_changed: bool = False,
    variant: str | None = None,
) -> Scene:
    """Load the scene of a TOML file, of a name in the folder `scenes`, of a model or of a picture.

    A path comes first, then a name, which has no suffix and may contain folders, as
    `methods/glass`. A model is a glTF, USD, OBJ, PLY or STL file. `-` is a TOML file on standard
    input. Files that the scene names are read from its folder, from that of the picture, or from
    `assets_from`; files outside of it need `allow_outside`. Files of a picture must be unchanged
    since it was made, unless `accept_changed`. `variant` names a variant of the materials of a glTF
    file that is given as a model. Raises `SceneError` with one paragraph if there is
    no such scene or it is wrong, `UsageError` for a picture without recipe, and for a `variant` of
    anything else.
    """
    folder = None if assets_from is None else Path(assets_from)
    return load_recipe(source, FileRules(allow_outside, folder, accept_changed, variant))[0]


def load_recipe(source: str | Path, rules: FileRules = STRICT) -> tuple[Scene, Settings | None]:
    """Load a scene, and the settings of a picture's recipe with the samples that it really took.

    The settings are None for a scene file, whose settings are in `scene.render`.
    """
    _check_variant(source, rules)
    recipe = recipe_of(source)
    if recipe is not None:
        return files_read(recipe, find(source), rules).scene, recipe.taken
    if _is_standard_input(source):
        scene, folder = _scene_of(sys.stdin), None
    else:
        path = find(source)
        if is_model(path):
            return _of_model(path, rules, shown(source)), None
        scene, folder = read_scene(path), path.absolute().parent
    return _begun(_with_files(scene, folder, rules, shown(source))), None


def _check_variant(source: str | Path, rules: FileRules) -> None:
    if rules.variant is None or (not _is_standard_input(source) and is_model(find(source))):
        return
    raise UsageError(
        f"{shown(source)} is no model, and only a model may be given with a variant of its "
        "materials. In a scene file, write `variant` in the mesh object."
    )


def _begun(scene: Scene) -> Scene:
    """The scene with the values of frame 0 of its animation."""
    start = scene.at_frame(0)
    return start.model_copy(update={"animation": scene.animation}) if scene.animation else scene


def files_read(recipe: Recipe, picture: Path, rules: FileRules = STRICT) -> Recipe:
    """The recipe of a picture, with the content of the files that it names.

    Raises `SceneError` for a file that is missing, or has changed since the picture was made,
    and `UsageError` for rules with a variant, which a picture keeps.
    """

    def read(scene: Scene) -> Scene:
        return _with_files(scene, picture.absolute().parent, rules, shown(picture), recipe.assets)

    _check_variant(picture, rules)
    if not files_of(recipe.scene):
        return recipe
    update: dict[str, Any] = {"scene": read(recipe.scene)}
    if recipe.traced:
        update["traced"] = recipe.traced.model_copy(update={"scene": read(recipe.traced.scene)})
    return recipe.model_copy(update=update)


def _of_model(path: Path, rules: FileRules, source: str) -> Scene:
    base = path.absolute().parent
    return model_scene(path, AssetFolder(base, rules.allow_outside), source, rules.variant)


def _with_files(
    scene: Scene,
    folder: Path | None,
    rules: FileRules,
    source: str,
    expected: Mapping[str, str] | None = None,
) -> Scene:
    base = rules.folder or folder
    if base is None and files_of(scene):
        raise scene_error(source, "it names files, and has no folder: give --assets-from DIR")
    kept = AssetFolder(base or Path(), rules.allow_outside, expected, rules.accept_changed)
    return with_files(scene, kept, source)


def recipe_of(source: str | Path) -> Recipe | None:
    """The recipe of a rendered picture; None for a scene file, which has none."""
    if _is_standard_input(source):
        return None
    path = find(source)
    return read_recipe(path) if path.suffix.lower() in PICTURES else None


def scene_file_of(source: str | Path) -> Path | None:
    """The scene file that a path or a name means; None for a picture, a model, standard input."""
    if _is_standard_input(source):
        return None
    path = find(source)
    return None if path.suffix.lower() in PICTURES or is_model(path) else path


def shown(source: str | Path) -> str:
    """The name of a SCENE in messages."""
    return _ITS_NAME if _is_standard_input(source) else escaped(str(source))


def check_not_scene(output: str | Path, source: str | Path) -> None:
    """Raise UsageError for an output path that is the scene file, or a link to it."""
    file = None if _is_standard_input(source) else find(source)
    if file is None or file.suffix.lower() in PICTURES:
        return
    if not os.path.exists(output) or not os.path.samefile(output, file):
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
