"""Every render setting, once: default, range, unit, help and what a change of it costs.

The command line, the panel and the kernel read these models; so does `[render]` in a scene.
"""

from enum import StrEnum
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

Method = Literal["naive", "nee", "mis"]
ToneMap = Literal["none", "aces", "agx", "neutral"]

MAX_SAMPLES = 1 << 20  # a float32 running mean is good up to here


class Cost(StrEnum):
    """What a change of a setting costs a running render."""

    FREE = "free"  # the display alone
    RELIGHT = "relight"  # weights of film layers: no sample is lost
    RESTART = "restart"  # accumulation starts again
    RECOMPILE = "recompile"  # another kernel


def _setting(default: Any, help_text: str, cost: Cost, unit: str = "", **limits: Any) -> Any:
    extra = {"cost": cost.value, "unit": unit}
    return Field(default, description=help_text, json_schema_extra=extra, **limits)


class Frozen(BaseModel):
    """A value: immutable, without unknown keys, infinities or NaN."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class RenderSettings(Frozen):
    """How a scene wants to be rendered: its `[render]` table."""

    width: int = _setting(512, "width of the frame", Cost.RESTART, "pixels", ge=1, le=16384)
    height: int = _setting(512, "height of the frame", Cost.RESTART, "pixels", ge=1, le=16384)
    samples: int = _setting(
        256, "samples of each pixel", Cost.FREE, "samples", ge=1, le=MAX_SAMPLES
    )
    bounces: int = _setting(
        10, "largest number of scattering events on a path", Cost.RESTART, "", ge=0, le=1000
    )
    method: Method = _setting(
        "mis",
        "naive: scattering alone finds the lamps; nee: light sampling; mis: both, weighted",
        Cost.RECOMPILE,
    )


Pixels = Annotated[int, Field(ge=0, le=16384)]


class Settings(RenderSettings):
    """Everything that a render can be told, beyond what the scene itself asks for."""

    crop: tuple[Pixels, Pixels, Pixels, Pixels] | None = _setting(
        None, "the part of the frame to render: left, top, width, height", Cost.RESTART, "pixels"
    )
    sampler: Literal["independent"] = _setting(
        "independent", "where random numbers come from", Cost.RECOMPILE
    )
    roulette: bool = _setting(
        True, "end dim paths by Russian roulette: another variance, the same mean", Cost.RECOMPILE
    )
    seed: int = _setting(
        0, "chooses the random numbers", Cost.RESTART, "", ge=0, le=0xFFFFFFFF
    )
    exposure: float = _setting(
        0.0, "brightness of PNG files and of the display", Cost.FREE, "EV", ge=-50, le=50
    )
    tonemap: ToneMap = _setting("neutral", "tone curve of PNG files and of the display", Cost.FREE)
