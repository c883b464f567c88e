"""The files that a scene names, read into it."""

import hashlib
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, TypeVar

import numpy as np

from glrt.errors import SceneError, UsageError
from glrt.files import write_whole
from glrt.scene.assets import AssetFolder, AssetReader
from glrt.scene.contents import Contents
from glrt.scene.image_files import decode_image
from glrt.scene.materials import glass_of
from glrt.scene.mesh_formats import decode_mesh
from glrt.scene.meshes import Mesh
from glrt.scene.named_images import ImageFile, Pixels
from glrt.scene.named_meshes import MeshFile
from glrt.scene.own_materials import lacks_material, part_problem, with_own_materials
from glrt.scene.own_trees import tree_sizes, with_own_tree
from glrt.scene.triangle_meshes import MOST_TRIANGLES
from glrt.scene.values import LARGEST
from glrt.text import quoted

SceneType = TypeVar("SceneType", bound=Contents)
NamedFile = ImageFile | MeshFile


def files_of(scene: Contents) -> list[str]:
    """The paths of the files that a scene names, each once."""
    return list(dict.fromkeys(named.file for _, named in _named(scene)))


def hashes_of(scene: Contents) -> dict[str, str]:
    """What recipes store: SHA-256 in hex by path, of the files that were read."""
    return {named.file: named.sha256 for _, named in _named(scene) if named.sha256}


def sources_of(scene: Contents) -> dict[str, str]:
    """The same with the MTL files that materials were taken from: those that recipes leave out."""
    files = [shape.file for _, shape in _meshes(scene)]
    return hashes_of(scene) | {path: sha for file in files for path, sha in file.libraries.items()}


def with_files(scene: SceneType, folder: AssetFolder, source: str) -> SceneType:
    """The scene with the content of its files; the same one if it names none, or has all.

    Raises `SceneError`, as `source: key: ...`, for a file that is missing, too large, outside of
    the folder, no image or mesh, or not as expected.
    """
    missing = [(key, named) for key, named in _named(scene) if not is_read(named)]
    reader = AssetReader(folder)
    if missing:
        found = dict[NamedFile, NamedFile]()
        for key, named in missing:
            if named not in found:
                found[named] = _read(named, reader, f"{source}: {key}")
        scene = _with(scene, found)
    scene = with_own_materials(scene, reader, source)
    problem = next(mesh_problems(scene), None)
    if problem:
        raise SceneError(f"{source}: {problem}")
    return scene


def with_hashes(scene: SceneType, hashes: Mapping[str, str]) -> SceneType:
    """The scene of a recipe, which knows its files by their hashes alone."""
    return _with(
        scene,
        {
            named: named.model_copy(update={"sha256": hashes[named.file]})
            for _, named in _named(scene)
            if named.file in hashes
        },
    )


def with_files_of(scene: SceneType, other: Contents) -> SceneType:
    """The scene with the content of those of its files that another scene has read."""
    return _with(scene, {named: named for _, named in _named(other)})


def with_stand_ins(scene: SceneType) -> SceneType:
    """The scene with a white pixel for each image that was not read: its kernel is the same."""
    image = scene.background.image
    if image is None or is_read(image):
        return scene
    return _with(scene, {image: image.read_as("", np.ones((1, 1, 3), np.float32), None)})


def copy_files(scene: Contents, folder: Path) -> None:
    """Put copies of the files that a scene names where a scene file in `folder` finds them.

    A file that is there already stays. Raises `UsageError` if it has other content, or if the one
    to copy is not as it was read; `RenderError` if a copy cannot be written.
    """
    for _, named in _named(scene):
        content = named.content if isinstance(named, MeshFile) else None
        is_beside = ".." not in PurePosixPath(named.file).parts
        if not is_beside or (named.origin is None and content is None):
            continue
        target = folder / named.file
        if target.exists():
            if _hash(target) != named.sha256:
                raise UsageError(
                    f"Cannot put a copy of {named.file} in {folder}: a file of that name with "
                    "other content is there. Save the scene to another folder."
                )
            continue
        if content is None:
            content = _unchanged(named)
        target.parent.mkdir(parents=True, exist_ok=True)
        write_whole(target, lambda file, data=content: file.write_bytes(data))  # type: ignore[misc]


