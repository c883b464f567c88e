"""What a user wants of the window whatever the scene; kept in a file of the user's."""

import json
import os
import sys
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, ValidationError, field_validator

from glrt.errors import RenderError
from glrt.files import reason, write_text
from glrt.settings import Cost, Frozen
from glrt.ui import keys
from glrt.ui.keys import DEFAULTS, Bindings

Mode = Literal["orbit", "fly"]
Theme = Literal["dark", "light"]

_MEND = "Correct or delete it to be rid of this message."


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
    wheel_speed: float = _preference(
        1.0,
        "how far a click of the wheel goes, against a tenth of the way",
        "",
        (0.1, 5),
        gt=0,
        le=9,
    )
    invert: bool = _preference(False, "a drag upwards looks down")
    theme: Theme = _preference("dark", "colours of the window")
    scale: float = _preference(1.0, "size of the text", slider=(0.75, 3), ge=0.5, le=4)
    bindings: Bindings = Field(DEFAULTS, description="keys of each action, where not the usual")

    @field_validator("bindings")
    @classmethod
    def _mean_one_thing_each(cls, given: Bindings) -> Bindings:
        bindings = {**DEFAULTS, **given}
        if problem := keys.problem(bindings):
            raise ValueError(problem)
        return bindings


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
    """What the file says, the defaults where it is wrong, and what is wrong with it; "" if fine."""
    try:
        given = json.loads(file.read_text("utf-8"))
    except FileNotFoundError:
        return Preferences(), ""
    except (OSError, ValueError, RecursionError) as error:
        return Preferences(), f"{file} is not used: {reason(error)}. {_MEND}"
    if not isinstance(given, dict):
        return Preferences(), f"{file} is not used: it holds no table of preferences. {_MEND}"
    try:
        return Preferences.model_validate(given), ""
    except ValidationError as error:
        wrong = {str(problem["loc"][0]): str(problem["msg"]) for problem in error.errors()}
    good = {key: value for key, value in given.items() if key not in wrong}
    told = "; ".join(f"{key}: {text.removeprefix('Value error, ')}" for key, text in wrong.items())
    return Preferences.model_validate(good), f"Some of {file} is not used: {told}. {_MEND}"


def save_preferences(preferences: Preferences, file: Path) -> str:
    """Write them; returns what went wrong, "" for nothing. What is not default is written."""
    text = preferences.model_dump_json(indent=2, exclude_defaults=True) + "\n"
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write_text(file, text)
    except (OSError, RenderError) as error:
        return f"The preferences cannot be kept: {error}"
    return ""
