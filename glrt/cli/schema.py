"""`glrt schema`: print the scene format for editors."""

import argparse
import json

from glrt.scene.scene import Scene

DESCRIPTION = "Print the JSON Schema of scene files, for editors."
EPILOG = ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add no arguments: the command has none."""
    del parser  # it has none


def run(_arguments: argparse.Namespace) -> int:
    """Print the scene format as JSON Schema; return 0."""
    print(json.dumps(Scene.model_json_schema(), indent=2))
    return 0
