"""First line of a recovery file: the scene that it belongs to, and when it was saved."""

import json
from dataclasses import asdict, dataclass
from datetime import datetime
from hashlib import sha256
from pathlib import Path

from glrt.core.errors import SceneError
from glrt.core.files import check_regular
from glrt.core.memo import kept_for_the_same
from glrt.core.resources import state_folder
from glrt.image.sources import STANDARD_INPUT
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import file_of, find
from glrt.scene.schema.tables import toml_text

_MARK = "# glrt recovery "
_LONGEST = 1 << 16  # bytes of the first line
_CONTENT = "content:"  # before the hash of a scene from standard input


@dataclass(frozen=True)
class Header:
    """Which scene the edits belong to, when they were saved, and files that the scene lacks.

    `saved` is in seconds since 1970. `edits` counts steps of undo since the scene was saved or
    opened; None if that is unknown. `models` are the paths of models and images that
    were added.
    """

    source: str
    saved: float
    edits: int | None = None
    models: tuple[str, ...] = ()

    def line(self) -> str:
        """Return the line, a comment of TOML."""
        return f"{_MARK}{json.dumps(asdict(self))}\n"

    def told(self, now: float) -> str:
        """Return a line as "2 edits, made until 14:03, were not saved."; `now` as `saved`."""
        then, today = datetime.fromtimestamp(self.saved), datetime.fromtimestamp(now)
        is_today = then.date() == today.date()
        at = f"{then:%H:%M}" if is_today else f"{then.day} {then:%B %Y, %H:%M}"
        count = f"{self.edits} edit{'s' * (self.edits != 1)}" if self.edits else "Edits"
        return f"{count}, made until {at}, {'was' if self.edits == 1 else 'were'} not saved."


def header_of(file: Path) -> Header | None:
    """Return the header of a recovery file; None if it has none, or cannot be read."""
    try:
        check_regular(file)
        with file.open("rb") as content:
            line = content.readline(_LONGEST).decode("utf-8")
        return _parsed(line) if line.startswith(_MARK) else None
    except (OSError, ValueError, TypeError, LookupError, OverflowError, RecursionError):
        return None


def _parsed(line: str) -> Header:
    given = json.loads(line.removeprefix(_MARK))
    edits, saved = given["edits"], float(given["saved"])
    datetime.fromtimestamp(saved)  # a time that can be shown
    count = edits if isinstance(edits, int) and edits > 0 else None
    return Header(str(given["source"]), saved, count, tuple(map(str, given["models"])))


def key_of(source: str, scene: Scene) -> str:
    """Return a name of a scene by which another window knows it; "" if there is none.

    It is the absolute path of a file, or the name of a scene that comes with glrt. A scene from
    standard input is known by a hash of its content.
    """
    if source == STANDARD_INPUT:
        return _key_of_content(scene)
    if not source:
        return ""
    try:
        path = find(source)
    except SceneError:
        return ""
    is_name = not Path(source).is_file() and path == file_of(source)
    return source if is_name else str(path.resolve())


@kept_for_the_same
def _key_of_content(scene: Scene) -> str:
    return _CONTENT + sha256(toml_text(scene).encode()).hexdigest()


def base_of(source: str) -> Path:
    """Return the folder in which the files of a scene lie; SceneError if it is not found."""
    return Path.cwd() if source == STANDARD_INPUT else find(source).absolute().parent


def is_gone(key: str) -> bool:
    """Whether no window can open the scene of a key by its file: it is deleted, or had none.

    A file in a folder that is not there counts as present: its disk may not be mounted.
    """
    if key.startswith(_CONTENT):
        return True
    path = Path(key)
    return path.is_absolute() and path.parent.is_dir() and not path.exists()


def recovery_folder() -> Path:
    """Return the folder of recovery files, in the user's folder for states of programs."""
    return state_folder() / "recovery"
