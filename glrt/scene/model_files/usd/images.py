"""Images of a USD file, each added once to a glTF file."""

import os
import zipfile
from pathlib import Path
from urllib.parse import quote

from pxr import Ar, Sdf, Usd, UsdShade

from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.gltf_file import GltfFile
from glrt.scene.model_files.networks.nodes import NamedImage

_LARGEST_IMAGE = 1 << 30  # bytes


class Images:
    """The images of a file: in it, or next to it."""

    def __init__(self, glb: GltfFile, folder: Folder, time: Usd.TimeCode) -> None:
        self._glb, self._folder, self._time = glb, folder, time
        self._numbers: dict[str, int | None] = {}

    def of_input(self, given: UsdShade.Input | None, kind: str) -> NamedImage | None:
        """Return the image that an input names; None, which is reported, if it is left out."""
        attribute = given.GetValueProducingAttributes() if given else []
        asset = attribute[0].Get(self._time) if attribute else None
        if not isinstance(asset, Sdf.AssetPath) or not asset.path:
            self._folder.left.add(f"textures of {kind} without a file")
            return None
        path = self._path(asset, attribute[0])
        if path not in self._numbers:
            self._numbers[path] = self.added(path)
        number = self._numbers[path]
        return None if number is None else NamedImage(number, path)

    def _path(self, asset: Sdf.AssetPath, attribute: Usd.Attribute) -> str:
        """Return the path of an image, also where nothing is at it."""
        if asset.resolvedPath:
            return str(asset.resolvedPath)
        layers = [spec.layer for spec in attribute.GetPropertyStack(self._time)]
        file = next((it.realPath for it in layers if it.realPath), str(self._folder.root))
        if file.lower().endswith(".usdz"):
            return str(Ar.JoinPackageRelativePath([file, asset.path]))
        return os.path.join(os.path.dirname(file), asset.path)

    def path_of(self, attribute: Usd.Attribute) -> str | None:
        """Return the path of the image that an attribute names; None if it names none."""
        asset = attribute.Get(self._time) if attribute else None
        return self._path(asset, attribute) if asset and asset.path else None

    def added(self, path: str) -> int | None:
        """Add an image to the glTF file, by its bytes or its path; None if it is left out."""
        left = self._folder.left
        if "<UDIM>" in path or "%3CUDIM%3E" in path:
            left.name("textures of many tiles", Path(path).name)
            return None
        if not Ar.IsPackageRelativePath(path):
            uri = quote(self._folder.relative(path))
            return self._glb.add("images", {"uri": uri})
        package, inner = Ar.SplitPackageRelativePathOuter(path)
        content = self._packed(package, inner)
        if content is None:
            left.name("images that are missing", inner)
            return None
        return self._glb.add("images", {"bufferView": self._glb.view(content)})

    def _packed(self, package: str, inner: str) -> bytes | None:
        if not self._folder.may_read(package):
            return None
        try:
            with zipfile.ZipFile(package) as files:
                if files.getinfo(inner).file_size > _LARGEST_IMAGE:
                    return None
                return files.read(inner)
        except (OSError, KeyError, zipfile.BadZipFile, NotImplementedError, RuntimeError):
            return None
