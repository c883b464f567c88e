"""The files that a scene names, read into it."""

import hashlib
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import TypeVar

import numpy as np

from glrt.errors import SceneError, UsageError
from glrt.files import write_whole
from glrt.scene.assets import AssetFolder, AssetReader
from glrt.scene.contents import Contents
from glrt.scene.image_files import decode_image
from glrt.scene.named_images import ImageFile, Pixels
from glrt.scene.values import LARGEST

SceneType = TypeVar("SceneType", bound=Contents)


def files_of(scene: Contents) -> list[str]:
    """The paths of the files that a scene names."""
    return [image.file for _, image in _images(scene)]


def hashes_of(scene: Contents) -> dict[str, str]:
    """What recipes store: SHA-256 in hex by path, of the files that were read."""
    return {image.file: image.sha256 for _, image in _images(scene) if image.sha256}


def with_files(scene: SceneType, folder: AssetFolder, source: str) -> SceneType:
    """The scene with the content of its files; the same one if it names none, or has all.

    Raises `SceneError`, as `source: key: ...`, for a file that is missing, too large, outside of
    the folder, no image, or not as expected.
    """
    if all(image.pixels is not None for _, image in _images(scene)):
        return scene
    reader = AssetReader(folder)
    image = scene.background.image
    assert image is not None
    return _with_background_image(scene, _read(image, reader, f"{source}: background.image"))


def with_hashes(scene: SceneType, hashes: Mapping[str, str]) -> SceneType:
    """The scene of a recipe, which knows its files by their hashes alone."""
    image = scene.background.image
    if image is None or image.file not in hashes:
        return scene
    known = image.model_copy(update={"sha256": hashes[image.file]})
    return _with_background_image(scene, known)


def with_files_of(scene: SceneType, other: Contents) -> SceneType:
    """The scene with the content of those of its files that another scene has read."""
    known = {image: image for _, image in _images(other)}
    image = scene.background.image
    return _with_background_image(scene, known[image]) if image in known else scene


def with_stand_ins(scene: SceneType) -> SceneType:
    """The scene with a white pixel for each image that was not read: its kernel is the same."""
    image = scene.background.image
    if image is None or image.pixels is not None:
        return scene
    return _with_background_image(scene, image.read_as("", np.ones((1, 1, 3), np.float32), None))


def copy_files(scene: Contents, folder: Path) -> None:
    """Put copies of the files that a scene names where a scene file in `folder` finds them.

    A file that is there already stays. Raises `UsageError` if it has other content, or if the one
    to copy is not as it was read; `RenderError` if a copy cannot be written.
    """
    for _, image in _images(scene):
        if image.origin is None or ".." in PurePosixPath(image.file).parts:
            continue
        target = folder / image.file
        if target.exists():
            if _hash(target) != image.sha256:
                raise UsageError(
                    f"Cannot put a copy of {image.file} in {folder}: a file of that name with "
                    "other content is there. Save the scene to another folder."
                )
            continue
        content = image.origin.read_bytes()
        if hashlib.sha256(content).hexdigest() != image.sha256:
            raise UsageError(
                f"Cannot copy {image.origin} beside the scene: it has changed since it was read. "
                "Load the scene again."
            )
        target.parent.mkdir(parents=True, exist_ok=True)
        write_whole(target, lambda file, data=content: file.write_bytes(data))  # type: ignore[misc]


def _hash(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def check_loaded(scene: Contents) -> None:
    """Raise SceneError for a scene whose files were not read."""
    for key, image in _images(scene):
        if image.pixels is None:
            raise SceneError(
                f"{key}: the file {image.file} was not read: load the scene by glrt.load, or give "
                "Scene.build the folder of its files."
            )


def _with_background_image(scene: SceneType, image: ImageFile) -> SceneType:
    background = scene.background.model_copy(update={"image": image})
    return scene.model_copy(update={"background": background})


def _images(scene: Contents) -> Iterator[tuple[str, ImageFile]]:
    if scene.background.image is not None:
        yield "background.image", scene.background.image


def _read(image: ImageFile, reader: AssetReader, where: str) -> ImageFile:
    asset = reader.read(image.file, where)
    pixels = _colors(decode_image(asset.content, f"{where}: {image.file}"))
    if pixels.max() > LARGEST:
        raise SceneError(
            f"{where}: {image.file}: this image is brighter than {LARGEST:g}; scale it down."
        )
    return image.read_as(asset.sha256, pixels, asset.origin)


def _colors(pixels: Pixels) -> Pixels:
    """(H, W, 3) of grey, grey and alpha, colours, or colours and alpha, which is left out."""
    channels = pixels.shape[2]
    planes = pixels[..., :1].repeat(3, axis=2) if channels < 3 else pixels[..., :3]
    return np.ascontiguousarray(planes, np.float32)
