"""`glrt export`: write a scene as a file of other programs."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from glrt.cli.options import add_frame, add_variant, settings_given
from glrt.core.errors import UsageError
from glrt.core.files import check_writable, write_whole
from glrt.core.text import escaped
from glrt.image.sources import load
from glrt.scene.export.companions import Companions
from glrt.scene.export.gltf import to_gltf
from glrt.scene.export.left_out import told
from glrt.scene.export.mitsuba.file import to_mitsuba
from glrt.scene.export.pbrt.file import to_pbrt
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import find
from glrt.settings import RenderSettings, Settings, settings_for

DESCRIPTION = "Write a scene as a file of glTF, Mitsuba 3 or pbrt-v4, for other programs."
EPILOG = (
    "glTF: each object becomes a mesh of triangles with its material; there is no background, no "
    "media and no defocus. Mitsuba (.xml) and pbrt (.pbrt): meshes and images are written into a "
    "folder next to the file, named after it. Parts that a format cannot hold are named on "
    "stderr. The file is written whole or not at all. "
    "Exit codes: 0 done, 2 wrong usage or no such scene, 4 the file cannot be written."
)
Written = tuple[bytes, list[str]]  # content, and what is left out


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("scene", metavar="SCENE", help="a scene, a model, or a picture by glrt")
    parser.add_argument(
        "-o",
        dest="output",
        required=True,
        metavar="FILE",
        help="the file to write: .glb; .gltf, which holds its buffer as text; .xml for Mitsuba; "
        ".pbrt",
    )
    add_frame(parser)
    parser.add_argument(
        "--allow-outside",
        action="store_true",
        help="read files outside of the folder of the scene too: only for scenes that you trust",
    )
    add_variant(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the file and return 0; UsageError for a file of another kind."""
    path = Path(arguments.output)
    if path.suffix.lower() not in _FORMATS:
        raise UsageError(
            f"{escaped(arguments.output)}: glrt exports .glb, .gltf, .xml (Mitsuba) and .pbrt "
            "files. Name one of them."
        )
    check_writable(path)
    rules = {"allow_outside": arguments.allow_outside, "variant": arguments.variant}
    scene = load(find(arguments.scene), **rules)
    settings = settings_for(scene.render, **settings_given(arguments))
    content, left_out, companions = _exported(with_settings(scene, settings), settings, path)
    size = _save(path, content, companions)
    if text := told(left_out):
        print(f"glrt: caution: {escaped(arguments.output)}: {text}.", file=sys.stderr)
    beside = f" and {escaped(companions.folder)}/" if companions.count else ""
    print(f"Wrote {escaped(arguments.output)}{beside}: {size:,} bytes.")
    return 0


def save_whole(scene: Scene, settings: Settings, path: Path) -> bool:
    """Write a scene in the format of a suffix if nothing is left out; return whether it is so.

    Raises UsageError or RenderError if it cannot be written.
    """
    content, left_out, companions = _exported(scene, settings, path)
    if not left_out:
        _save(path, content, companions)
    return not left_out


def _exported(scene: Scene, settings: Settings, path: Path) -> tuple[bytes, list[str], Companions]:
    companions = Companions(path)
    return *_FORMATS[path.suffix.lower()](scene, settings, companions), companions


def _save(path: Path, content: bytes, companions: Companions) -> int:
    """Write the files; return their bytes. The scene file comes last."""
    size = companions.save() + len(content)
    write_whole(path, lambda file: _write(file, content))
    return size


def with_settings(scene: Scene, settings: Settings) -> Scene:
    """Return the scene with other settings of its picture, which it then has in its file."""
    render = {name: getattr(settings, name) for name in RenderSettings.model_fields}
    return scene.model_copy(update={"render": scene.render.model_copy(update=render)})


def _glb(scene: Scene, settings: Settings, companions: Companions) -> Written:
    return to_gltf(scene, True)


def _gltf(scene: Scene, settings: Settings, companions: Companions) -> Written:
    return to_gltf(scene, False)


def _xml(scene: Scene, settings: Settings, companions: Companions) -> Written:
    text, left_out = to_mitsuba(scene, settings, companions)
    return text.encode(), left_out


def _pbrt(scene: Scene, settings: Settings, companions: Companions) -> Written:
    text, left_out = to_pbrt(scene, settings, companions)
    return text.encode(), left_out


_FORMATS: dict[str, Callable[[Scene, Settings, Companions], Written]] = {
    ".glb": _glb,
    ".gltf": _gltf,
    ".xml": _xml,
    ".pbrt": _pbrt,
}


def _write(file: Path, content: bytes) -> None:
    file.write_bytes(content)
