"""Read scene files: TOML into scenes."""

import re
import tomllib
from collections.abc import Mapping
from errno import EFBIG, EINVAL
from pathlib import Path
from typing import Any

from glrt.core.files import read_at_most
from glrt.core.text import nearest, quoted
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import all_scene_names
from glrt.scene.schema.tables import scene_to_dict as scene_to_dict
from glrt.scene.schema.validation import scene_error, validated

# A scene of 65,536 quads with every number at full length takes 18 MB.
LARGEST = 32 << 20  # bytes of a scene

# tomllib takes a minute and 6 GB for a key of 40,000 parts. Keys of a scene have four at most.
_MOST_PARTS = 64
_PART = r"""(?:(?<![\w-])[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+"""
_LONG_KEY = re.compile(rf"(?:{_PART}\.[ \t]*+){{{_MOST_PARTS}}}")


def read_scene(path: Path) -> Scene:
    """Return the scene in a TOML file; raises `SceneError`, which begins with the path."""
    source = str(path)
    return decode_scene(_content(path, source), source)


def decode_scene(content: bytes, source: str) -> Scene:
    """Return the scene in the content of a TOML file; messages call it `source`.

    Raises `SceneError` with one paragraph that begins with `source`.
    """
    if len(content) > LARGEST:
        problem = f"it is longer than {LARGEST >> 20} MiB, more than 65,536 objects take"
        raise scene_error(source, f"not a scene: {problem}")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise scene_error(
            source, "not a text file in UTF-8; a scene is a TOML file, see the folder scenes"
        ) from None
    return parse_scene(_toml(text, source), source)


def parse_scene(data: Mapping[str, Any], source: str) -> Scene:
    """Return the scene in parsed TOML or JSON; messages call it `source`.

    Raises `SceneError` with one paragraph that begins with `source`.
    """
    return validated(Scene, data, source)


def _content(path: Path, source: str) -> bytes:
    try:
        return read_at_most(path, LARGEST)
    except FileNotFoundError:
        raise scene_error(source, f"no such file{_neighbour(path)}") from None
    except IsADirectoryError:
        raise scene_error(source, "is a folder; name a scene file in it") from None
    except OSError as error:
        raise scene_error(source, _obstacle(error)) from None
    except ValueError:  # for a NUL, or characters outside the system's encoding
        raise scene_error(source, "no file can have this name; check it") from None


def _obstacle(error: OSError) -> str:
    if error.errno == EFBIG:
        return f"not a scene: it is {error.strerror}, more than 65,536 objects take"
    if error.errno == EINVAL and error.strerror:
        return f"is {error.strerror}; save the scene to a file first"
    return f"cannot be read: {error.strerror or 'unknown reason'}; check its permissions"


def _neighbour(path: Path) -> str:
    near = nearest(path.name, tuple(sorted(other.name for other in path.parent.glob("*.toml"))))
    if near:
        return f"; did you mean {quoted(near)}?"
    if (name := path.with_suffix("").as_posix()) in all_scene_names():
        return f"; the scene that comes with glrt is called {quoted(name)}"
    return "; check the path"


def _toml(text: str, source: str) -> dict[str, Any]:
    if found := _LONG_KEY.search(text):
        line = text.count("\n", 0, found.start()) + 1
        raise scene_error(source, f"not a scene: a key of {_MOST_PARTS} parts in line {line}")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise scene_error(source, "not a scene: its lists are nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        where = str(error).replace("end of document", f"line {text.count(chr(10)) + 1}, the end")
        raise scene_error(source, f"not valid TOML: {where}; correct that line") from None
    except ValueError:  # from int(), which stops at 4300 digits
        raise scene_error(source, "not a scene: a number has thousands of digits") from None
