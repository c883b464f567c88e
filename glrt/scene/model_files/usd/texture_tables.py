"""Textures of USD materials, as tables of a scene.

https://openusd.org/release/spec_usdpreviewsurface.html
"""

import math
import os
import zipfile
from pathlib import Path
from typing import Any
from urllib.parse import quote

from pxr import Ar, Sdf, Usd, UsdShade

from glrt.scene.model_files.gltf_file import GltfFile
from glrt.scene.model_files.usd.layers import Folder

Table = dict[str, Any]

_WRAPS = {"repeat": "repeat", "mirror": "mirror", "clamp": "clamp", "useMetadata": "repeat"}
_CHANNELS = ("r", "g", "b", "a")
_LARGEST_IMAGE = 1 << 30  # bytes
_MOST_STEPS = 32  # nodes between a texture and its coordinates


class Textures:
    """The textures of a file: images in it or next to it, each added once to a glTF file."""

    def __init__(self, glb: GltfFile, folder: Folder, time: Usd.TimeCode) -> None:
        self._glb, self._folder, self._time = glb, folder, time
        self._images: dict[str, int | None] = {}

    def value(self, shader: UsdShade.Shader, name: str, default: Any = None) -> Any:
        """Return a value of a shader's input, without connections to other nodes."""
        given = shader.GetInput(name)
        found = given.Get(self._time) if given else None
        return default if found is None else found

    def table(
        self, source: UsdShade.Output, sets: list[str], kind: str, is_color: bool
    ) -> Table | None:
        """Return the table of a texture whose output is connected; None if it is left out.

        `sets` are the names of texture coordinates of the material, to which its own is added.
        """
        shader, left = UsdShade.Shader(source.GetPrim()), self._folder.left
        if shader.GetShaderId() != "UsdUVTexture":
            left.name(f"{kind} by nodes", str(shader.GetShaderId() or "without an id"))
            return None
        image = self._image(shader, kind)
        if image is None:
            return None
        found: Table = {"image": image, **self._placing(shader, sets, kind)}
        if "uv" not in found:
            return None
        found["wrap"] = [self._wrap(shader, key) for key in ("wrapS", "wrapT")]
        channel = source.GetBaseName()
        if channel in _CHANNELS:
            found["channel"] = channel
        elif not is_color:
            found["channel"] = "r"
        space = self.value(shader, "sourceColorSpace", "auto")
        if space == ("raw" if is_color else "sRGB"):
            left.add(f"sourceColorSpace {space} of {kind}")
        return found

    def scale_and_bias(self, source: UsdShade.Output) -> tuple[list[float], list[float]]:
        """Return four numbers each, by which the channels are multiplied, and what is added."""
        shader = UsdShade.Shader(source.GetPrim())
        scale = self.value(shader, "scale", (1, 1, 1, 1))
        bias = self.value(shader, "bias", (0, 0, 0, 0))
        return list(map(float, scale)), list(map(float, bias))

    def _wrap(self, shader: UsdShade.Shader, name: str) -> str:
        given = self.value(shader, name, "useMetadata")
        if given == "black":
            self._folder.left.add("black beyond the edges of textures")
            return "clamp"
        return _WRAPS.get(given, "repeat")

    def _placing(self, shader: UsdShade.Shader, sets: list[str], kind: str) -> Table:
        """Return which set of coordinates a texture lies by, and how they are transformed."""
        found: Table = {}
        for _ in range(_MOST_STEPS):
            inner = producer(shader.GetInput("st") or shader.GetInput("in"))
            if inner is None:
                break
            shader = UsdShade.Shader(inner.GetPrim())
            if shader.GetShaderId() == "UsdTransform2d" and not found:
                found = self._transform(shader)
            elif shader.GetShaderId() in ("UsdPrimvarReader_float2", "UsdPrimvarReader_float3"):
                name = str(self.value(shader, "varname", "st")) or "st"
                if name not in sets and len(sets) == 2:
                    break
                sets += [] if name in sets else [name]
                return {**found, "uv": sets.index(name)}
            else:
                break
        self._folder.left.add(f"textures of {kind} whose coordinates are no primvars, or a third")
        return {}

    def _transform(self, shader: UsdShade.Shader) -> Table:
        """Return a transform for coordinates with v downwards, as images and glTF have them."""
        degrees = float(self.value(shader, "rotation", 0.0))
        width, height = map(float, self.value(shader, "scale", (1, 1)))
        right, up = map(float, self.value(shader, "translation", (0, 0)))
        sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        offset = [right - sin * height, 1 - up - cos * height]
        if not all(map(math.isfinite, [width, height, degrees, *offset])):
            self._folder.left.add("transforms of textures that are no numbers")
            return {}
        return {"scale": [width, height], "rotation": degrees, "offset": offset}

    def _image(self, shader: UsdShade.Shader, kind: str) -> int | None:
        given = shader.GetInput("file")
        attribute = given.GetValueProducingAttributes() if given else []
        asset = attribute[0].Get(self._time) if attribute else None
        if not isinstance(asset, Sdf.AssetPath) or not asset.path:
            self._folder.left.add(f"textures of {kind} without a file")
            return None
        path = self._path(asset, attribute[0])
        if path not in self._images:
            self._images[path] = self.added(path)
        return self._images[path]

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


def producer(given: UsdShade.Input | None) -> UsdShade.Output | None:
    """Return the output of a node that gives the value of an input; None if none does."""
    if not given:
        return None
    for attribute in given.GetValueProducingAttributes():
        if UsdShade.Output.IsOutput(attribute):
            return UsdShade.Output(attribute)
    return None
