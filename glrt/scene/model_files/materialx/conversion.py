"""A MaterialX document as the content of a .glb file: `python -m` this, in a process of its own."""

import os
import sys
from urllib.parse import quote

import MaterialX

from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.conversion.outcome import convert, put_tables
from glrt.scene.model_files.conversion.reports import UnshownError
from glrt.scene.model_files.gltf_file import GltfFile
from glrt.scene.model_files.materialx.balls import add_balls
from glrt.scene.model_files.materialx.documents import opened_document
from glrt.scene.model_files.materialx.nodes import DocumentNode
from glrt.scene.model_files.networks.coordinates import Coordinates
from glrt.scene.model_files.networks.evaluation import Evaluation
from glrt.scene.model_files.networks.nodes import NamedImage, Table
from glrt.scene.model_files.networks.surfaces import SURFACES, is_surface, surface_table

_MOST = 400  # materials
_SETS = "UV0", "UV1"  # of texture coordinates
_TILES = ("<UDIM>", "<UVTILE>")


class _Images:
    """The images that a document names, each added once to a glTF file."""

    def __init__(self, glb: GltfFile, folder: Folder) -> None:
        self._glb, self._folder = glb, folder
        self._known: dict[str, NamedImage] = {}

    def __call__(self, path: str, kind: str) -> NamedImage | None:
        left = self._folder.left
        if not path:
            left.add(f"textures of {kind} without a file")
            return None
        if any(tile in path for tile in _TILES):
            left.name("textures of many tiles", os.path.basename(path))
            return None
        if path not in self._known:
            uri = quote(self._folder.relative(path))
            self._known[path] = NamedImage(self._glb.add("images", {"uri": uri}), path)
        return self._known[path]


def converted(folder: Folder) -> bytes:
    """Return the content of a .glb file with a ball of each material; raises `UnshownError`."""
    document = opened_document(folder)
    glb = GltfFile("glrt")
    images = _Images(glb, folder)
    found: list[tuple[str, Table]] = []
    for name, shader in _surfaces(document, folder):
        coordinates = Coordinates([], _SETS[0], _SETS)
        node = DocumentNode(shader, images)
        table, _ = surface_table(node, Evaluation(coordinates, folder.left))
        found.append((name, table))
    if not found:
        raise UnshownError(
            "has no material with a surface that glrt reads, which are "
            f"{', '.join(SURFACES[:-1])} and {SURFACES[-1]}"
        )
    add_balls(glb, [name for name, _ in found])
    looks = [{"table": table, "is_two_sided": True} for _, table in found]
    lights: Table = {"materials": {}, "objects": [], "suns": []}
    put_tables(glb, folder, looks, lights, {})
    return glb.binary()


def _surfaces(document: MaterialX.Document, folder: Folder) -> list[tuple[str, MaterialX.Node]]:
    """Return names of materials and their surfaces; without materials, those of the surfaces."""
    found, left = list[tuple[str, MaterialX.Node]](), folder.left
    materials = document.getMaterialNodes()
    for material in materials:
        surfaces = MaterialX.getShaderNodes(material, "surfaceshader")
        if MaterialX.getShaderNodes(material, "displacementshader"):
            left.add("displacement")
        if not surfaces:
            left.name("materials without a surface", material.getName())
        for surface in surfaces[:1]:
            if is_surface(surface.getCategory()):
                found.append((material.getName(), surface))
            else:
                left.name("materials of", surface.getCategory())
    if not materials:
        nodes = document.getNodes()
        found = [(it.getName(), it) for it in nodes if is_surface(it.getCategory())]
    if looks := document.getLooks():
        left.add("looks", len(looks))
    for _, surface in found:
        for given in surface.getInputs():
            if given.hasUnit():
                left.name("units of", given.getName())
    if len(found) > _MOST:
        left.add(f"materials after the first {_MOST}", len(found) - _MOST)
    return found[:_MOST]


if __name__ == "__main__":
    sys.exit(convert(converted))
