"""`glrt import`: write a model as a scene file."""

import argparse
import sys
from pathlib import Path

from glrt.cli.options import add_variant
from glrt.core.errors import UsageError
from glrt.core.text import counted, escaped
from glrt.image.sources import load
from glrt.scene.model_scene import is_model
from glrt.scene.scenefile.catalog import find
from glrt.scene.warnings import cautions
from glrt.settings import settings_for

DESCRIPTION = (
    "Write the scene of a model (.glb, .gltf, .obj, .ply, .stl, .usd, .usda, .usdc, .usdz or "
    ".mtlx) as a scene file."
)
EPILOG = (
    "The scene has a mesh for each material of the model, its camera and lights or usual ones, and "
    "renders to the same picture as the model. If the model is animated, the scene plays its first "
    "animation that moves. In another folder the scene gets a copy of the model. "
    "Exit codes: 0 done, 2 wrong usage or no such model."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("model", metavar="MODEL", help="a model")
    parser.add_argument(
        "-o", dest="scene", required=True, metavar="FILE.toml", help="the scene file to write"
    )
    parser.add_argument(
        "--allow-outside",
        action="store_true",
        help="read files outside of the folder of the model too: only for models that you trust",
    )
    add_variant(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the scene file and return 0; UsageError if the file is not a model."""
    if not is_model(Path(arguments.model)):
        raise UsageError(
            f"{arguments.model} is no model: its name must end in "
            ".glb, .gltf, .obj, .ply, .stl, .usd, .usda, .usdc, .usdz or .mtlx."
        )
    rules = {"allow_outside": arguments.allow_outside, "variant": arguments.variant}
    scene = load(find(arguments.model), **rules)
    scene.save(arguments.scene)
    for text in cautions(scene, settings_for(scene.render)):
        print(f"glrt: caution: {text}", file=sys.stderr)
    what = counted(len(scene.objects), "object"), counted(len(scene.materials), "material")
    print(f"Wrote {escaped(arguments.scene)}: {', '.join(what)}.")
    return 0
