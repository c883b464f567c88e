"""Read files of triangle meshes as arrays: PLY, OBJ, STL, glTF, USD and MaterialX."""

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePosixPath

from glrt.core.errors import ContentError, NothingShownError, SceneError, of_content
from glrt.core.text import quoted
from glrt.scene.meshes.checked_meshes import of_file
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.model_files.conversion.process import SUFFIXES
from glrt.scene.model_files.gltf.animations import Poses
from glrt.scene.model_files.gltf.document import Document, LacksExtensionError
from glrt.scene.model_files.gltf.draco import NotInstalledError
from glrt.scene.model_files.gltf.primitives import mesh_of
from glrt.scene.model_files.obj import read_obj
from glrt.scene.model_files.ply import read_ply
from glrt.scene.model_files.stl import read_stl

GLTF = (".glb", ".gltf")
AS_GLTF = (*GLTF, *SUFFIXES)  # have materials, cameras and lights; the others are converted
FORMATS = (".ply", ".obj", ".stl", *AS_GLTF)
_LONGEST = 200  # letters of a problem in a message
Fetch = Callable[[str], bytes]  # the content of a file by its path from this one


def decode_mesh(
    content: bytes,
    path: str,
    where: str,
    fetch: Fetch | None = None,
    document: Callable[[], Document] | None = None,
) -> TriangleMesh:
    """Return the mesh in the content of a file; the suffix of its path decides the format.

    Polygons are divided into triangles. Vertex colours are linear where a PLY file has them as
    floats, else sRGB. The names of materials of OBJ and glTF files are read; colours of faces are
    not. `fetch` reads the buffers of glTF files, and `document` gives one that is parsed already.
    Raises `SceneError`, which begins with `where`, if there is no mesh.
    """
    suffix = PurePosixPath(path).suffix.lower()
    if suffix not in FORMATS:
        raise SceneError(
            f"{where}: {quoted(path)} is no file of a mesh that glrt reads, which end in .glb, "
            ".gltf, .obj, .ply, .stl, .usd, .usda, .usdc, .usdz or .mtlx. Convert it to one of "
            "them."
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of arithmetic with NaN, which is found below
            if suffix in AS_GLTF:
                return _of_gltf(document() if document else Document(content, fetch or _alone))
            return of_file(*_READERS[suffix](content))
    except SceneError:
        raise  # of a file next to it
    except NotInstalledError as error:
        raise SceneError(f"{where}: {quoted(path)} {error}") from None
    except LacksExtensionError as error:
        advice = "Export it without, or convert it by a program that reads it"
        raise SceneError(f"{where}: {quoted(path)} {error}. {advice}.") from None
    except NothingShownError as error:
        raise SceneError(
            f"{where}: {quoted(path)} shows no triangles: {error}. Export it with its meshes."
        ) from None
    except MemoryError:
        problem = "it says that it is larger than the memory"
    except (ValueError, LookupError, TypeError, ArithmeticError) as error:
        problem = of_content(error)[:_LONGEST]
    raise SceneError(
        f"{where}: {quoted(path)} is damaged, or no {suffix[1:].upper()} file: {problem}. Export "
        "it again."
    )


def _alone(path: str) -> bytes:
    raise ContentError(f"it names {quoted(path)}, and only its own content is at hand")


def _of_gltf(document: Document) -> TriangleMesh:
    poses = Poses(document) if document.items("animations") else None
    return replace(mesh_of(document), poses=poses)


_READERS = {".obj": read_obj, ".ply": read_ply, ".stl": read_stl}
