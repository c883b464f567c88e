"""Paths of a pixel as values: where they went, what they met, and what light they brought.

All numbers are those of the kernel, float32 as float. Places are in scene coordinates.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.image.recipe import Recipe

Array = np.ndarray[Any, np.dtype[np.float32]]
Triple = tuple[float, float, float]
Event = Literal[
    "camera",
    "lamp",
    "matte",
    "reflection",
    "specular reflection",
    "rough reflection",
    "specular transmission",
    "rough transmission",
    "scattering in a medium",
    "passes a hole",
    "passes inside glass",
    "ends",
]
Strategy = Literal["camera", "scattering", "light sampling", "particle"]
Source = Literal["object", "background", "sun", "medium"]
End = Literal[
    "left the scene",
    "bounce limit",
    "absorbed",
    "below the surface",
    "roulette",
    "loop limit of the driver",
    "linked to the camera",
]

MOST_NUMBER = 2**31 - 1  # above all numbers of samples and particles in the kernel
NUMBERS = read_constants(read("integrators/record_numbers.glsl"))
ENDS: dict[int, End] = {
    NUMBERS["END_LEFT_SCENE"]: "left the scene",
    NUMBERS["END_BOUNCE_LIMIT"]: "bounce limit",
    NUMBERS["END_ABSORBED"]: "absorbed",
    NUMBERS["END_BELOW_SURFACE"]: "below the surface",
    NUMBERS["END_BY_ROULETTE"]: "roulette",
    NUMBERS["END_CUT_LOOP"]: "loop limit of the driver",
    NUMBERS["END_LINKED"]: "linked to the camera",
}


class _Value(BaseModel):
    """Immutable, without unknown keys; infinite numbers and NaN are allowed, in JSON as strings."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=True, ser_json_inf_nan="strings"
    )


class PathVertex(_Value):
    """A place on a path, and what happened there; the first one is on the lens."""

    event: Event = Field(description="what happened there")
    position: Triple = Field(description="in scene units")
    normal: Triple = Field(description="unit; of the shape: outward where it has an inside")
    shading_normal: Triple = Field(description="unit; as `normal`, by the mesh or by an image")
    object: int | None = Field(description="its number among the objects of the scene, from 0")
    name: str = Field(description="of the object, or of the medium that scatters")
    material: str | None = Field(description="its name")
    distance: float = Field(description="from the vertex before, in scene units")
    throughput: Triple = Field(
        description="of the path up to there: what a radiance of 1 there gives the pixel"
    )
    direction: Triple | None = Field(description="unit; that the path took or would have taken")
    pdf: float = Field(description="density of it per solid angle; 0: there is but one")
    survival: float = Field(description="chance to go on by roulette; who does weighs more", le=1)


class Contribution(_Value):
    """Light that a path found from one of its vertices."""

    vertex: int = Field(description="number of the last vertex of the path when it was found")
    strategy: Strategy = Field(
        description="how: seen by the camera, met by scattering, sampled from the vertex, or "
        "brought there by a particle"
    )
    source: Source = Field(description="what shines")
    object: int | None = Field(description="its number among the objects of the scene, from 0")
    name: str = Field(description="of the object, or of the medium")
    radiance: Triple = Field(description="that shines there; of a medium: per unit of length")
    direction: Triple | None = Field(description="unit; from the vertex to what was sampled")
    distance: float | None = Field(description="to a sampled point, in scene units")
    pdf: float = Field(description="density per solid angle with which it was found; 0: a delta")
    other_pdf: float = Field(
        description="density with which the other strategy would have, or for a particle a path "
        "from the camera; 0: never, or not asked"
    )
    weight: float = Field(description="weight of this strategy among all for this light, 0 to 1")
    added: Triple = Field(description="what the sample got of it, weighted")
    hidden: bool = Field(description="whether something stands before it: nothing was added")

    @property
    def unweighted(self) -> Triple:
        """`added`, if this strategy were the only one: without its weight; 0 for a weight of 0."""
        if not self.weight:
            return (0.0, 0.0, 0.0)
        x, y, z = (value / self.weight for value in self.added)
        return (x, y, z)


