"""Read files of triangle meshes as arrays: PLY, OBJ and STL by trimesh, and glTF."""

import logging
import re
import warnings
from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import PurePosixPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import SceneError
from glrt.core.text import quoted
from glrt.scene.images.image_files import decode_srgb
from glrt.scene.meshes.triangle_meshes import NO_MATERIAL, MeshArrays, TriangleMesh, of_file
from glrt.scene.meshes.vertex_means import places
from glrt.scene.model_files.gltf.document import Document
from glrt.scene.model_files.gltf.draco import NotInstalledError
from glrt.scene.model_files.gltf.primitives import mesh_of

FORMATS = (".ply", ".obj", ".stl", ".glb", ".gltf")
GLTF = (".glb", ".gltf")
Fetch = Callable[[str], bytes]  # the content of a file by its path from this one

_BOM = b"\xef\xbb\xbf"
_LIBRARY = re.compile(rb"^mtllib[ \t]+(.+)$", re.MULTILINE)
_IDLE = re.compile(rb"^[ \t]*(?:#.*|[gos](?:[ \t].*)?)$|[ \t]#[ \t].*$", re.MULTILINE)
_FILES = re.compile(r"\S.*?\.mtl(?=\s|$)", re.IGNORECASE)  # names may have blanks
_PARTS = re.compile(rb"^(?:usemtl (.*)|f)", re.MULTILINE)


