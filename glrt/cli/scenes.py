"""`glrt scenes`: list the scenes that come with glrt."""

import argparse
import json
from typing import Any

from glrt.core.text import counted
from glrt.scene.scenefile.catalog import all_scene_names, file_of
from glrt.scene.scenefile.toml import read_scene

DESCRIPTION = "List the scenes that come with glrt: name, size in pixels, number of objects, title."
EPILOG = "Each name can stand wherever a command asks for a SCENE."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("--json", action="store_true", help="print the list as one line of JSON")


def run(arguments: argparse.Namespace) -> int:
    """Print a line for each scene, or one line of JSON for all; return 0."""
    scenes = [_facts(name) for name in all_scene_names()]
    print(json.dumps(scenes) if arguments.json else "\n".join(_table(scenes)))
    return 0


def _facts(name: str) -> dict[str, Any]:
    scene = read_scene(file_of(name))
    return {
        "name": name,
        "title": scene.title,
        "width": scene.render.width,
        "height": scene.render.height,
        "objects": len(scene.objects),
    }


def _table(scenes: list[dict[str, Any]]) -> list[str]:
    rows = [
        (
            scene["name"],
            f"{scene['width']} x {scene['height']}",
            counted(scene["objects"], "object"),
            scene["title"] or "no title",
        )
        for scene in scenes
    ]
    name, size, objects = (max((len(row[i]) for row in rows), default=0) for i in range(3))
    return [f"{a:<{name}}  {b:>{size}}  {c:>{objects}}  {d}" for a, b, c, d in rows]
