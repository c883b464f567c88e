"""Read the files that a scene names into the scene."""

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

import numpy as np

from glrt.core.errors import SceneError
from glrt.core.text import quoted
from glrt.scene.camera import Camera
from glrt.scene.density import Density
from glrt.scene.files.assets import AssetFolder, AssetReader
from glrt.scene.files.named_grids import GridFile
from glrt.scene.files.named_images import ImageFile, TextureImage
from glrt.scene.grids import grid_problems
from glrt.scene.instancing import tree_sizes, with_own_tree
from glrt.scene.loading.file_camera import with_camera_of_file
from glrt.scene.loading.file_contents import NamedContent, with_content
from glrt.scene.loading.mesh_parts import lacks_material, part_problem, with_own_materials
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.nothing import Nothing
from glrt.scene.medium import Medium
from glrt.scene.meshes.triangle_meshes import MOST_TRIANGLES
from glrt.scene.schema.fields import SceneFields
from glrt.scene.schema.validation import validated
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.volumes import bounds_a_volume, volume_problems

SceneType = TypeVar("SceneType", bound=SceneFields)
Files = Mapping[NamedContent, NamedContent]


def files_of(scene: SceneFields) -> list[str]:
    """Return the paths of the files that a scene names, each once."""
    return list(dict.fromkeys(named.path for _, named in named_files(scene)))


def hashes_of(scene: SceneFields) -> dict[str, str]:
    """Return SHA-256 in hex by path, of the files that were read, as recipes store them."""
    found = dict[str, str]()
    for _, named in named_files(scene):
        if named.sha256:
            found |= {named.path: named.sha256, **named.companions}
    return found


def sources_of(scene: SceneFields) -> dict[str, str]:
    """Return `hashes_of`, and the MTL files that gave materials, which recipes leave out."""
    files = [shape.file for _, shape in _meshes(scene)]
    return hashes_of(scene) | {path: sha for file in files for path, sha in file.libraries.items()}


def with_files(
    scene: SceneType, folder: AssetFolder | AssetReader, source: str, rest: Material | None = None
) -> SceneType:
    """Return the scene with the content of its files; the same one if it names none, or has all.

    In place of a folder there may be a reader, which has read some of them. `rest` is the material
    of triangles that have none in an OBJ file, which is refused without it. Raises `SceneError`, as
    `source: key: ...`, for a file that is missing, too large, outside of the folder, no image or
    mesh, or not as expected.
    """
    reader = folder if isinstance(folder, AssetReader) else AssetReader(folder)
    is_new = scene.camera.file is not None and not scene.camera.file.is_read
    scene = _read(scene, reader, source)
    if is_new and reader.folder.expected is None:  # the recipe of a picture holds it all
        scene = with_camera_of_file(scene, source)
    scene = _read(with_own_materials(scene, reader, source, rest), reader, source)
    problem = next(placing_problems(scene), None)
    if problem:
        raise SceneError(f"{source}: {problem}")
    return scene


def _read(scene: SceneType, reader: AssetReader, source: str) -> SceneType:
    found = dict[NamedContent, NamedContent]()
    for key, named in named_files(scene):
        if not named.is_read and named not in found:
            found[named] = with_content(named, reader, f"{source}: {key}")
    return _with(scene, found, f"{source}: ") if found else scene


def with_hashes(scene: SceneType, hashes: Mapping[str, str]) -> SceneType:
    """Return the scene of a recipe, which knows its files by their hashes alone."""
    return _with(
        scene,
        {
            named: named.model_copy(update={"sha256": hashes[named.path]})
            for _, named in named_files(scene)
            if named.path in hashes
        },
    )


def with_files_of(scene: SceneType, other: SceneFields) -> SceneType:
    """Return the scene with the content of the files that another scene has read."""
    return _with(scene, {named: named for _, named in named_files(other)})


def with_stand_ins(scene: SceneType) -> SceneType:
    """Return the scene with one pixel or voxel of each image or grid that was not read.

    Its kernel is equal.
    """
    found = dict[NamedContent, NamedContent]()
    for _, named in named_files(scene):
        if isinstance(named, TextureImage) and not named.is_read:
            found[named] = named.read_as("", np.ones((1, 1, 4), np.float16), None)
        elif isinstance(named, ImageFile) and not named.is_read:
            found[named] = named.read_as("", np.ones((1, 1, 3), np.float32), None)
        elif isinstance(named, GridFile) and not named.is_read:
            found[named] = named.read_as("", np.ones((1, 1, 1), np.float32), None)
    return _with(scene, found) if found else scene


def check_loaded(scene: SceneFields) -> None:
    """Raise SceneError for a scene whose files were not read, or do not fit."""
    for key, named in named_files(scene):
        if not named.is_read:
            raise SceneError(
                f"{key}: the file {named.file} was not read: load the scene by glrt.load, or give "
                "Scene.build the folder of its files."
            )
    for problem in placing_problems(scene):
        raise SceneError(problem)


