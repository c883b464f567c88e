"""A disk cache for large BVHs in the user's cache folder: they are read faster than built.

The key of a BVH is a hash of all that it is built from, and of the code that builds BVHs.
"""

import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from glrt import accel
from glrt.core import files
from glrt.core.errors import RenderError
from glrt.core.resources import cache_folder

Array = np.ndarray[Any, Any]
Arrays = Mapping[str, Array]

LEAST = 20_000  # triangles of a BVH that is kept: smaller ones are built as fast
MOST_BYTES = 1 << 30  # of all files together; the least recently used are deleted


def kept(known_as: str, build: Callable[[], Arrays]) -> Arrays:
    """Return the arrays that `build` makes, from the cache if it has them, else into the cache.

    `known_as` names the arrays, such as the `key` of a BVH. `build` must return the same arrays for
    the same name, without Python objects in them. Failures to write are ignored.
    """
    path = cache_folder("trees") / f"{known_as}.npz"
    found = _read(path)
    if found is not None:
        with suppress(OSError):
            os.utime(path)
        return found
    made = build()
    with suppress(OSError, RenderError):
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write_whole(path, lambda file: _write(file, made))
        _drop_oldest(path)
    return made


def _write(path: Path, arrays: Arrays) -> None:
    with path.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def _read(path: Path) -> Arrays | None:
    try:
        with path.open("rb") as file, np.load(file) as arrays:
            return {name: arrays[name] for name in arrays.files}
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None


def _drop_oldest(newest: Path) -> None:
    known = [(file.stat(), file) for file in newest.parent.glob("*.npz")]
    total = sum(status.st_size for status, _ in known)
    for status, file in sorted(known, key=lambda pair: pair[0].st_mtime_ns):
        if total <= MOST_BYTES:
            break
        file.unlink()
        total -= status.st_size


def key(parts: Sequence[Array]) -> str:
    """Return a hash of the arrays that a BVH is built from, and of the code that builds it."""
    digest = hashlib.blake2b(_code(), digest_size=16)
    for part in parts:
        digest.update(f"{part.dtype.str} {part.shape}\n".encode())
        digest.update(np.ascontiguousarray(part).view(np.uint8).data)
    return digest.hexdigest()


@cache
def _code() -> bytes:
    """Return the modules that build and pack BVHs, and the version of numpy."""
    here = Path(__file__).parent
    modules = sorted(Path(accel.__file__).parent.glob("*.py"))
    texts = [module.read_bytes() for module in (*modules, here / "triangles.py")]
    return b"\0".join([*texts, np.__version__.encode()])
