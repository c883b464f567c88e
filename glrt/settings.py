"""Every render setting, once: default, range, unit, help and the cost of a change.

The command line, the panel, the kernel and the `[render]` table of scenes use these models.
"""

from typing import Annotated, Any, Literal, Self, get_args

from pydantic import Field, ValidationError, field_validator, model_validator

from glrt.core.errors import UsageError
from glrt.editable import Cost as Cost
from glrt.editable import Editable as Editable
from glrt.editable import Frozen as Frozen
from glrt.editable import editable_of as editable_of
from glrt.phong import Phong
from glrt.samplers import DIVISIONS, Division

Method = Literal[
    "naive",
    "nee",
    "mis",
    "phong",
    "blinn",
    "whitted",
    "whitted_tree",
    "cook",
    "ddgi",
    "gather",
    "resampled",
    "hybrid",
    "march",
]
Effect = Literal["shadows", "reflections", "refractions", "ambient_occlusion", "gi"]
Sampler = Literal["sobol", "sobol64", "sobol256", "sobol1024", "shared", "independent"]
Caustics = Literal["off", "on"]
Adaptive = Literal["off", "on"]
ToneMap = Literal["none", "aces", "agx", "neutral"]
Term = Literal["emission", "direct", "indirect", "diffuse", "glossy", "transmission", "volume"]
Aov = Literal["albedo", "normal", "depth", "position", "object", "bounces", Term]
Denoise = Literal["none", "oidn", "nlm", "auto"]
Reuse = Literal["none", "temporal", "spatial", "both"]

MAX_SAMPLES = 1 << 20  # a float32 running mean is good up to here
GUIDES: tuple[Aov, ...] = ("albedo", "normal")  # AOVs that guide a denoiser
TERMS: tuple[Term, ...] = get_args(Term)  # AOVs that are parts of the picture's light
EFFECTS: tuple[Effect, ...] = get_args(Effect)  # of rays, by method hybrid
NAMED_EFFECTS = {"all": EFFECTS, "none": ()}
OF_PATHS: tuple[Aov, ...] = ("bounces", *TERMS)  # AOVs of whole paths, not of first surfaces


class RenderSettings(Frozen):
    """Default settings of a scene: its `[render]` table."""

    width: Annotated[int, Editable(Cost.RESTART, "pixels", (16, 4096))] = Field(
        512, description="width of the picture, before a crop", ge=1, le=16384
    )
    height: Annotated[int, Editable(Cost.RESTART, "pixels", (16, 4096))] = Field(
        512, description="height of the picture, before a crop", ge=1, le=16384
    )
    samples: Annotated[int, Editable(Cost.FREE, "samples", (1, 65536))] = Field(
        256, description="number of light paths traced through each pixel", ge=1, le=MAX_SAMPLES
    )
    bounces: Annotated[int, Editable(Cost.RESTART, "", (0, 32))] = Field(
        10, description="largest number of scattering events on a path", ge=0, le=1000
    )
    method: Annotated[Method, Editable(Cost.RECOMPILE)] = Field(
        "mis",
        description="how light is found; naive: by scattering alone; nee: by sampling a lamp at "
        "each vertex; mis: by both, weighted (multiple importance sampling); phong, blinn, "
        "whitted, whitted_tree, cook: lighting models older than path tracing, which leave light "
        "out; ddgi: "
        "direct light as in mis, indirect light from a grid of probes; gather: as ddgi, but paths "
        "are traced to one more matte surface (final gathering); resampled: as gather, but the "
        "first matte surface is lit by one resampled point; hybrid: the first surface by "
        "rasterisation, direct light, and the effects of rays that `effects` lists; march: as mis, "
        "but media with a grid are crossed in steps of a fixed length (ray marching)",
    )
    effects: Annotated[tuple[Effect, ...], Editable(Cost.RECOMPILE)] = Field(
        EFFECTS,
        description="effects of rays that method hybrid adds to a rasterised picture: "
        f"{', '.join(EFFECTS)}; all; none",
    )
    adaptive: Annotated[Adaptive, Editable(Cost.RECOMPILE)] = Field(
        "off",
        description="on: pixels get samples in proportion to their noise, so that `samples` is the "
        "mean over pixels; the noise is that of the neighbours of a pixel in its first samples, "
        "which all pixels get: 64, or four blocks of a sampler with longer ones",
    )
    phong: Annotated[Phong | None, Editable(Cost.RESTART)] = Field(
        None,
        description="constants of methods phong and blinn for all surfaces, in a table "
        "[render.phong]; default: materials have theirs",
    )

    @field_validator("effects", mode="before")
    @classmethod
    def _effects_are_named(cls, value: Any) -> Any:
        name = value[0] if isinstance(value, list | tuple) and len(value) == 1 else value
        return NAMED_EFFECTS.get(name, value) if isinstance(name, str) else value

    @field_validator("effects")
    @classmethod
    def _effects_in_order(cls, value: tuple[Effect, ...]) -> tuple[Effect, ...]:
        return tuple(effect for effect in EFFECTS if effect in value)


