"""Divide meshes without a material: one mesh for each material that their OBJ or glTF file has."""

from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, TypeVar

from glrt.core.errors import SceneError
from glrt.core.text import counted, quoted, unknown
from glrt.scene.files.assets import AssetReader
from glrt.scene.files.named_meshes import MeshFile
from glrt.scene.loading.file_materials import REMEDY, Found, of_gltf, of_mtl
from glrt.scene.materials.kinds import Material
from glrt.scene.meshes.triangle_meshes import NO_MATERIAL
from glrt.scene.model_files.mesh_formats import AS_GLTF
from glrt.scene.schema.fields import MAX_OBJECTS, SceneFields
from glrt.scene.schema.validation import sentence, validated
from glrt.scene.shapes.mesh import Mesh

SceneType = TypeVar("SceneType", bound=SceneFields)


def lacks_material(shape: Any) -> bool:
    """Return whether an object is to have the materials of its file."""
    return isinstance(shape, Mesh) and not shape.material


def with_own_materials(
    scene: SceneType, reader: AssetReader, source: str, rest: Material | None = None
) -> SceneType:
    """Return the scene with a mesh for each material of files whose objects have none.

    If all objects have a material, it is the same scene. The first part of an object stands in its
    place and the others behind all objects, so that no object gets another number. Their materials
    are named `FILE:NAME`, unless the scene has one of that name. A file without materials raises
    `SceneError`, as `source: key: ...`. So do MTL files and materials that are missing, unless
    `rest` is a material for parts that lack one.
    """
    division = _Division(reader, dict(scene.materials), rest)
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
                    f"more than {MAX_OBJECTS:,} objects: {REMEDY}."
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
    rest: Material | None
    files: dict[tuple[MeshFile, str | None], Found] = field(default_factory=dict)
    own: dict[str, Material] = field(default_factory=dict)  # materials of files, by their names

    def parts(self, shape: Mesh, where: str) -> list[Mesh]:
        """Return a mesh for each material, in the order in which the file uses them."""
        names = _names(shape, where, self.rest is not None)
        key = shape.file, shape.variant
        if key not in self.files:
            self.files[key] = (
                of_gltf(shape, self.reader, where)
                if _is_gltf(shape)
                else of_mtl(shape, self.reader, where, self.rest)
            )
        file, own = self.files[key]
        materials = dict[str, str]()
        for name in names:
            if name not in own:
                advice = unknown("material", name, sorted(own), "Its MTL files have")
                raise SceneError(f"{where}: {file.file}: {advice} Or {REMEDY}.")
            materials[name] = self._named(f"{file.file}:{name}", own[name], shape.variant)
        return [
            shape.model_copy(update={"file": file, "part": name, "material": material})
            for name, material in materials.items()
        ]

    def _named(self, name: str, material: Material, variant: str | None) -> str:
        """Return the name in the scene of a material of a file: another one where variants differ.

        They differ in glass, which is thin on triangles that enclose nothing.
        """
        if self.own.get(name, material) != material:
            name += f" ({variant or 'usual'})"
        self.own[name] = material
        self.materials.setdefault(name, material)
        return name


def _is_gltf(shape: Mesh) -> bool:
    return PurePosixPath(shape.file.file).suffix.lower() in AS_GLTF


def _names(shape: Mesh, where: str, may_lack: bool) -> list[str]:
    """Return the materials of a mesh's file; if `may_lack`, some triangles may have none."""
    file = shape.file.file
    try:
        mesh = shape.triangles_of_file
    except ValueError as error:
        raise SceneError(sentence(f"{where}: {file}: {error}")) from None
    if PurePosixPath(file).suffix.lower() not in (".obj", *AS_GLTF):
        raise SceneError(
            f"{where}: {file} has no materials of its own, as OBJ, glTF and USD files have: "
            f"{REMEDY}."
        )
    names = list(mesh.parts)
    if not names:
        raise SceneError(f"{where}: {file} uses no materials of its own (usemtl): {REMEDY}.")
    if shape.part is not None:
        if shape.part not in names:
            advice = unknown("part", shape.part, sorted(names), "The file has")
            raise SceneError(f"{where}: {file}: {advice}")
        return [shape.part]
    if NO_MATERIAL in names and not (may_lack or _is_gltf(shape)):
        count = counted(len(mesh.parts[NO_MATERIAL].faces), "triangle")
        raise SceneError(
            f"{where}: {file}: {count} have no material (usemtl): {REMEDY}, or export it again."
        )
    return names


def part_problem(shape: Mesh) -> str:
    """Return what is wrong with an object's part, or its moment; empty if nothing is."""
    try:
        mesh = shape.triangles_of_file
    except ValueError as error:
        return str(error)
    names = mesh.parts if shape.part is not None else {}
    if shape.part is None or shape.part in names:
        return ""
    if not names:
        return f"it has no part {quoted(shape.part)}: glTF and OBJ files with materials have parts"
    return unknown("part", shape.part, sorted(names), "The file has")
