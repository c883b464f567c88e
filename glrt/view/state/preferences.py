"""Preferences of the window, kept in a file of the user."""

import json
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError, field_validator

from glrt.core.errors import RenderError
from glrt.core.files import reason, write_text
from glrt.core.resources import config_folder
from glrt.rendering.history.temporal import Mode as Temporal
from glrt.rendering.history.wrls import Predictor
from glrt.settings import Cost, Editable, Frozen
from glrt.view.state import keys
from glrt.view.state.keys import DEFAULTS, Bindings

Mode = Literal["orbit", "fly"]
Theme = Literal["dark", "light"]
Tab = Literal["Scene", "Light", "Render", "Compare", "Inspect", "Window"]

FREE = Cost.FREE

_MEND = "Correct or delete this file."


class Preferences(Frozen):
    """How the window behaves; none of it changes what is rendered."""

    samples_per_frame: Annotated[int, Editable(FREE, slider=(0, 64))] = Field(
        0,
        description="samples that each frame adds; 0: as many as fit into its time",
        ge=0,
        le=1024,
    )
    target_error: Annotated[float, Editable(FREE, slider=(0.001, 0.5))] = Field(
        0.02, description="the relative error that the forecast is for", gt=0, le=1
    )
    frame_rate: Annotated[int, Editable(FREE, slider=(0, 60))] = Field(
        0,
        description="frames a second; 0: 30 on a GPU, 10 without one",
        ge=0,
        le=240,
    )
    temporal: Annotated[Temporal, Editable(FREE)] = Field(
        "reproject",
        description="what is shown while the camera moves; reset: only the new picture; "
        "reproject: the previous picture, reprojected, until the new one has enough samples; taa: "
        "an exponential mean of reprojected pictures, clamped to the new one; ataa: taa with more "
        "samples where it fails; wrls: a line fitted to all samples of a pixel, and a mean of its "
        "neighbours; upsample: coarse pictures are reconstructed at full size, from samples of "
        "some pixels and the previous pictures",
    )
    predictor: Annotated[Predictor, Editable(FREE)] = Field(
        "published",
        description="predictor of temporal wrls; published: a mean with the new sample, follows "
        "changes quickly; delayed: the mean before it, calmer and later",
    )
    mode: Annotated[Mode, Editable(FREE)] = Field(
        "orbit", description="orbit: a drag turns about the pivot; fly: about the camera"
    )
    turn_speed: Annotated[float, Editable(FREE, "degrees", (30, 720))] = Field(
        180.0, description="angle of a drag across the whole window", gt=0, le=3600
    )
    walk_speed: Annotated[float, Editable(FREE, slider=(0.05, 5))] = Field(
        0.6, description="speed of walking, in distances to the pivot a second", gt=0, le=100
    )
    wheel_speed: Annotated[float, Editable(FREE, slider=(0.1, 5))] = Field(
        1.0,
        description="step of the wheel; 1: a tenth of the distance to the pivot",
        gt=0,
        le=9,
    )
    invert: Annotated[bool, Editable(FREE)] = Field(
        False, description="invert the vertical axis of drags"
    )
    axes: Annotated[bool, Editable(FREE)] = Field(
        False, description="show the axes of the scene; a click on one looks along it"
    )
    theme: Annotated[Theme, Editable(FREE)] = Field("dark", description="colours of the window")
    scale: Annotated[float, Editable(FREE, slider=(0.75, 3))] = Field(
        1.0, description="size of the text", ge=0.5, le=4
    )
    tour: Annotated[bool, Editable(FREE)] = Field(
        True, description="show the five steps of the tour at the start"
    )
    tab: Annotated[Tab, Editable(FREE)] = Field(
        "Render", description="tab of the panel that is shown"
    )
    folded: tuple[str, ...] = Field((), description="titles of parts of the panel that are folded")
    bindings: Bindings = Field(
        DEFAULTS, description="keys of each action that differ from the defaults"
    )

    @field_validator("bindings")
    @classmethod
    def _mean_one_thing_each(cls, given: Bindings) -> Bindings:
        bindings = keys.with_defaults(given)
        if problem := keys.problem(bindings):
            raise ValueError(problem)
        return bindings


def preferences_file() -> Path:
    """Return the file of the preferences, in the user's configuration folder of the system."""
    return config_folder() / "view.json"


def load_preferences(file: Path) -> tuple[Preferences, str]:
    """Read the file, with defaults for invalid values; returns also its problem, "" for none."""
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
    """Write the preferences that differ from the defaults; returns a problem, "" for none."""
    text = preferences.model_dump_json(indent=2, exclude_defaults=True) + "\n"
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write_text(file, text)
    except (OSError, RenderError) as error:
        return f"The preferences cannot be kept: {error}"
    return ""
