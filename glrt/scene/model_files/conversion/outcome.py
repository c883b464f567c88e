"""The part of a conversion that runs in a process of its own: its limits, and what it writes."""

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.conversion.reports import LeftOut, UnshownError
from glrt.scene.model_files.gltf_file import GltfFile

_MEMORY = 16 << 30  # bytes of the process
KEY = "glrt_tables"  # in the extras of the file: what glTF cannot hold


def put_tables(
    glb: GltfFile,
    folder: Folder,
    looks: list[dict[str, Any]],
    lights: dict[str, Any],
    lenses: dict[str, Any],
) -> None:
    """Put what glTF cannot hold into a file.

    Looks are tables of materials in their order, each with `is_two_sided`; lights are tables of a
    scene, and lenses keys of its camera by the numbers of nodes.
    """
    tables = {"looks": looks, "lights": lights, "lenses": lenses}
    glb.put("extras", {KEY: {**tables, "layers": folder.layers, "left_out": folder.left.told}})


def convert(converted: Callable[[Folder], bytes]) -> int:
    """Convert a file, FILE BASE ALLOW_OUTSIDE OUTPUT; write the mistake as JSON if it has one."""
    _limit()
    file, base, outside, output = sys.argv[1:]
    folder = Folder(Path(file), Path(base), outside == "True", LeftOut())
    try:
        content = converted(folder)
    except UnshownError as problem:
        content = json.dumps({"problem": str(problem)}).encode()
    Path(output).write_bytes(content)
    return 0


def _limit() -> None:
    """Let the process have no more memory than any file needs, and leave nothing of a crash."""
    if os.name == "posix":
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
