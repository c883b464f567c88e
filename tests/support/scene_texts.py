"""Texts of scene files, before and after the window saves a change."""

import difflib
from collections.abc import Callable
from pathlib import Path

from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import read_scene
from glrt.scene.scenefile.toml_writer import write_scene


def changed_lines(before: str, after: str) -> list[str]:
    """Lines that are not in both texts: removed lines and added lines."""
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return [line for line in lines if line[0] in "+-"]


def saved(text: str, folder: Path, change: Callable[[Scene], Scene]) -> tuple[Scene, str]:
    """A scene file that was changed in the window: the scene, and the text saved over it."""
    file = folder / "scene.toml"
    file.write_bytes(text.encode())
    scene = change(read_scene(file))
    assert write_scene(scene, file, file)
    assert read_scene(file) == scene
    return scene, file.read_bytes().decode()
