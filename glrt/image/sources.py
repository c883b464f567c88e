"""Find the SCENE of a command line: a scene file, a name, or a picture with its recipe."""

from pathlib import Path

from glrt.image.image import read_recipe
from glrt.image.recipe import Recipe
from glrt.scene.catalog import PICTURES, find
from glrt.scene.scene import Scene
from glrt.scene.toml import read_scene
from glrt.settings import Settings


def load(source: str | Path) -> Scene:
    """The scene of a TOML file, of a name in the folder `scenes`, or of a rendered picture.

    A path comes first, then a name with or without `.toml`; a name may contain folders, as
    `methods/glass`. Raises `SceneError` with one paragraph if there is no such scene or it is
    wrong, `UsageError` for a picture without recipe.
    """
    return load_recipe(source)[0]


def load_recipe(source: str | Path) -> tuple[Scene, Settings | None]:
    """`load`, and the settings of a picture's recipe with the samples that it really took.

    The settings are None for a scene file, whose wishes are in `scene.render`.
    """
    recipe = recipe_of(source)
    if recipe is None:
        return read_scene(find(source)), None
    return recipe.scene, recipe.taken


def recipe_of(source: str | Path) -> Recipe | None:
    """The recipe of a rendered picture; None for a scene file, which has none."""
    path = find(source)
    return read_recipe(path) if path.suffix.lower() in PICTURES else None


def scene_file_of(source: str | Path) -> Path | None:
    """The scene file that a path or a name means; None for a rendered picture."""
    path = find(source)
    return None if path.suffix.lower() in PICTURES else path
