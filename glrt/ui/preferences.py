"""What a user wants of the window whatever the scene; kept in a file of the user's."""

import json
import os
import sys
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, ValidationError

from glrt.errors import RenderError
from glrt.files import write_whole
from glrt.settings import Cost, Frozen

Mode = Literal["orbit", "fly"]
Theme = Literal["dark", "light"]
Move = Literal["forward", "back", "left", "right", "up", "down"]
Action = Move | Literal["home", "frame", "pause", "undo", "redo"]

KEYS: dict[Action, tuple[str, ...]] = {
    "forward": ("w", "up_arrow"),
    "back": ("s", "down_arrow"),
    "left": ("a", "left_arrow"),
    "right": ("d", "right_arrow"),
    "up": ("e",),
    "down": ("q",),
    "home": ("home",),
    "frame": ("f",),
    "pause": ("space",),
    "undo": ("ctrl+z",),
    "redo": ("ctrl+y", "ctrl+shift+z"),
}


def _preference(
    default: Any, help_text: str, unit: str = "", slider: Any = None, **more: Any
) -> Any:
    extra = {"cost": Cost.FREE.value, "unit": unit, "slider": slider}
    return Field(default, description=help_text, json_schema_extra=extra, **more)


class Preferences(Frozen):
    """How the window behaves; none of it changes what is rendered."""

    samples_per_frame: int = _preference(
        0,
        "samples that each frame adds; 0: as many as it has time for",
        slider=(0, 64),
        ge=0,
        le=1024,
    )
    target_error: float = _preference(
        0.02, "the relative error whose time is foretold", slider=(0.001, 0.5), gt=0, le=1
    )
    frame_rate: int = _preference(
        0,
        "frames a second to keep up; 0: 30 on a GPU, 10 without one",
        slider=(0, 60),
        ge=0,
        le=240,
    )
    mode: Mode = _preference("orbit", "orbit: a drag turns about the pivot; fly: about the camera")
    turn_speed: float = _preference(
        180.0, "turn for a drag across the whole window", "degrees", (30, 720), gt=0, le=3600
    )
    walk_speed: float = _preference(
        0.6, "step of the keys, in distances to the pivot a second", "", (0.05, 5), gt=0, le=100
    )
    invert: bool = _preference(False, "a drag upwards looks down")
    theme: Theme = _preference("dark", "colours of the window")
    scale: float = _preference(1.0, "size of the text", slider=(0.75, 3), ge=0.5, le=4)
    bindings: dict[Action, tuple[str, ...]] = Field(KEYS, description="keys of each action")


def preferences_file() -> Path:
    """Where they are kept: the user's configuration folder, as the system has it."""
    if sys.platform == "win32":
        base = Path(os.environ.get("APPDATA") or Path.home() / "AppData" / "Roaming")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Application Support"
    else:
        base = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config")
    return base / "glrt" / "view.json"


def load_preferences(file: Path) -> tuple[Preferences, str]:
    """What the file says and "", or the defaults and what is wrong with it."""
    try:
        return Preferences.model_validate(json.loads(file.read_text("utf-8"))), ""
    except FileNotFoundError:
        return Preferences(), ""
    except (OSError, ValueError, ValidationError) as error:
        problem = str(error).splitlines()[0]
        return Preferences(), f"{file} is not used: {problem}. Delete it to be rid of this message."


def save_preferences(preferences: Preferences, file: Path) -> str:
    """Write them; returns what went wrong, "" for nothing. What is not default is written."""
    text = preferences.model_dump_json(indent=2, exclude_defaults=True) + "\n"
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write_whole(file, lambda path: _write(path, text))
    except (OSError, RenderError) as error:
        return f"The preferences cannot be kept: {error}"
    return ""


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