def _unchanged(named: NamedFile) -> bytes:
    """The content of a file as it was read."""
    assert named.origin is not None
    content = named.origin.read_bytes()
    if hashlib.sha256(content).hexdigest() != named.sha256:
        raise UsageError(
            f"Cannot copy {named.origin} beside the scene: it has changed since it was read. "
            "Load the scene again."
        )
    return content


def _hash(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def is_read(named: NamedFile) -> bool:
    """Whether the content of a file is there."""
    return (named.pixels if isinstance(named, ImageFile) else named.triangles) is not None


def check_loaded(scene: Contents) -> None:
    """Raise SceneError for a scene whose files were not read, or do not fit."""
    for key, named in _named(scene):
        if not is_read(named):
            raise SceneError(
                f"{key}: the file {named.file} was not read: load the scene by glrt.load, or give "
                "Scene.build the folder of its files."
            )
    for problem in mesh_problems(scene):
        raise SceneError(problem)


def mesh_problems(scene: Contents) -> Iterator[str]:
    """What does not fit of meshes that were read, as `key: ...`."""
    for index, shape in _meshes(scene):
        key = f"objects[{index}].file: {shape.file.file}"
        if problem := part_problem(shape):
            yield f"{key}: {problem}"
            continue
        key += f": part {quoted(shape.part)}" if shape.part is not None else ""
        if lacks_material(shape):
            yield f"objects[{index}].material is missing: load the scene by glrt.load"
        mesh = shape.triangles
        glass = glass_of(scene.materials.get(shape.material))
        if glass and mesh.opening and not glass.thin:
            yield (
                f"{key}: {mesh.opening}, so the mesh encloses nothing and cannot be dielectric. "
                "Close it in the program that it comes from, or use another material."
            )
    yield from _too_many(scene)


def _too_many(scene: Contents) -> Iterator[str]:
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


def _with(scene: SceneType, known: Mapping[NamedFile, NamedFile]) -> SceneType:
    """The scene with other values in place of those that are equal to a key."""
    image, objects = scene.background.image, scene.objects
    changes: dict[str, Any] = {}
    if image is not None and image in known:
        changes["background"] = scene.background.model_copy(update={"image": known[image]})
    if any(shape.file in known for _, shape in _meshes(scene)):
        changes["objects"] = tuple(
            shape.model_copy(update={"file": known[shape.file]})
            if isinstance(shape, Mesh) and shape.file in known
            else shape
            for shape in objects
        )
    return scene.model_copy(update=changes) if changes else scene


def _named(scene: Contents) -> Iterator[tuple[str, NamedFile]]:
    if scene.background.image is not None:
        yield "background.image", scene.background.image
    for index, shape in _meshes(scene):
        yield f"objects[{index}].file", shape.file


def _meshes(scene: Contents) -> Iterator[tuple[int, Mesh]]:
    for index, shape in enumerate(scene.objects):
        if isinstance(shape, Mesh):
            yield index, shape


def _read(named: NamedFile, reader: AssetReader, where: str) -> NamedFile:
    asset = reader.read(named.file, where)
    if isinstance(named, MeshFile):
        mesh = decode_mesh(asset.content, named.file, where)
        return named.read_as(asset.sha256, mesh, asset.origin)
    pixels = _colors(decode_image(asset.content, f"{where}: {named.file}"))
    if pixels.max() > LARGEST:
        raise SceneError(
            f"{where}: {named.file}: this image is brighter than {LARGEST:g}; scale it down."
        )
    return named.read_as(asset.sha256, pixels, asset.origin)


def _colors(pixels: Pixels) -> Pixels:
    """(H, W, 3) of grey, grey and alpha, colours, or colours and alpha, which is left out."""
    channels = pixels.shape[2]
    planes = pixels[..., :1].repeat(3, axis=2) if channels < 3 else pixels[..., :3]
    return np.ascontiguousarray(planes, np.float32)
