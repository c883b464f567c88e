"""A table of the render methods and their traits, which decide what a kernel needs.

docs/extending.md explains how to add a method.
"""

from dataclasses import dataclass, replace
from typing import get_args

from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.settings import Method, RenderSettings, Reuse, Settings

EFFECT_BITS = read_constants(read("integrators/effects.glsl"))
DEPTH_OF_TREE = read_constants(read("integrators/branches.glsl"))["MOST_DEPTH_OF_TREE"]


@dataclass(frozen=True)
class Traits:
    """The traits of a render method."""

    model: int = 0  # its number in shaders_glsl/integrators/classic.glsl; 0 traces paths
    samples_lights: bool = False  # samples a light at each vertex of a path
    weights_both: bool = False  # weighs light sampling and scattering by the power heuristic
    chooses_lights: bool = False  # chooses one lamp at each point, by flux and nearness
    follows: bool = True  # follows light over mirrors and through glass
    splits: bool = False  # follows both rays at glass, as a tree, not one at random
    has_constants: bool = False  # takes constants for all surfaces, [render.phong]
    has_lens: bool = True
    has_rough: bool = True  # renders rough metal and glass; else they are smooth
    has_probes: bool = False  # takes indirect light from a grid of probes
    gathers: bool = False  # traces paths to one more matte surface before it reads probes
    resamples: bool = False  # resamples the light of the first matte surface
    rasters: bool = False  # finds first surfaces by rasterisation, and adds chosen effects of rays
    marches: bool = False  # crosses media with a grid in steps of a fixed length

    @property
    def uses_lamps(self) -> bool:
        """Whether the method finds lamps by other means than scattering."""
        return self.samples_lights or self.model > 0

    @property
    def weighs_particles(self) -> bool:
        """Whether the method can weigh paths from lamps together with its own."""
        return self.weights_both and not (self.has_probes or self.rasters or self.marches)


METHODS: dict[str, Traits] = {
    "naive": Traits(),
    "nee": Traits(samples_lights=True, chooses_lights=True),
    "mis": Traits(samples_lights=True, weights_both=True, chooses_lights=True),
    "phong": Traits(model=1, follows=False, has_constants=True, has_lens=False),
    "blinn": Traits(model=2, follows=False, has_constants=True, has_lens=False),
    "whitted": Traits(model=3, has_lens=False, has_rough=False),
    "whitted_tree": Traits(model=5, splits=True, has_lens=False, has_rough=False),
    "cook": Traits(model=4, chooses_lights=True),
    "ddgi": Traits(samples_lights=True, weights_both=True, chooses_lights=True, has_probes=True),
    "gather": Traits(
        samples_lights=True, weights_both=True, chooses_lights=True, has_probes=True, gathers=True
    ),
    "resampled": Traits(
        samples_lights=True,
        weights_both=True,
        chooses_lights=True,
        has_probes=True,
        gathers=True,
        resamples=True,
    ),
    "hybrid": Traits(samples_lights=True, weights_both=True, chooses_lights=True, rasters=True),
    "march": Traits(samples_lights=True, weights_both=True, chooses_lights=True, marches=True),
}
CLASSIC = [name for name, traits in METHODS.items() if traits.model]  # older than path tracing
# Methods whose picture does not converge to the light of the scene.
BIASED = [
    name
    for name, traits in METHODS.items()
    if traits.model or traits.has_probes or traits.rasters or traits.marches
]

if list(METHODS) != list(get_args(Method)):
    raise TypeError(f"methods have rows {list(METHODS)}, and settings {get_args(Method)}")

TEMPORAL: tuple[Reuse, ...] = ("temporal", "both")  # reuse what the pixel has kept
SPATIAL: tuple[Reuse, ...] = ("spatial", "both")  # reuse what pixels around have kept


def traits_of(settings: RenderSettings) -> Traits:
    """Return the traits of the method with these settings.

    The effects of method hybrid decide whether it has probes. Without shadows, no scattered ray
    competes with the samples of lamps, since it would find them hidden.
    """
    traits = METHODS[settings.method]
    if not traits.rasters:
        return traits
    has_gi, has_shadows = "gi" in settings.effects, "shadows" in settings.effects
    return replace(traits, has_probes=has_gi, weights_both=has_shadows)


def depth_of(settings: RenderSettings) -> int:
    """Return the most scattering events that the method follows."""
    splits = METHODS[settings.method].splits
    return min(settings.bounces, DEPTH_OF_TREE) if splits else settings.bounces


def reuses_points(settings: Settings) -> bool:
    """Return whether a sample reuses the points that the previous one kept."""
    return METHODS[settings.method].resamples and settings.reuse != "none"


def has_ambient(settings: Settings) -> bool:
    """Return whether surfaces send ambient light of their own, which belongs to no lamp."""
    phong = settings.phong if METHODS[settings.method].has_constants else None
    return phong is not None and phong.ambient is not None


def effect_bits(settings: RenderSettings) -> int:
    """Return the bits of the effects of method hybrid for shaders; 0 for other methods."""
    if not METHODS[settings.method].rasters:
        return 0
    bits = (EFFECT_BITS[effect.upper()] for effect in settings.effects)
    return EFFECT_BITS["BY_CHOICE"] | sum(bits)
