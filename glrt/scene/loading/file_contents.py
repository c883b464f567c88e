"""Read the contents of files that a scene names."""

from collections.abc import Mapping
from pathlib import PurePosixPath

import numpy as np

from glrt.core.errors import SceneError, of_content
from glrt.core.text import quoted
from glrt.scene.files.assets import Asset, AssetReader
from glrt.scene.files.named_cameras import CameraFile
from glrt.scene.files.named_files import container_of
from glrt.scene.files.named_grids import GridFile
from glrt.scene.files.named_images import ImageFile, Pixels, TextureImage
from glrt.scene.files.named_meshes import MeshFile
from glrt.scene.images.image_files import check_brightness, decode_image, decode_texels
from glrt.scene.loading.companions import Beside
from glrt.scene.model_files.gltf.cameras import FileCameras
from glrt.scene.model_files.gltf.document import LacksExtensionError
from glrt.scene.model_files.gltf.images import image_content
from glrt.scene.model_files.mesh_formats import AS_GLTF, decode_mesh
from glrt.scene.values import LARGEST

NamedContent = ImageFile | TextureImage | MeshFile | CameraFile | GridFile


def with_content(named: NamedContent, reader: AssetReader, where: str) -> NamedContent:
    """Return a file with its content; raises `SceneError`, which begins with `where`."""
    if isinstance(named, CameraFile):
        return _cameras(named, reader, where)
    asset = reader.read(named.path, where)
    if isinstance(named, MeshFile):
        beside = Beside(asset, reader, where)
        mesh = decode_mesh(asset.content, named.file, where, beside, beside.document)
        return named.read_as(asset.sha256, mesh, asset.origin).with_companions(beside.hashes)
    if isinstance(named, GridFile):
        try:
            return named.read_as(asset.sha256, named.decode(asset.content), asset.origin)
        except ValueError as error:
            raise SceneError(f"{where}: {named.file}: {of_content(error)}.") from None
    if isinstance(named, TextureImage):
        return _texture(named, asset, reader, where)
    content, hashes = _image(named, asset, reader, where)
    pixels = _colors(decode_image(content, f"{where}: {named.file}"))
    check_brightness(pixels, LARGEST, f"{where}: {named.file}")
    return named.read_as(asset.sha256, pixels, asset.origin).with_companions(hashes)


def _cameras(named: CameraFile, reader: AssetReader, where: str) -> CameraFile:
    if PurePosixPath(named.file).suffix.lower() not in AS_GLTF:
        raise SceneError(
            f"{where}: {quoted(named.file)} is no glTF or USD file, as .glb, .gltf, .usd, .usda, "
            ".usdc and .usdz are, and glrt reads cameras of those alone. Export the camera as glTF."
        )
    asset = reader.read(named.path, where)
    beside = Beside(asset, reader, where)
    try:
        cameras = FileCameras(beside.document())
    except LacksExtensionError as error:
        raise SceneError(f"{where}: {quoted(named.file)} {error}. Export it without.") from None
    except ValueError as error:
        raise SceneError(
            f"{where}: {quoted(named.file)}: {of_content(error)}. Export it again."
        ) from None
    found = named.read_as(asset.sha256, cameras, asset.origin)
    return found.with_companions(beside.hashes)


def _texture(named: TextureImage, asset: Asset, reader: AssetReader, where: str) -> TextureImage:
    content, hashes = _image(named, asset, reader, where)
    texels = decode_texels(content, f"{where}: {named.file}", color=named.is_color)
    return named.read_as(asset.sha256, texels, asset.origin).with_companions(hashes)


def _image(
    named: TextureImage | ImageFile, asset: Asset, reader: AssetReader, where: str
) -> tuple[bytes, Mapping[str, str]]:
    """Return the content of an image, perhaps inside of a file, and SHA-256 of others, by path."""
    number, beside = container_of(named.file)[1], Beside(asset, reader, where)
    content = asset.content
    if number is not None:
        try:
            content = image_content(beside.document(), number)
        except ValueError as error:
            raise SceneError(
                f"{where}: {named.file}: {of_content(error)}. Export the file again."
            ) from None
    return content, beside.hashes


def _colors(pixels: Pixels) -> Pixels:
    """Return colours, (H, W, 3), of grey or colour pixels; their alpha is left out."""
    channels = pixels.shape[2]
    planes = pixels[..., :1].repeat(3, axis=2) if channels < 3 else pixels[..., :3]
    return np.ascontiguousarray(planes, np.float32)
