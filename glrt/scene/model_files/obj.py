"""OBJ files as arrays (Wavefront, "Advanced Visualizer" manual, appendix B1)."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import chain, repeat

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError, NothingShownError
from glrt.core.text import counted, quoted
from glrt.scene.images.codes import decode_srgb
from glrt.scene.meshes.checked_meshes import MeshArrays
from glrt.scene.meshes.triangle_meshes import NO_MATERIAL
from glrt.scene.model_files.polygons import triangulated
from glrt.scene.model_files.text_lines import lines_of, number_rows, whole_numbers

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LARGEST = 1 << 32  # number of a vertex
_LEAST_CORNERS = 3  # of a face
_COLORED = 6  # numbers of a vertex with a color
_CODES = 255.0  # the largest color where a file has whole numbers
_OF_CURVES = ("curv", "curv2", "surf", "vp", "deg", "cstype", "parm", "trim", "hole", "end")
_COMMENT = re.compile(r"\s#\s.*$")  # names may have a # within
_FILES = re.compile(r"\S.*?\.mtl(?=\s|$)", re.IGNORECASE)  # names may have blanks
_KINDS = ("v", "vt", "vn")
_ROWS = {"v": "vertices", "vt": "texture coordinates", "vn": "normals"}


@dataclass
class _Lines:
    """Lines that begin with one keyword."""

    texts: list[str] = field(default_factory=list)
    places: list[int] = field(default_factory=list)  # numbers of the lines, from 0


def libraries(content: bytes) -> list[str]:
    """Return the paths of the MTL files that an OBJ file names, relative to it, each once."""
    found: list[str] = []
    for text in _statements(content).get("mtllib", _Lines()).texts:
        found += _FILES.findall(text) or [text]
    return list(dict.fromkeys(found))


def read_obj(content: bytes) -> tuple[MeshArrays, tuple[str, ...]]:
    """Return the mesh of an OBJ file, and what is left out of it, in words.

    Corners share a vertex if their place, texture coordinates and normal are the same. ValueError
    names a line that cannot be read.
    """
    lines = _statements(content)
    empty = _Lines()
    table = {
        kind: number_rows(*_rows_of(lines.get(kind, empty)), least)
        for kind, least in zip(_KINDS, (3, 1, 3), strict=True)
    }
    words, faces, unread = _faces_of(lines.get("f", empty))
    if not words:
        raise (NothingShownError if len(table["v"]) else ContentError)("it has no faces")
    counts = np.fromiter(map(len, words), np.int64, len(words))
    corners, missing = _corners(words, faces, lines, table)
    unread += missing
    names, labels = _materials(lines.get("usemtl", empty), faces)
    groups = _groups(lines.get("s"), faces)
    triangles, owner = triangulated(table["v"][:, :3], corners[:, 0], counts)
    keys, place = _unique(corners)
    arrays = MeshArrays(
        table["v"][keys[:, 0], :3],
        place[triangles],
        _picked(table["vn"], keys[:, 2], 0.0),
        _colors(table["v"], keys[:, 0]),
        names,
        None if labels is None else labels[owner],
        _coordinates(table["vt"], keys[:, 1]),
        groups[owner],
    )
    curves = sum(len(lines[word].texts) for word in _OF_CURVES if word in lines)
    unread += [counted(curves, "line") + " of curves and surfaces"] if curves else []
    return arrays, tuple(unread)


def _statements(content: bytes) -> dict[str, _Lines]:
    """Return the lines of a file by keyword, without it and without comments."""
    found: dict[str, _Lines] = {}
    pending = ""
    for place, line in enumerate(lines_of(content)):
        if line.endswith("\\"):
            pending += line[:-1] + " "
            continue
        if pending:
            line, pending = (pending + line).strip(), ""
        if "#" in line:
            line = "" if line[0] == "#" else _COMMENT.sub("", line)
        word, _, rest = line.partition(" ")
        own = found.get(word)
        if own is None:
            own = found[word] = found.setdefault(word.lower(), _Lines())
        own.texts.append(rest)
        own.places.append(place)
    return found


def _rows_of(lines: _Lines) -> tuple[Sequence[str], Sequence[int]]:
    return [_uncommented(text) for text in lines.texts], lines.places


def _uncommented(text: str) -> str:
    return text.partition("#")[0].rstrip() if "#" in text else text


def _faces_of(lines: _Lines) -> tuple[list[list[str]], list[int], list[str]]:
    """Return the words of faces with three corners at least, their lines, and what is left out."""
    words = [_uncommented(text).split() for text in lines.texts]
    kept = [number for number, face in enumerate(words) if len(face) >= _LEAST_CORNERS]
    if len(kept) == len(words):
        return words, lines.places, []
    left = counted(len(words) - len(kept), "face")
    unread = [f"{left} of fewer than three corners"]
    return [words[k] for k in kept], [lines.places[k] for k in kept], unread


def _corners(
    words: list[list[str]],
    faces: Sequence[int],
    lines: dict[str, _Lines],
    table: dict[str, Floats],
) -> tuple[Ints, list[str]]:
    """Return numbers of place, coordinates and normal of each corner, (c, 3), -1 for none.

    And what is left out: numbers of coordinates and normals that the file lacks.
    """
    of_line = np.repeat(faces, [len(face) for face in words])
    given = _indices(list(chain.from_iterable(words)), of_line)
    found = np.full(given.shape, -1)
    unread = list[str]()
    for column, kind in enumerate(_KINDS):
        index = given[:, column]
        places = lines[kind].places if kind in lines else []
        before = np.searchsorted(places, of_line)
        number = np.where(index > 0, index - 1, np.where(index < 0, before + index, -1))
        wrong = (number >= len(table[kind])) | (number < 0) & (index != 0)
        if kind == "v":
            wrong |= index == 0
            _check_vertices(wrong, index, of_line, len(table[kind]))
        elif wrong.any():
            unread.append(f"{_ROWS[kind]} of {counted(int(wrong.sum()), 'corner')}")
        found[:, column] = np.where(wrong, -1, number)
    return found, unread


def _check_vertices(wrong: NDArray[np.bool_], index: Ints, of_line: Ints, count: int) -> None:
    if wrong.any():
        corner = int(wrong.argmax())
        line = of_line[corner] + 1
        has = counted(count, "vertex")
        raise ContentError(f"line {line} names vertex {index[corner]}, and the file has {has}")


def _indices(words: list[str], of_line: Ints) -> Ints:
    """Return the numbers in words such as 1, 1/2, 1//3 and 1/2/3, (c, 3), 0 for none.

    `of_line` are the lines of the words, from 0, (c,).
    """
    slashes = np.fromiter(map(str.count, words, repeat("/")), np.int64, len(words))
    doubles = np.fromiter(map(str.count, words, repeat("//")), np.int64, len(words))
    found = np.zeros((len(words), len(_KINDS)), np.int64)
    forms = np.unique(np.column_stack([slashes, doubles]), axis=0)
    for slash, double in forms:
        rows = np.flatnonzero((slashes == slash) & (doubles == double))
        some = words if len(rows) == len(words) else [words[row] for row in rows]
        columns = [0, 2] if double else list(range(min(int(slash), 2) + 1))
        try:
            numbers = whole_numbers([" ".join(some).replace("/", " ")], [0])
            found[rows[:, None], columns] = numbers.reshape(len(rows), len(columns))
        except ValueError:
            for row in rows:
                found[row] = _index(words[row], int(of_line[row]))
    return found


def _index(word: str, place: int) -> list[int]:
    parts = word.split("/")
    try:
        numbers = [int(part) if part else 0 for part in parts]
    except ValueError:
        numbers = []
    if not 1 <= len(numbers) <= len(_KINDS) or max(map(abs, numbers)) > _LARGEST:
        raise ContentError(f"line {place + 1} has a corner that is not numbers: {quoted(word)}")
    return [*numbers, 0, 0][: len(_KINDS)]


def _materials(lines: _Lines, places: Sequence[int]) -> tuple[tuple[str, ...], Ints | None]:
    """Return the names that faces use, in their order, and the number of each face's, (p,)."""
    if not any(lines.texts):
        return (), None
    before = np.searchsorted(lines.places, places)
    spelled = [NO_MATERIAL, *(text or NO_MATERIAL for text in lines.texts)]
    used, first, own = np.unique(before, return_index=True, return_inverse=True)
    order = [spelled[used[k]] for k in np.argsort(first)]
    numbers = {name: number for number, name in enumerate(dict.fromkeys(order))}
    return tuple(numbers), np.array([numbers[spelled[k]] for k in used])[own]


