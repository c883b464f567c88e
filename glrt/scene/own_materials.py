"""Meshes without a material: one for each material that their OBJ or glTF file has of its own."""

from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, TypeVar

from glrt.errors import SceneError
from glrt.scene.assets import AssetReader
from glrt.scene.contents import MAX_OBJECTS, Contents
from glrt.scene.file_contents import Beside
from glrt.scene.gltf.document import Document
from glrt.scene.gltf.looks import looks_of, make_pane
from glrt.scene.materials import Material, Principled
from glrt.scene.mesh_formats import GLTF, libraries
from glrt.scene.meshes import Mesh
from glrt.scene.mtl_files import Entry, decode_mtl, material_of
from glrt.scene.named_meshes import MeshFile
from glrt.scene.validation import validated
from glrt.text import counted, quoted, unknown

SceneType = TypeVar("SceneType", bound=Contents)

_REMEDY = "give the object a `material`"


def lacks_material(shape: Any) -> bool:
    """Whether an object is to have the materials of its file."""
    return isinstance(shape, Mesh) and not shape.material


def with_own_materials(scene: SceneType, reader: AssetReader, source: str) -> SceneType:
    """The scene with a mesh for each material of files whose objects have none; else the same one.

    The first part of an object stands in its place and the others behind all objects, so that no
    object gets another number. Their materials are named `FILE:NAME`, unless the scene has one of
    that name. Raises `SceneError`, as `source: key: ...`, for a file without materials, and for an
    MTL file that is missing, outside of the folder or wrong.
    """
    division = _Division(reader, dict(scene.materials))
    objects: list[Any] = list(scene.objects)
    for index, shape in enumerate(scene.objects):
        if isinstance(shape, Mesh) and lacks_material(shape):
            where = f"{source}: objects[{index}].file"
            first, *others = division.parts(shape, where)
            objects[index] = first
            objects += others
            if len(objects) > MAX_OBJECTS:
                raise SceneError(
                    f"{where}: with a mesh for each material of {shape.file.file} the scene has "
                    f"more than {MAX_OBJECTS:,} objects: {_REMEDY}."
                )
    if not division.files:
        return scene
    update = {"objects": tuple(objects), "materials": division.materials}
    return validated(type(scene), dict(scene) | update, source)


@dataclass
class _Division:
    """The materials of a scene and of the files that were divided so far."""

    reader: AssetReader
    materials: dict[str, Material]
    files: dict[MeshFile, tuple[MeshFile, dict[str, Material]]] = field(default_factory=dict)

    def parts(self, shape: Mesh, where: str) -> list[Mesh]:
        """A mesh for each material, in the order in which the file uses them."""
        names = _names(shape, where)
        if shape.file not in self.files:
            read = _of_gltf if _is_gltf(shape) else _of_mtl
            self.files[shape.file] = read(shape, self.reader, where)
        file, own = self.files[shape.file]
        for name in names:
            if name not in own:
                advice = unknown("material", name, sorted(own), "Its MTL files have")
                raise SceneError(f"{where}: {file.file}: {advice} Or {_REMEDY}.")
            self.materials.setdefault(f"{file.file}:{name}", own[name])
        return [
            shape.model_copy(update={"file": file, "part": name, "material": f"{file.file}:{name}"})
            for name in names
        ]


def _is_gltf(shape: Mesh) -> bool:
    return PurePosixPath(shape.file.file).suffix.lower() in GLTF


def _of_mtl(shape: Mesh, reader: AssetReader, where: str) -> tuple[MeshFile, dict[str, Material]]:
    """The file with the hashes of its MTL files, and what those say; the first of a name."""
    asset = reader.read(shape.file.file, where)
    paths = libraries(asset.content)
    if not paths:
        raise SceneError(
            f"{where}: {shape.file.file} names no MTL file by mtllib: {_REMEDY}, or export it "
            "with its materials."
        )
    found, hashes = dict[str, tuple[Material, list[str]]](), dict[str, str]()
    for path in paths:
        library = reader.read(path, where, asset)
        entries = decode_mtl(library.content, f"{where}: {library.path}")
        folder = library.path.rpartition("/")[0] + "/" if "/" in library.path else ""
        for entry in entries.values():
            _check_image(entry, folder, shape, reader, where)
        found = {name: material_of(entry, folder) for name, entry in entries.items()} | found
        hashes[library.path] = library.sha256
    used = [found[name] for name in shape.triangles_of_file.parts if name in found]
    unread = {key for _, keys in used for key in keys}
    file = shape.file.with_libraries(hashes, tuple(unread))
    return file, {name: material for name, (material, _) in found.items()}


def _check_image(entry: Entry, folder: str, shape: Mesh, reader: AssetReader, where: str) -> None:
    """Leave an image out that is not there, as of many files, or that could not lie anywhere."""
    if not entry.image:
        return
    try:
        reader.read(folder + entry.image, where)
        is_usable = shape.triangles_of_file.uv is not None
    except SceneError:
        is_usable = False
    if not is_usable:
        entry.image = ""
        entry.unread["map_Kd"] = None


def _of_gltf(shape: Mesh, reader: AssetReader, where: str) -> tuple[MeshFile, dict[str, Material]]:
    """The file, and the materials that its triangles have; no glass that would enclose nothing."""
    asset = reader.read(shape.file.file, where)
    parts = shape.triangles_of_file.parts
    own, unread = dict[str, Material](), list[str]()
    try:
        document = Document(asset.content, Beside(asset, reader, where))
        looks = looks_of(document, asset.path)
        for name, part in parts.items():
            look = looks[name]
            if look.table.get("transmission") and not look.table["thin"] and part.opening:
                look.unread.append("the volume of glass that is not closed")
                make_pane(look)
            here = f"{where}: {shape.file.file}: material {quoted(name)}"
            own[name] = validated(Principled, look.table, here)
            unread += look.unread
    except ValueError as error:
        raise SceneError(f"{where}: {shape.file.file}: {error}.") from None
    unread += document.unknown_extensions
    if document.items("animations"):
        unread.append("animations")
    return shape.file.with_libraries({}, tuple(unread)), own


def _names(shape: Mesh, where: str) -> list[str]:
    """The materials of an object that has none in the scene."""
    file, mesh = shape.file.file, shape.triangles_of_file
    if PurePosixPath(file).suffix.lower() not in (".obj", *GLTF):
        raise SceneError(
            f"{where}: {file} has no materials of its own, as OBJ and glTF files have: {_REMEDY}."
        )
    names = list(mesh.parts)
    if not names:
        raise SceneError(f"{where}: {file} uses no materials of its own (usemtl): {_REMEDY}.")
    if shape.part is not None:
        if shape.part not in names:
            advice = unknown("part", shape.part, sorted(names), "The file has")
            raise SceneError(f"{where}: {file}: {advice}")
        return [shape.part]
    if "" in names:
        count = counted(len(mesh.parts[""].faces), "triangle")
        raise SceneError(
            f"{where}: {file}: {count} have no material (usemtl): {_REMEDY}, or export it again."
        )
    return names


def part_problem(shape: Mesh) -> str:
    """What is wrong with the part that an object is of; empty if nothing is."""
    names = shape.triangles_of_file.parts if shape.part is not None else {}
    if shape.part is None or shape.part in names:
        return ""
    if not names:
        return f"it has no part {quoted(shape.part)}: glTF and OBJ files with materials have parts"
    return unknown("part", shape.part, sorted(names), "The file has")
