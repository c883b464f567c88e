"""The layers of a USD file: those in its folder, and no others unless the user allows it."""

import os
import re

from pxr import Ar, Sdf, Usd

from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.conversion.reports import UnshownError

_MOST_LAYERS = 10_000


def opened_stage(folder: Folder) -> Usd.Stage:
    """Return the composed file; layers that may not or cannot be read are left out by name.

    Their names are removed from the layers in memory, so that the library never opens them.
    """
    root = _layer(str(folder.root))
    if isinstance(root, str):
        raise UnshownError(f"is damaged: {root}" if root else "is damaged, or no USD file")
    waiting, kept = [root], {root.identifier: root}
    while waiting:
        layer = waiting.pop()
        for named in layer.GetCompositionAssetDependencies():
            found = _dependency(layer, named, folder) if named else None
            if found is None:
                layer.UpdateCompositionAssetDependency(named, "")
            elif found.identifier not in kept:
                kept[found.identifier] = found
                waiting.append(found)
        if len(kept) > _MOST_LAYERS:
            raise UnshownError(f"has more than {_MOST_LAYERS:,} layers")
    folder.layers += _files(kept.values(), folder)
    stage = Usd.Stage.Open(root)
    if not stage:
        raise UnshownError("is damaged: its layers cannot be put together")
    return stage


def file_of(path: str) -> str:
    """Return the file that a path names: the package, for a path into one."""
    return Ar.SplitPackageRelativePathOuter(path)[0] if Ar.IsPackageRelativePath(path) else path


def _dependency(layer: Sdf.Layer, named: str, folder: Folder) -> Sdf.Layer | None:
    if Sdf.VariableExpression.IsExpression(named):
        folder.left.name("layers by expressions", named)
        return None
    path = layer.ComputeAbsolutePath(named)
    if not os.path.isabs(path):  # nothing is there
        folder.left.name("layers that cannot be read", named)
        return None
    if not folder.may_read(file_of(path)):
        folder.left.name("layers outside of the folder (--allow-outside)", named)
        return None
    found = _layer(path)
    if isinstance(found, str):
        folder.left.name("layers that cannot be read", named)
        return None
    return found


def _layer(path: str) -> Sdf.Layer | str:
    """Return a layer, or where it cannot be parsed: a sentence, empty for files without lines."""
    try:
        return Sdf.Layer.FindOrOpen(path) or ""
    except Exception as error:  # of the library, for content that it cannot parse
        place = re.search(re.escape(path) + r":(\d+):(\d+): ", str(error))
        return f"line {place[1]}, column {place[2]} cannot be read" if place else ""


def _files(layers: object, folder: Folder) -> list[str]:
    assert hasattr(layers, "__iter__")
    files = {file_of(layer.realPath): None for layer in layers}
    own = os.path.realpath(folder.root)
    return [folder.relative(file) for file in files if os.path.realpath(file) != own]
