"""Scenes by path, by name, or out of a picture's recipe."""

from pathlib import Path

from glrt.errors import SceneError
from glrt.image import read_recipe
from glrt.recipe import Recipe
from glrt.resources import folder
from glrt.scene import Scene, unknown
from glrt.scene_file import read_scene
from glrt.settings import Settings

PICTURES = (".exr", ".png")


def load(source: str | Path) -> Scene:
    """The scene of a TOML file, of a name in the folder `scenes`, or of a rendered picture.

    Names may lead into its folders, as `methods/glass` does.

    A path comes first, then a name with or without `.toml`. Raises `SceneError` with one
    paragraph if there is no such scene or it is wrong, `UsageError` for a picture without recipe.
    """
    return load_recipe(source)[0]


def load_recipe(source: str | Path) -> tuple[Scene, Settings | None]:
    """`load`, and the settings of a picture's recipe with the samples that it really took.

    The settings are None for a scene file, whose wishes are in `scene.render`.
    """
    recipe = recipe_of(source)
    if recipe is None:
        return read_scene(_find(source)), None
    return recipe.scene, recipe.taken


def recipe_of(source: str | Path) -> Recipe | None:
    """The recipe of a rendered picture; None for a scene file, which has none."""
    path = _find(source)
    return read_recipe(path) if path.suffix.lower() in PICTURES else None


def scene_file_of(source: str | Path) -> Path | None:
    """The scene file that a path or a name means; None for a rendered picture."""
    path = _find(source)
    return None if path.suffix.lower() in PICTURES else path


def scene_names() -> list[str]:
    """Names of the scenes that come with glrt, sorted."""
    return sorted(path.stem for path in folder("scenes").glob("*.toml"))


def _find(source: str | Path) -> Path:
    path = Path(source)
    if _is_file(path):
        return path
    named = folder("scenes") / f"{str(path).removesuffix('.toml')}.toml"
    if not (path.is_absolute() or ".." in path.parts) and _is_file(named):
        return named
    if str(path) != path.name or path.suffix.lower() in PICTURES:
        return path  # meant as a path: its reader says what is wrong with it
    names = scene_names()
    advice = unknown("scene", path.name.removesuffix(".toml"), names, "Scenes that come with glrt")
    raise SceneError(f"{advice[0].upper()}{advice[1:]} Or give the path of a scene file.")


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name too long for the system, or a folder closed to the user
        return False