def decode_mesh(content: bytes, path: str, where: str, fetch: Fetch | None = None) -> TriangleMesh:
    """Return the mesh in the content of a file; the suffix of its path decides the format.

    Polygons are divided into triangles. Vertex colours are linear where a PLY file has them as
    floats, else sRGB. The names of materials of OBJ and glTF files are read; colours of faces are
    not. `fetch` reads the buffers of glTF files. Raises `SceneError`, which begins with `where`, if
    there is no mesh.
    """
    suffix = PurePosixPath(path).suffix.lower()
    if suffix not in FORMATS:
        raise SceneError(
            f"{where}: {quoted(path)} is no file of a mesh that glrt reads, which end in .glb, "
            ".gltf, .obj, .ply or .stl. Convert it to one of them."
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of arithmetic with NaN, which is found below
            if suffix in GLTF:
                return mesh_of(Document(content, fetch or _alone))
            if suffix == ".obj":
                content = _plain_lines(content)
            if suffix == ".obj" and b"usemtl" in content:
                return _mesh(_reader(suffix)(BytesIO(content)), suffix, _names(content))
            return _mesh(_reader(suffix)(BytesIO(content)), suffix)
    except SceneError:
        raise  # of a file next to it
    except NotInstalledError as error:
        raise SceneError(f"{where}: {quoted(path)} {error}") from None
    except MemoryError:
        problem = "it says that it is larger than the memory"
    except Exception as error:  # trimesh raises errors of many kinds
        problem = _reason(error)
    raise SceneError(
        f"{where}: {quoted(path)} is damaged, or no {suffix[1:].upper()} file: {problem}. Export "
        "it again."
    )


def _alone(path: str) -> bytes:
    raise ValueError(f"it names {quoted(path)}, and only its own content is at hand")


def libraries(content: bytes) -> list[str]:
    """Return the paths of the MTL files that an OBJ file names, relative to it, each once."""
    found: list[str] = []
    for line in _LIBRARY.findall(_plain_lines(content)):
        text = line.decode("utf-8", "replace").strip()
        found += _FILES.findall(text) or [text]
    return list(dict.fromkeys(found))


def _plain_lines(content: bytes) -> bytes:
    """Return an OBJ file without comments, continued lines, and names of anything but materials.

    trimesh takes "usemtl" for a material wherever it stands. A '#' may be part of a name.
    """
    text = content.removeprefix(_BOM).replace(b"\r\n", b"\n").replace(b"\\\n", b"")
    text = _IDLE.sub(b"", text)
    return re.sub(rb"^[ \t]*(usemtl|mtllib)[ \t]+", rb"\1 ", text, flags=re.MULTILINE)


def _names(content: bytes) -> list[str]:
    """Return the material of each run of faces, in the order of trimesh: backwards."""
    found, name, is_new = list[str](), "", True
    for match in _PARTS.finditer(content):
        if match[0] != b"f":
            name, is_new = match[1].decode("utf-8", "replace").strip(), True
        elif is_new:
            found.append(name)
            is_new = False
    return found[::-1]


def _reader(suffix: str) -> Callable[[Any], dict[str, Any]]:
    """Return trimesh's reader for a suffix; its import takes 0.3 s, which only meshes pay."""
    from trimesh.exchange.obj import load_obj
    from trimesh.exchange.ply import load_ply
    from trimesh.exchange.stl import load_stl

    logging.getLogger("trimesh").setLevel(logging.CRITICAL + 1)  # mistakes are reported once

    def obj(file: Any) -> dict[str, Any]:
        return dict(load_obj(file, skip_materials=True, group_material=False))

    def ply(file: Any) -> dict[str, Any]:
        return dict(load_ply(file, skip_materials=True))

    readers: dict[str, Callable[[Any], dict[str, Any]]] = {
        ".obj": obj,
        ".ply": ply,
        ".stl": load_stl,
    }
    return readers[suffix]


def _mesh(tables: dict[str, Any], suffix: str, owners: Sequence[str] = ()) -> TriangleMesh:
    """Return what trimesh read as one mesh; of several, each has the material of its owner."""
    parts = list(tables["geometry"].values()) if "geometry" in tables else [tables]
    vertices, faces, first = [], [], 0
    normals: list[Any] = []
    colors: list[Any] = []
    sets: list[Any] = []
    for part in parts:
        points = np.asarray(part["vertices"], np.float64).reshape(-1, 3)
        vertices.append(points)
        faces.append(_fans(np.asarray(part.get("faces", ()), np.int64)) + first)
        normals.append(part.get("vertex_normals"))
        colors.append(_linear(part.get("vertex_colors"), suffix))
        sets.append(_uv(part.get("visual"), len(points)))
        first += len(points)
    if not vertices:
        raise ValueError("it has no triangles")
    points, triangles = np.concatenate(vertices), np.concatenate(faces)
    if suffix == ".stl":  # triangles share no vertices in STL files
        return of_file(MeshArrays(points, places(points)[triangles]))
    names, labels = _labels(owners, [len(rows) for rows in faces])
    rows = _joined(normals), _joined(colors), names, labels, _joined(sets)
    return of_file(MeshArrays(points, triangles, *rows))


def _uv(visual: Any, count: int) -> NDArray[np.float64] | None:
    """Return texture coordinates, (v, 4), both sets the same, with v growing downwards; or None."""
    found = getattr(visual, "uv", None)
    if found is None or len(found) != count:
        return None
    u, v = np.asarray(found, np.float64)[:, :2].T
    return np.stack([u, 1 - v, u, 1 - v], axis=1)


def _labels(owners: Sequence[str], counts: list[int]) -> tuple[tuple[str, ...], Any]:
    """Return each name once, and for each triangle its number; none where no face has a name."""
    if not any(owners):
        return (), None
    if len(owners) != len(counts):
        raise ValueError("its faces cannot be divided by their materials (usemtl)")
    named = [name or NO_MATERIAL for name in owners]
    numbers = {name: number for number, name in enumerate(dict.fromkeys(reversed(named)))}
    return tuple(numbers), np.repeat([numbers[name] for name in named], counts)


def _joined(parts: list[Any]) -> NDArray[Any] | None:
    """Return the rows of all parts, or None if one has none."""
    return None if any(part is None for part in parts) else np.concatenate(parts)


def _linear(colors: Any, suffix: str) -> NDArray[np.float64] | None:
    """Return colours, (v, 3 or more), as linear sRGB, (v, 3); None without colours.

    Whole numbers are codes of sRGB up to the largest of their type. PLY files state no encoding for
    floats, which programs write linear; floats in OBJ files are sRGB.
    """
    if colors is None:
        return None
    found = np.asarray(colors)[:, :3]
    if found.dtype.kind in "iu":
        return decode_srgb(found / np.iinfo(found.dtype).max)
    return decode_srgb(found) if suffix == ".obj" else found.astype(np.float64)


def _fans(polygons: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return polygons of k corners each, (n, k), as triangles around their first corners."""
    if not polygons.size:
        return polygons.reshape(-1, 3)
    if polygons.ndim != 2 or polygons.shape[1] < 3:
        raise ValueError("its faces have fewer than three corners")
    corners = range(1, polygons.shape[1] - 1)
    fans = np.stack([polygons[:, [0, k, k + 1]] for k in corners], axis=1)
    return fans.reshape(-1, 3)


def _reason(error: Exception) -> str:
    text = str(error).split("\n")[0].strip().rstrip(".")
    return text[:200] or type(error).__name__
