"""Every render setting, once: default, range, unit, help and what a change of it costs.

The command line, the panel and the kernel read these models; so does `[render]` in a scene.
"""

from enum import StrEnum
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from glrt.errors import UsageError

Method = Literal["naive", "nee", "mis", "phong", "blinn", "whitted", "cook"]
Sampler = Literal["sobol", "independent"]
ToneMap = Literal["none", "aces", "agx", "neutral"]

MAX_SAMPLES = 1 << 20  # a float32 running mean is good up to here
BLOCKS = {"sobol": 16, "independent": 1}  # samples of an observation, by sampler


class Cost(StrEnum):
    """What a change of a setting costs a running render."""

    FREE = "free"  # the display alone
    RELIGHT = "relight"  # weights of film layers: no sample is lost
    RESTART = "restart"  # accumulation starts again
    RECOMPILE = "recompile"  # another kernel


def _setting(
    default: Any,
    help_text: str,
    cost: Cost,
    unit: str = "",
    slider: tuple[float, float] | None = None,
    **limits: Any,
) -> Any:
    """`slider`: the range that is worth dragging through; the limits are what is valid."""
    extra: dict[str, Any] = {"cost": cost.value, "unit": unit, "slider": slider}
    return Field(default, description=help_text, json_schema_extra=extra, **limits)


class Frozen(BaseModel):
    """A value: immutable, without unknown keys, infinities or NaN."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class RenderSettings(Frozen):
    """How a scene wants to be rendered: its `[render]` table."""

    width: int = _setting(
        512, "width of the frame", Cost.RESTART, "pixels", (16, 4096), ge=1, le=16384
    )
    height: int = _setting(
        512, "height of the frame", Cost.RESTART, "pixels", (16, 4096), ge=1, le=16384
    )
    samples: int = _setting(
        256, "samples of each pixel", Cost.FREE, "samples", (1, 65536), ge=1, le=MAX_SAMPLES
    )
    bounces: int = _setting(
        10,
        "largest number of scattering events on a path",
        Cost.RESTART,
        "",
        (0, 32),
        ge=0,
        le=1000,
    )
    method: Method = _setting(
        "mis",
        "naive: scattering alone finds the lamps; nee: light sampling; mis: both, weighted; phong, "
        "blinn, whitted, cook: older models, which leave light out",
        Cost.RECOMPILE,
    )


Pixels = Annotated[int, Field(ge=0, le=16384)]


class Settings(RenderSettings):
    """Everything that a render can be told, beyond what the scene itself asks for."""

    crop: tuple[Pixels, Pixels, Pixels, Pixels] | None = _setting(
        None, "the part of the frame to render: left, top, width, height", Cost.RESTART, "pixels"
    )
    sampler: Sampler = _setting(
        "sobol",
        "sobol: blocks of 16 samples that fill the space evenly; independent: any random numbers",
        Cost.RECOMPILE,
    )
    roulette: bool = _setting(
        True, "end dim paths by Russian roulette: another variance, the same mean", Cost.RECOMPILE
    )
    seed: int = _setting(0, "chooses the random numbers", Cost.RESTART, "", ge=0, le=0xFFFFFFFF)
    exposure: float = _setting(
        0.0, "brightness of PNG files and of the display", Cost.FREE, "EV", (-8, 8), ge=-50, le=50
    )
    tonemap: ToneMap = _setting("neutral", "tone curve of PNG files and of the display", Cost.FREE)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels: of the crop, if there is one."""
        return (self.crop or (0, 0, self.width, self.height))[2:]

    @property
    def block(self) -> int:
        """Samples of an observation; the error of a picture is taken over whole ones."""
        return BLOCKS[self.sampler]

    @model_validator(mode="after")
    def _crop_lies_in_the_frame(self) -> Self:
        left, top, width, height = self.crop or (0, 0, self.width, self.height)
        if not (width and height and left + width <= self.width and top + height <= self.height):
            raise ValueError(
                f"crop {left} {top} {width} {height} (left, top, width, height) is not a part of "
                f"the frame of {self.width} x {self.height} pixels"
            )
        return self


def settings_for(base: RenderSettings, **overrides: Any) -> Settings:
    """`base` with other values of some fields; UsageError names each bad one and its range."""
    values = {**base.model_dump(), **overrides}
    try:
        return Settings.model_validate(values)
    except ValidationError as error:
        raise UsageError("; ".join(_advice(problem) for problem in error.errors())) from None


def cost_of_change(before: Settings, after: Settings) -> Cost:
    """The dearest class among the fields that differ."""
    order = list(Cost)
    changed = [
        cost_of(name)
        for name in Settings.model_fields
        if getattr(before, name) != getattr(after, name)
    ]
    return max(changed, key=order.index, default=Cost.FREE)


def cost_of(name: str) -> Cost:
    """The class of a field of Settings."""
    extra = Settings.model_fields[name].json_schema_extra
    assert isinstance(extra, dict)
    return Cost(str(extra["cost"]))


def _advice(problem: Any) -> str:
    text = problem["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    if problem["type"] == "extra_forbidden":
        return f"there is no setting '{problem['loc'][0]}': {', '.join(Settings.model_fields)}"
    if not problem["loc"]:
        return str(text)
    return f"{problem['loc'][0]} {text[0].lower() + text[1:]}, got {problem['input']!r}"
