"""`glrt export`: write a scene as a file of other programs."""

import argparse
import sys
from pathlib import Path

from glrt.cli.options import add_variant
from glrt.core.errors import UsageError
from glrt.core.files import check_writable, write_whole
from glrt.core.text import escaped
from glrt.image.sources import load
from glrt.scene.export.gltf import to_gltf, told
from glrt.scene.scenefile.catalog import find

DESCRIPTION = "Write a scene as a glTF file, for other programs."
EPILOG = (
    "Each object becomes a mesh of triangles with its material. A glTF file has no background, no "
    "media and no defocus. Parts that it cannot hold are named on stderr. The file is "
    "written whole or not at all. "
    "Exit codes: 0 done, 2 wrong usage or no such scene, 4 the file cannot be written."
)
_SUFFIXES = (".glb", ".gltf")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("scene", metavar="SCENE", help="a scene, a model, or a picture by glrt")
    parser.add_argument(
        "-o",
        dest="output",
        required=True,
        metavar="FILE",
        help="the file to write: .glb, or .gltf, which holds its buffer as text",
    )
    parser.add_argument(
        "--allow-outside",
        action="store_true",
        help="read files outside of the folder of the scene too: only for scenes that you trust",
    )
    add_variant(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the file and return 0; UsageError for a file of another kind."""
    path = Path(arguments.output)
    if path.suffix.lower() not in _SUFFIXES:
        raise UsageError(
            f"{escaped(arguments.output)}: glrt exports .glb and .gltf files. Name one of them."
        )
    check_writable(path)
    rules = {"allow_outside": arguments.allow_outside, "variant": arguments.variant}
    scene = load(find(arguments.scene), **rules)
    content, left_out = to_gltf(scene, path.suffix.lower() == ".glb")
    write_whole(path, lambda file: _write(file, content))
    if text := told(left_out):
        print(f"glrt: caution: {escaped(arguments.output)}: {text}.", file=sys.stderr)
    print(f"Wrote {escaped(arguments.output)}: {len(content):,} bytes.")
    return 0


def _write(file: Path, content: bytes) -> None:
    file.write_bytes(content)
