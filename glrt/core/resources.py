"""Folders of the shaders and the scenes, and the user's folders."""

import os
import sys
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]


def folder(name: str) -> Path:
    """Return `shaders_glsl` or `scenes`: in the package in a wheel, next to it in a checkout."""
    inside = _PACKAGE / name
    return inside if inside.is_dir() else _PACKAGE.parent / name


def cache_folder(name: str) -> Path:
    """Return a folder in the user's cache (XDG base directory specification); it may not exist."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "glrt" / name


def config_folder() -> Path:
    """Return the folder of the user's preferences."""
    return _folder(("APPDATA", "Roaming"), ("XDG_CONFIG_HOME", ".config"))


def state_folder() -> Path:
    """Return the folder of what a program keeps for its next start."""
    return _folder(("LOCALAPPDATA", "Local"), ("XDG_STATE_HOME", ".local/state"))


def _folder(on_windows: tuple[str, str], elsewhere: tuple[str, str]) -> Path:
    """Return a folder from an environment variable, or from its default, as pairs name them."""
    if sys.platform == "win32":
        name, default = on_windows
        base = Path(os.environ.get(name) or Path.home() / "AppData" / default)
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Application Support"
    else:
        name, default = elsewhere
        base = Path(os.environ.get(name) or Path.home() / default)
    return base / "glrt"