Pixels = Annotated[int, Field(ge=0, le=16384)]
Crop = tuple[Pixels, Pixels, Pixels, Pixels]


class Settings(RenderSettings):
    """All settings of a render: the fields of `[render]`, and more that a scene file cannot set."""

    crop: Annotated[Crop | None, Editable(Cost.RESTART, "pixels")] = Field(
        None, description="the part of the picture to render: left, top, width, height"
    )
    sampler: Annotated[Sampler, Editable(Cost.RECOMPILE)] = Field(
        "sobol",
        description="sobol: scrambled Sobol' points in blocks of 16 samples, least noise in most "
        "scenes; sobol64, sobol256, sobol1024: longer blocks, less noise, with an error from two "
        "blocks on; shared: sobol with half of its blocks the same in all pixels, and neighbours "
        "on an object are combined without bias: less noise in large pictures of matte surfaces "
        "and smooth meshes, from 256 samples on; independent: independent random numbers",
    )
    roulette: Annotated[bool, Editable(Cost.RECOMPILE)] = Field(
        True,
        description="end dim paths at random (Russian roulette): faster, with the same mean",
    )
    caustics: Annotated[Caustics, Editable(Cost.RECOMPILE)] = Field(
        "off",
        description="on: also trace particles from lamps and the sun. They are linked to the "
        "camera and weighted with its paths: less noise where light comes through glass or is "
        "reflected by metal",
    )
    particles: Annotated[float, Editable(Cost.RESTART, "", (0.02, 2))] = Field(
        0.25, description="number of particles for each sample of a pixel", ge=0.01, le=16
    )
    aimed: Annotated[float, Editable(Cost.RESTART, "", (0, 0.98))] = Field(
        0.5,
        description="share of particles aimed at spheres of glass, or of metal with a roughness "
        "of at most 0.4, and at bounding spheres of such boxes, cylinders and meshes",
        ge=0,
        le=0.98,
    )
    linked: Annotated[float, Editable(Cost.RESTART, "", (0, 1))] = Field(
        1.0,
        description="share of particles that are also linked to the camera through single "
        "spheres of smooth glass or metal; 0: none",
        ge=0,
        le=1,
    )
    probes: Annotated[int, Editable(Cost.RESTART, "probes", (2, 8))] = Field(
        0,
        description="probes along each edge of the grid of methods ddgi, gather and resampled, 2 "
        "to 16; 0: as in [probes] of the scene, or 5",
        ge=0,
        le=16,
    )
    reuse: Annotated[Reuse, Editable(Cost.RECOMPILE)] = Field(
        "spatial",
        description="points that method resampled reuses, in addition to those of its own paths; "
        "temporal: the one that the previous sample kept for the pixel; spatial: the ones that "
        "it kept for pixels nearby; both; none",
    )
    unbiased: Annotated[bool, Editable(Cost.RECOMPILE)] = Field(
        True,
        description="trace a visibility ray for each reused sample of method resampled; off is "
        "faster, but darkens contacts and edges",
    )
    march_step: Annotated[float, Editable(Cost.RESTART, "scene units", (0, 1))] = Field(
        0.0,
        description="length of a step of method march, in media with a grid; 0: the edge of a "
        "voxel",
        ge=0,
        le=1e15,
    )
    seed: Annotated[int, Editable(Cost.RESTART)] = Field(
        0, description="seed of the random numbers", ge=0, le=0xFFFFFFFF
    )
    exposure: Annotated[float, Editable(Cost.FREE, "EV", (-8, 8))] = Field(
        0.0, description="brightness of PNG files and of the display", ge=-50, le=50
    )
    tonemap: Annotated[ToneMap, Editable(Cost.FREE)] = Field(
        "neutral", description="tone curve of PNG files and of the display"
    )
    aov: Annotated[tuple[Aov, ...], Editable(Cost.FREE)] = Field(
        (),
        description="extra channels (AOVs) of EXR files; of the first surface behind a pixel: "
        f"{', '.join(aov for aov in get_args(Aov) if aov not in OF_PATHS)}; of its paths: "
        f"{', '.join(aov for aov in OF_PATHS if aov not in TERMS)}; terms of light: "
        f"{', '.join(TERMS)}",
    )
    denoise: Annotated[Denoise, Editable(Cost.FREE)] = Field(
        "none",
        description="denoise the saved picture, with an estimate of the remaining error; oidn: "
        "Intel's Open Image Denoise, of the extra `denoise`; nlm: non-local means; auto: "
        "oidn if it is installed, else nlm",
    )

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels of the picture, or of the crop if there is one."""
        return (self.crop or (0, 0, self.width, self.height))[2:]

    @property
    def division(self) -> Division:
        """How the sampler divides the samples of a pixel."""
        return DIVISIONS[self.sampler]

    @property
    def block(self) -> int:
        """Number of samples in a block: renders in parts are cut between blocks.

        A block is an observation, over which errors are estimated. With shared numbers, a block has
        samples of each group, and a pair of groups is an observation.
        """
        return self.division.block

    @property
    def kept(self) -> tuple[Aov, ...]:
        """AOVs that a picture keeps: those requested, and the objects that share numbers."""
        return self._in_order(*self.aov, *(["object"] if self.division.is_shared else []))

    @property
    def gathered(self) -> tuple[Aov, ...]:
        """AOVs that a render gathers: those of its picture, and the guides of a denoiser."""
        return self._in_order(*self.kept, *(GUIDES if self.denoise != "none" else ()))

    @staticmethod
    def _in_order(*wanted: str) -> tuple[Aov, ...]:
        return tuple(aov for aov in get_args(Aov) if aov in wanted)

    @property
    def terms(self) -> tuple[Term, ...]:
        """Terms of light among the AOVs."""
        return tuple(term for term in TERMS if term in self.aov)

    @field_validator("probes")
    @classmethod
    def _probes_span_cells(cls, value: int) -> int:
        if value == 1:
            raise ValueError("must be 0 or at least 2: one probe cannot distinguish places")
        return value

    @field_validator("aov")
    @classmethod
    def _aovs_in_order(cls, value: tuple[Aov, ...]) -> tuple[Aov, ...]:
        return cls._in_order(*value)

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
    """Return `base` with some fields replaced; UsageError names each bad field and its range."""
    values = {**base.model_dump(), **overrides}
    try:
        return Settings.model_validate(values)
    except ValidationError as error:
        raise UsageError("; ".join(_advice(problem) for problem in error.errors())) from None


def cost_of_change(before: Settings, after: Settings) -> Cost:
    """Return the highest cost among the fields that differ; FREE if none does."""
    order = list(Cost)
    changed = [
        cost_of(name)
        for name in Settings.model_fields
        if getattr(before, name) != getattr(after, name)
    ]
    return max(changed, key=order.index, default=Cost.FREE)


def cost_of(name: str) -> Cost:
    """Return the cost of a change of the named field of Settings."""
    return editable_of(Settings.model_fields[name]).cost


def _advice(problem: Any) -> str:
    text = problem["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    if problem["type"] == "extra_forbidden":
        return f"there is no setting '{problem['loc'][0]}': {', '.join(Settings.model_fields)}"
    if not problem["loc"]:
        return str(text)
    return f"{problem['loc'][0]} {text[0].lower() + text[1:]}, got {problem['input']!r}"
