"""The settings of a render as keywords of functions, for editors and type checkers."""

from typing import TypedDict

from glrt.phong import Phong
from glrt.settings import (
    Adaptive,
    Aov,
    Caustics,
    Denoise,
    Effect,
    Method,
    Reuse,
    Sampler,
    ToneMap,
)


class FrameOptions(TypedDict, total=False):
    """The fields of Settings except `samples`, as keywords for editors; a test keeps both alike."""

    width: int
    height: int
    bounces: int
    method: Method
    effects: tuple[Effect, ...]
    adaptive: Adaptive
    phong: Phong | None
    crop: tuple[int, int, int, int] | None
    sampler: Sampler
    roulette: bool
    caustics: Caustics
    particles: float
    aimed: float
    linked: float
    probes: int
    reuse: Reuse
    unbiased: bool
    march_step: float
    seed: int
    exposure: float
    tonemap: ToneMap
    aov: tuple[Aov, ...]
    denoise: Denoise


class SettingOptions(FrameOptions, total=False):
    """All fields of Settings, as keywords for editors."""

    samples: int