class Path(_Value):
    """One sample of a pixel: its path, and the light on it in the order in which it was found.

    Or the path of a particle that reaches the pixel, from its lamp to its link to the camera.
    """

    sample: int = Field(description="its number, from 0", ge=0, lt=MOST_NUMBER)
    radiance: Triple = Field(description="that the pixel got: the sum of what was added")
    particle: int | None = Field(
        None,
        description="of a particle: its number among those of all pixels for the sample",
        ge=0,
        lt=MOST_NUMBER,
    )
    end: End = Field(description="why it ended")
    vertices: tuple[PathVertex, ...] = Field(description="from the camera on")
    contributions: tuple[Contribution, ...] = Field(description="light that it found")


@dataclass(frozen=True)
class PixelParticles:
    """Light that particles from lamps bring to one pixel."""

    samples: int  # samples whose particles were followed, in whole blocks
    numbers: tuple[tuple[int, int], ...]  # sample and number of each particle that arrives
    radiances: Array  # (n, 3): what each one brings, in the mean over its sample's particles
    paths: tuple[Path, ...]  # paths of the requested particles

    @property
    def mean(self) -> Array:
        """Light of particles in the pixel, (3,) float32; a film sums in fixed point instead."""
        return np.asarray(self.radiances.astype(np.float64).sum(axis=0) / self.samples, np.float32)

    def brightest(self, count: int) -> list[tuple[int, int]]:
        """Sample and number of the `count` particles that bring most light, the brightest first."""
        order = np.argsort(-self.radiances.astype(np.float64).sum(axis=1), kind="stable")
        return [self.numbers[index] for index in order[:count]]


@dataclass(frozen=True)
class PixelPaths:
    """Samples of one pixel: the radiance of each, and the paths of some."""

    recipe: Recipe  # what was traced
    pixel: tuple[int, int]  # column and row in the full frame, from 0, row 0 on top
    radiances: Array  # (n, 3) of the samples 0 to n - 1; NaN for a lost one
    paths: tuple[Path, ...]  # paths of the requested samples
    particles: "PixelParticles | None" = None  # particles that reach the pixel, with --caustics on

    @property
    def mean(self) -> Array:
        """The pixel by paths from the camera, (3,) float32; bitwise on software drivers."""
        return running_mean(self.radiances)

    @property
    def lost(self) -> int:
        """Number of samples that are not finite, or that the driver's loop limit has lost."""
        return int(np.sum(~np.isfinite(self.radiances).all(axis=1)))

    @property
    def shares(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """The share of each sample in the light of all, (n,), by the sum of its channels."""
        light = self.radiances.astype(np.float64).sum(axis=1)
        light[~np.isfinite(light)] = 0.0
        shares: np.ndarray[Any, np.dtype[np.float64]] = light / max(light.sum(), 1e-300)
        return shares

    def brightest(self, count: int) -> list[int]:
        """Numbers of the `count` brightest samples, brightest first; none without light."""
        shares = self.shares
        order = np.argsort(-shares, kind="stable")[:count]
        return [int(number) for number in order if shares[number] > 0]


def running_mean(radiances: Array) -> Array:
    """Mean of finite samples, (n, 3), with the rounding of `next_mean` in film/pixel.glsl."""
    mean = np.zeros(3, np.float32)
    finite = radiances[np.isfinite(radiances).all(axis=1)]
    for count, radiance in enumerate(finite, start=1):
        step = (radiance - mean) * (np.float32(1) / np.float32(count))
        last_place = (mean.view(np.uint32) & np.uint32(0x7F800000)).view(np.float32)
        turn = np.float32(((count * 0x9E3779B9) & 0xFFFFFFFF) >> 8) * np.float32(2.0**-24)
        dither = (turn - np.float32(0.5)) * (last_place * np.float32(2.0**-23))
        mean = mean + (step + dither * (step != 0).astype(np.float32))
    return mean
