"""The scenes that come with glrt, by name."""

from pathlib import Path

from glrt.errors import SceneError
from glrt.resources import folder
from glrt.text import unknown

PICTURES = (".exr", ".png")


def scene_names() -> list[str]:
    """Names of the scenes that come with glrt, sorted."""
    return sorted(path.stem for path in folder("scenes").glob("*.toml"))


def find(source: str | Path) -> Path:
    """The file that a path or a name means; SceneError for an unknown name."""
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
