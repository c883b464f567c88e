"""The scenes that come with glrt, by name."""

from pathlib import Path

from glrt.errors import SceneError
from glrt.resources import folder
from glrt.text import unknown

PICTURES = (".exr", ".png")
MODELS = (".glb", ".gltf", ".obj", ".ply", ".stl")


def scene_names() -> list[str]:
    """Names of the scenes that come with glrt, sorted."""
    return sorted(path.stem for path in folder("scenes").glob("*.toml"))


def all_scene_names() -> list[str]:
    """`scene_names`, and then those in folders, as `methods/glass`."""
    root = folder("scenes")
    deeper = (path.relative_to(root).with_suffix("") for path in root.glob("*/**/*.toml"))
    return [*scene_names(), *sorted(path.as_posix() for path in deeper)]


def file_of(name: str) -> Path:
    """The file of a scene that comes with glrt."""
    return folder("scenes") / f"{name}.toml"


def find(source: str | Path) -> Path:
    """The file that a path or a name means; SceneError for an unknown name."""
    path = Path(source)
    if _is_file(path):
        return path
    named = file_of(str(path).removesuffix(".toml"))
    if not (path.is_absolute() or ".." in path.parts) and _is_file(named):
        return named
    if str(path) != path.name or path.suffix.lower() in (*PICTURES, *MODELS):
        return path  # meant as a path: its reader says what is wrong with it
    names = all_scene_names()
    short = {name.rpartition("/")[2]: name for name in reversed(names)}
    word, owner = path.name.removesuffix(".toml"), "Scenes that come with glrt"
    advice = unknown("scene", word, names, owner, short)
    raise SceneError(f"{advice[0].upper()}{advice[1:]} Or give the path of a scene file.")


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name too long for the system, or a folder closed to the user
        return False