def placing_problems(scene: SceneFields) -> Iterator[str]:
    """Yield what does not fit in meshes that were read, and around media, as `key: ...`."""
    for index, shape in _meshes(scene):
        key = f"objects[{index}].file: {shape.file.file}"
        if problem := part_problem(shape):
            yield f"{key}: {problem}"
            continue
        key += f": part {quoted(shape.part)}" if shape.part is not None else ""
        if lacks_material(shape):
            yield f"objects[{index}].material is missing: load the scene by glrt.load"
        mesh = shape.triangles
        material = scene.materials.get(shape.material)
        if mesh.opening and bounds_a_volume(material):
            cannot = "bound a medium" if isinstance(material, Nothing) else "be dielectric"
            yield (
                f"{key}: {mesh.opening}, so the mesh encloses nothing and cannot {cannot}. "
                "Close it in the program that it comes from, or use another material."
            )
    yield from _without_coordinates(scene)
    yield from _too_many(scene)
    yield from volume_problems(scene)
    yield from grid_problems(scene)


def _without_coordinates(scene: SceneFields) -> Iterator[str]:
    """Yield meshes with a texture but without texture coordinates, as `key: ...`."""
    for index, shape in enumerate(scene.objects):
        material = scene.materials.get(shape.material)
        if not isinstance(material, Opaque) or not material.textures:
            continue
        if isinstance(shape, Mesh) and shape.triangles_of_file.uv is None:
            yield (
                f"objects[{index}].material: {quoted(shape.material)} has a texture, and "
                f"{shape.file.file} has no texture coordinates. Export it with them, or use "
                "another material."
            )


def _too_many(scene: SceneFields) -> Iterator[str]:
    meshes = [shape for _, shape in _meshes(scene)]
    if any(part_problem(mesh) or mesh.material not in scene.materials for mesh in meshes):
        return
    shared, own = tree_sizes(meshes, with_own_tree(meshes, scene.materials))
    if (count := shared + sum(own)) > MOST_TRIANGLES:
        yield (
            f"objects: the meshes of this scene have {count:,} triangles, those of a file that is "
            f"used more than once counted once, lamps apart, and it may have {MOST_TRIANGLES:,}. "
            "Use meshes of fewer."
        )


def _with(scene: SceneType, known: Files, source: str = "") -> SceneType:
    """Return the scene with values of `known` in place of the files that equal their keys.

    Raises `SceneError`, which begins with `source`, if a file lacks the camera.
    """
    image, objects = scene.background.image, scene.objects
    images = {key: value for key, value in known.items() if isinstance(value, TextureImage)}
    changes: dict[str, Any] = {}
    camera = scene.camera
    if camera.file is not None and camera.file in known:
        fields = {name: value for name, value in camera if value is not None}
        file = {"file": known[camera.file]}
        changes["camera"] = validated(Camera, fields | file, f"{source}camera")
    if image is not None and image in known:
        changes["background"] = scene.background.model_copy(update={"image": known[image]})
    if any(shape.file in known for _, shape in _meshes(scene)):
        changes["objects"] = tuple(
            shape.model_copy(update={"file": known[shape.file]})
            if isinstance(shape, Mesh) and shape.file in known
            else shape
            for shape in objects
        )
    materials = {
        name: material.with_images(images) if isinstance(material, Opaque) else material
        for name, material in scene.materials.items()
    }
    if any(material is not scene.materials[name] for name, material in materials.items()):
        changes["materials"] = materials
    if any(grid.file in known for _, grid in _grids(scene)):
        changes["media"] = {name: _with_grid(it, known) for name, it in scene.media.items()}
    return scene.model_copy(update=changes) if changes else scene


def named_files(scene: SceneFields) -> Iterator[tuple[str, NamedContent]]:
    """Yield the files that a scene names, with the keys that name them."""
    if scene.camera.file is not None:
        yield "camera.file", scene.camera.file
    if scene.background.image is not None:
        yield "background.image", scene.background.image
    for index, shape in _meshes(scene):
        yield f"objects[{index}].file", shape.file
    for name, material in scene.materials.items():
        for key, texture in material.textures.items() if isinstance(material, Opaque) else ():
            if texture.image is not None:
                yield f"materials.{name}.{key}.image", texture.image
    for name, grid in _grids(scene):
        yield f"media.{name}.density.file", grid.file


def _with_grid(medium: Medium, known: Files) -> Medium:
    """Return the medium with a value of `known` in place of the file of its grid."""
    if medium.density is None or medium.density.file not in known:
        return medium
    density = medium.density.model_copy(update={"file": known[medium.density.file]})
    return medium.model_copy(update={"density": density})


def _grids(scene: SceneFields) -> Iterator[tuple[str, Density]]:
    for name, medium in scene.media.items():
        if medium.density is not None:
            yield name, medium.density


def _meshes(scene: SceneFields) -> Iterator[tuple[int, Mesh]]:
    for index, shape in enumerate(scene.objects):
        if isinstance(shape, Mesh):
            yield index, shape