def _groups(lines: _Lines | None, places: Sequence[int]) -> Ints:
    """Return the smoothing group of each face, (p,); 0 for none."""
    if lines is None:
        return np.zeros(len(places), np.int64)
    names = {"": 0, "off": 0, "0": 0}
    numbers = [0] + [names.setdefault(text.lower(), len(names)) for text in lines.texts]
    return np.array(numbers)[np.searchsorted(lines.places, places)]


def _unique(rows: Ints) -> tuple[Ints, Ints]:
    """Return rows of whole numbers, each once in the order of the first, and the place of each."""
    low = rows.min(axis=0)
    spans = rows.max(axis=0) - low + 1
    key = np.zeros(len(rows), np.int64)
    for column, span in enumerate(spans):
        key = key * span + (rows[:, column] - low[column])
    _, first, inverse = np.unique(key, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rows[first[order]], rank[inverse]


def _picked(rows: Floats, numbers: Ints, missing: float) -> Floats | None:
    """Return rows by number, (v, 3), `missing` where the number is -1; None without any."""
    if not len(rows) or (numbers < 0).all():
        return None
    return np.where((numbers < 0)[:, None], missing, rows[numbers, :3])


def _coordinates(rows: Floats, numbers: Ints) -> Floats | None:
    """Return texture coordinates, (v, 4), both sets the same, with v growing downwards; or None.

    They are 0 where there are none.
    """
    if not len(rows) or (numbers < 0).all():
        return None
    u = np.where(numbers < 0, 0.0, rows[numbers, 0])
    v = np.where(numbers < 0, 1.0, rows[numbers, 1] if rows.shape[1] > 1 else 0.0)
    return np.stack([u, 1 - v, u, 1 - v], axis=1)


def _colors(vertices: Floats, numbers: Ints) -> Floats | None:
    """Return linear colors, (v, 3), of lines `v x y z r g b`; NaN where there are none; or None."""
    if vertices.shape[1] < _COLORED:
        return None
    codes = vertices[numbers, 3:6]
    some = codes[np.isfinite(codes)]
    if some.size and some.max() > 1 and ((some == 0) | (some > 1) & (some == some.round())).all():
        codes = codes / _CODES  # the file has whole numbers, which the format does not provide for
    return decode_srgb(codes)
