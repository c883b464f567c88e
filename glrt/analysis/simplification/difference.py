"""Change of a picture by a change of its scene, bounded from above.

Both scenes are rendered with the same random numbers, so that most of the noise of their difference
cancels. With differences d1, d2 of two seeds, the mean of d1 d2 over pixels and channels, each
divided by radiance^2 + 0.01 mean(radiance)^2 of another picture, is an unbiased estimator of the
squared relative change, in the measure of `--error`. PAIRS such estimates are independent and, as
means over many pixels, nearly normal: Student's t distribution bounds their mean (Student 1908).
Light that no path has met is in no bound.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

PAIRS = 8  # of seeds
FIRST_SEED = 0x53494D50
SCALE_SEED = FIRST_SEED - 1
SCALE_SAMPLES = 64  # of the picture by which changes are divided

Floats = NDArray[np.float64]
Radiance = NDArray[np.float32]


class Change(NamedTuple):
    """Independent estimates of a squared relative change."""

    squares: tuple[float, ...]

    @property
    def value(self) -> float:
        """The relative RMS change, 0 where noise makes its estimated square negative."""
        return math.sqrt(max(self._mean, 0.0))

    def below(self, risk: float) -> float:
        """Upper bound of the relative RMS change, too low with a probability of at most `risk`."""
        return math.sqrt(max(self._mean + self._error(risk), 0.0))

    def above(self, risk: float) -> float:
        """Lower bound of the same, too high with a probability of at most `risk`."""
        return math.sqrt(max(self._mean - self._error(risk), 0.0))

    @property
    def _mean(self) -> float:
        return math.fsum(self.squares) / len(self.squares)

    def _error(self, risk: float) -> float:
        """Student's t times the standard error of the mean; infinite for one estimate."""
        count = len(self.squares)
        if count < 2:
            return math.inf
        return student(risk, count - 1) * float(np.std(self.squares, ddof=1)) / math.sqrt(count)


@lru_cache
def student(risk: float, freedom: int) -> float:
    """Return the value that Student's t of some degrees of freedom exceeds with probability risk.

    With t = sqrt(freedom) tan(a) the density becomes a power of a cosine.
    """
    angles = np.linspace(-math.pi / 2, math.pi / 2, 200_001)
    density = np.cos(angles) ** (freedom - 1)
    above = np.cumsum(density[::-1])[::-1] / density.sum()
    place = int(np.argmax(above <= risk))
    return math.sqrt(freedom) * math.tan(float(angles[place]))


@dataclass
class Differences:
    """Pictures of a scene in a frame, to compare pictures of smaller scenes with."""

    scene: Scene
    settings: Settings
    context: Context
    first_seed: int = FIRST_SEED
    known_scale: Floats | None = None  # from a comparison in the same frame
    _whole: dict[tuple[int, int], Radiance] = field(default_factory=dict)
    _open: Renderer | None = None

    def change(
        self,
        scene: Scene,
        bounces: int,
        samples: int,
        hopeless: Callable[[float], bool] = lambda _: False,
    ) -> Change:
        """Return the change by another scene and limit of bounces, from samples a pixel and seed.

        It ends after one pair whose estimate is `hopeless`.
        """
        found: list[float] = []
        scale = self.scale
        for pair in range(PAIRS):
            seeds = [self.first_seed + 2 * pair, self.first_seed + 2 * pair + 1]
            whole = [self._picture_of_whole(seed, samples) for seed in seeds]
            other = [self._picture(scene, bounces, seed, samples) for seed in seeds]
            first, second = (
                a.astype(float) - b.astype(float) for a, b in zip(whole, other, strict=True)
            )
            products = first * second
            found.append(relative(products, scale))
            if len(found) == 1 and hopeless(found[0]):
                break
        return Change(tuple(found))

    @property
    def scale(self) -> Floats:
        """Divisor of squares, (H, W, 3); its picture has a seed of its own."""
        if self.known_scale is None:
            whole = self._picture(self.scene, self.settings.bounces, SCALE_SEED, SCALE_SAMPLES)
            radiance = whole.astype(float)
            self.known_scale = np.square(radiance) + DARK * radiance.mean() ** 2
        return self.known_scale

    def _picture_of_whole(self, seed: int, samples: int) -> Radiance:
        if (seed, samples) not in self._whole:
            bounces = self.settings.bounces
            for each in range(self.first_seed, self.first_seed + 2 * PAIRS):
                found = self._picture(self.scene, bounces, each, samples)
                self._whole[each, samples] = found
        return self._whole[seed, samples]

    def _picture(self, scene: Scene, bounces: int, seed: int, samples: int) -> Radiance:
        if self._open is None:
            own = settings_for(self.settings, bounces=bounces, seed=seed)
            self._open = Renderer(scene, own, self.context)
        else:
            self._open.update(scene, bounces=bounces, seed=seed)
        return self._open.render(samples).image().radiance

    def release(self) -> None:
        """Release the renderer."""
        if self._open:
            self._open.release()
            self._open = None


def relative(squares: Floats, scale: Floats) -> float:
    """Return the mean of squares, (H, W, 3), each over its scale; 0 over 0 is 0."""
    if np.any(squares[scale == 0]):
        return math.inf
    return float(np.divide(squares, scale, out=np.zeros_like(squares), where=scale > 0).mean())


def frame(settings: Settings, most_pixels: int) -> Settings:
    """Return settings for the whole frame in at most so many pixels, with independent samples."""
    own = settings_for(settings, aov=(), denoise="none", sampler="independent")
    scale = math.sqrt(most_pixels / math.prod(settings.size))
    if scale >= 1:
        return own
    if settings.crop:
        return own
    width, height = (max(1, math.floor(scale * side)) for side in settings.size)
    return settings_for(own, width=width, height=height)


def doublings(most: int) -> Iterator[int]:
    """Yield 1, 4, 16 ... up to `most`."""
    samples = 1
    while samples <= most:
        yield samples
        samples *= 4
