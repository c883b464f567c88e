"""The scenes that come with glrt, by name."""

from collections.abc import Callable
from pathlib import Path

from glrt.core.errors import SceneError
from glrt.core.resources import folder
from glrt.core.text import unknown

PICTURES = (".exr", ".png")
MODELS = (".glb", ".gltf", ".obj", ".ply", ".stl", ".usd", ".usda", ".usdc", ".usdz", ".mtlx")


def scene_names() -> list[str]:
    """Return the names of the scenes that come with glrt, sorted."""
    return sorted(path.stem for path in folder("scenes").glob("*.toml"))


def all_scene_names() -> list[str]:
    """Return `scene_names`, and then the names of scenes in folders, such as `methods/glass`."""
    root = folder("scenes")
    deeper = (path.relative_to(root).with_suffix("") for path in root.glob("*/**/*.toml"))
    return [*scene_names(), *sorted(path.as_posix() for path in deeper)]


def file_of(name: str) -> Path:
    """Return the file of a scene that comes with glrt."""
    return folder("scenes") / f"{name}.toml"


def find(source: str | Path) -> Path:
    """Return the file that a path or a name means; SceneError for an unknown name.

    A word that ends as a scene file, a model or a picture is a path, and never a name: a file that
    is missing must not be replaced by another one.
    """
    path = Path(source)
    is_path = path.suffix.lower() in (".toml", *PICTURES, *MODELS)
    if is_path or _is(path.is_file):
        return path
    named = file_of(str(path))
    if not (path.is_absolute() or ".." in path.parts) and _is(named.is_file):
        return named
    if str(path) != path.name or _is(path.is_dir):
        return path  # meant as a path: its reader says what is wrong with it
    names = all_scene_names()
    short = {name.rpartition("/")[2]: name for name in reversed(names)}
    advice = unknown("scene", path.name, names, "Scenes that come with glrt", short)
    raise SceneError(f"{advice[0].upper()}{advice[1:]} Or give the path of a scene file.")


def _is(kind: Callable[[], bool]) -> bool:
    try:
        return kind()
    except OSError:  # a name too long for the system, or a folder closed to the user
        return False
