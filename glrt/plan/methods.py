"""The methods, a row each: what each one does, and so what it needs of a kernel.

docs/extending.md says how a method is added.
"""

from dataclasses import dataclass
from typing import get_args

from glrt.settings import Method, Reuse, Settings


@dataclass(frozen=True)
class Traits:
    """What a method does."""

    model: int = 0  # its number in shaders_glsl/integrators/classic.glsl; 0 traces paths
    samples_lights: bool = False  # at each vertex of a path
    weights_both: bool = False  # light sampling and scattering, by the power heuristic
    chooses_lights: bool = False  # one of several at each point, by flux and nearness
    follows: bool = True  # mirrors and glass
    has_lens: bool = True
    has_rough: bool = True  # metal and glass; else they are smooth
    has_probes: bool = False  # indirect light from a grid of them
    gathers: bool = False  # their light over one more matte surface, to which paths are traced
    resamples: bool = False  # the light of the first matte surface

    @property
    def uses_lamps(self) -> bool:
        """Whether it finds lamps otherwise than by scattering."""
        return self.samples_lights or self.model > 0

    @property
    def weighs_particles(self) -> bool:
        """Whether paths from lamps can be weighed with its own."""
        return self.weights_both and not self.has_probes


METHODS: dict[str, Traits] = {
    "naive": Traits(),
    "nee": Traits(samples_lights=True, chooses_lights=True),
    "mis": Traits(samples_lights=True, weights_both=True, chooses_lights=True),
    "phong": Traits(model=1, follows=False, has_lens=False),
    "blinn": Traits(model=2, follows=False, has_lens=False),
    "whitted": Traits(model=3, has_lens=False, has_rough=False),
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
}
CLASSIC = [name for name, traits in METHODS.items() if traits.model]  # before path tracing
# Those whose picture, however many samples it has, is not the light of the scene.
BIASED = [name for name, traits in METHODS.items() if traits.model or traits.has_probes]

if list(METHODS) != list(get_args(Method)):
    raise TypeError(f"methods have rows {list(METHODS)}, and settings {get_args(Method)}")

TEMPORAL: tuple[Reuse, ...] = ("temporal", "both")  # of what the pixel has kept
SPATIAL: tuple[Reuse, ...] = ("spatial", "both")  # of what pixels around have


def reuses_points(settings: Settings) -> bool:
    """Whether a sample takes up what the one before has kept."""
    return METHODS[settings.method].resamples and settings.reuse != "none"
