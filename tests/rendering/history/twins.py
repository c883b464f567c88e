"""The temporal methods written independently in numpy: the truth for the shaders.

Arrays hold pixels in their first axis. `dtype` float64 gives the equations, float32 their rounding.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]

FEATURE_SHARE, FORGETTING, WIDTH, LEAST, DELTA = 0.75, 0.998, 0.75, 1e-4, 1000.0
LEAST_WEIGHT = 1e-12


@dataclass
class Wrls:
    """Weighted recursive least squares of n pixels, as the paper has it.

    Without `limit` the trace of the covariance is not bounded; with `width` infinite all samples
    weigh 1; with `is_constant` the predictor is the constant alone.
    """

    radiance: Array  # (n, 3): the first sample
    is_delayed: bool = False
    limit: bool = True
    width: float = WIDTH
    forgetting: float = FORGETTING
    is_constant: bool = False
    frames: float = 1  # that the first sample is the mean of
    dtype: Any = np.float64
    feature: Array = field(init=False)
    slopes: Array = field(init=False)  # (n, 4, 3)
    p: Array = field(init=False)
    weight: Array = field(init=False)
    error: Array = field(init=False)

    def __post_init__(self) -> None:
        """A model that begins."""
        first = np.asarray(self.radiance, self.dtype)
        self.feature = first.copy()
        self.slopes = np.zeros((len(first), 4, 3), self.dtype)
        self.slopes[:, 0] = first
        self._begin(len(first))
        if self.frames > 1:
            self.p = np.concatenate([np.ones((len(first), 1), self.dtype), first], axis=1)
            self.weight = np.full(len(first), self.frames - 1, self.dtype)
            self._gain()

    def add(
        self, radiance: Array, lowest: Any = -np.inf, highest: Any = np.inf, frames: float = 1
    ) -> Array:
        """Another view; returns what the model predicts, (n, 3)."""
        t = self.dtype
        y = np.asarray(radiance, t)
        before = self.feature
        off = np.clip(before, lowest, highest).astype(t) - y
        self.feature = y + t(FEATURE_SHARE**frames) * off
        z = self.feature
        if self.is_delayed:
            z = before if frames == 1 else y + t(FEATURE_SHARE ** (frames - 1)) * off
        ones = np.ones((len(y), 1), t)
        self.p = np.concatenate([ones, np.zeros_like(z) if self.is_constant else z], axis=1)
        self.weight = self.weight_of(y, z) * t(frames)
        self.error = y - np.einsum("npc,np->nc", self.slopes, self.p)
        self.slopes = self.slopes + self._gain()[:, :, None] * self.error[:, None, :]
        return np.asarray(np.einsum("npc,np->nc", self.slopes, self.p))

    def weight_of(self, y: Array, z: Array) -> Array:
        """The weight of a sample."""
        t = self.dtype
        least = np.minimum(_length(y), _length(z)) + t(LEAST)
        distance = _length(y - z) / least / t(self.width)
        return np.asarray(np.maximum(np.exp(-distance * distance), t(LEAST_WEIGHT)))

    def _begin(self, n: int) -> None:
        t = self.dtype
        self.covariance = np.tile(np.eye(4, dtype=t) * t(DELTA), (n, 1, 1))

    def _gain(self) -> Array:
        """The gain of this sample; it also updates the covariance."""
        t = self.dtype
        spread = np.einsum("nij,nj->ni", self.covariance, self.p)
        over = t(self.forgetting) / self.weight + (self.p * spread).sum(axis=1)
        gain = spread / over[:, None]
        less = gain[:, :, None] * spread[:, None, :]
        upper = np.triu((self.covariance - less) / t(self.forgetting))
        self.covariance = upper + np.triu(upper, 1).swapaxes(1, 2)
        if self.limit:
            trace = np.trace(self.covariance, axis1=1, axis2=2)
            scale = np.minimum(t(1), t(4 * DELTA) / trace)
            self.covariance = self.covariance * scale[:, None, None]
        return np.asarray(gain)


class FactoredWrls(Wrls):
    """The same with the covariance as U D U^T, element by element as Bierman writes it."""

    def _begin(self, n: int) -> None:
        t = self.dtype
        self.factor = np.tile(np.eye(4, dtype=t), (n, 1, 1))
        self.spread = np.full((n, 4), t(DELTA))

    def _gain(self) -> Array:
        t = self.dtype
        along = np.einsum("nij,ni->nj", self.factor, self.p)
        scaled = self.spread * along
        factor, spread, gain = self.factor.copy(), self.spread.copy(), np.zeros_like(scaled)
        total = t(self.forgetting) / self.weight
        for j in range(4):
            after = total + along[:, j] * scaled[:, j]
            spread[:, j] = self.spread[:, j] * (total / after) / t(self.forgetting)
            for i in range(j):
                factor[:, i, j] -= gain[:, i] * (along[:, j] / total)
                gain[:, i] += self.factor[:, i, j] * scaled[:, j]
            gain[:, j], total = scaled[:, j], after
        if self.limit:
            trace = (spread * np.square(factor).sum(axis=1)).sum(axis=1)
            spread *= np.minimum(t(1), t(4 * DELTA) / trace)[:, None]
        self.factor, self.spread = factor, spread
        return np.asarray(gain / total[:, None])


def batch(wrls: Wrls, rows: list[tuple[Array, Array, Array]], first: Array) -> Array:
    """The same slopes by weighted least squares over all frames at once, (n, 4, 3).

    `rows` hold p, weight and radiance of each frame; what a model begins with counts as
    observations of its slopes with covariance DELTA.
    """
    n, age = len(first), len(rows)
    prior = np.zeros((n, 4, 3))
    prior[:, 0] = first
    left = np.tile(np.eye(4) * wrls.forgetting**age / DELTA, (n, 1, 1))
    right = left @ prior
    for index, (p, weight, y) in enumerate(rows):
        factor = (wrls.forgetting ** (age - 1 - index) * weight)[:, None, None]
        left = left + factor * p[:, :, None] * p[:, None, :]
        right = right + factor * p[:, :, None] * y[:, None, :]
    return np.asarray(np.linalg.solve(left, right))


def effective_samples(frames: int, share: float) -> float:
    """How many independent frames have the variance of an exponential mean of so many.

    The first frame begins it: 1 / sum of squared weights.
    """
    weights = [(1 - share) ** (frames - 1)]
    weights += [share * (1 - share) ** age for age in range(frames - 1)]
    return 1 / float(np.sum(np.square(weights)))


def taa_weights(frames: int, least: float) -> Array:
    """The weight of each frame: the n-th gets 1 / n when it comes, but at least `least`."""
    weights = np.ones(1)
    for n in range(2, frames + 1):
        share = max(1 / n, least)
        weights = np.append((1 - share) * weights, share)
    return weights


def taa_shown(light: Array, counts: Array, history: Array, least: float, reach: Any) -> Array:
    """A picture (H, W, 4) of film and history; `reach` None: history is taken as it is."""
    known = np.asarray(history[..., :3], float)
    if reach is not None:
        around = ycocg(_windows(np.asarray(light, float)))
        middle, deviation = around.mean(axis=2), around.std(axis=2)
        off = ycocg(known) - middle
        over = np.abs(off) / np.maximum(reach * deviation, 1e-300)
        known = rgb(middle + off / np.maximum(over.max(axis=-1, keepdims=True), 1))
    with np.errstate(invalid="ignore"):
        share = np.maximum(counts / (history[..., 3] + counts), 1 - (1 - least) ** counts)
    share = np.where(history[..., 3] > 0, share, 1.0)
    shown = known + share[..., None] * (light - known)
    return np.dstack([shown, history[..., 3] + counts])


def ycocg(colors: Array) -> Array:
    """Luma, orange to blue, green to purple."""
    return np.asarray(colors @ np.linalg.inv(_RGB).T)


def rgb(colors: Array) -> Array:
    """The way back."""
    return np.asarray(colors @ _RGB.T)


_RGB = np.array([[1.0, 1.0, -1.0], [1.0, 0.0, 1.0], [1.0, -1.0, -1.0]])


def _windows(picture: Array) -> Array:
    """(H, W, 9, C): each pixel with those around it; the edge goes on."""
    height, width, _ = picture.shape
    padded = np.pad(picture, ((1, 1), (1, 1), (0, 0)), mode="edge")
    parts = [padded[j : j + height, i : i + width] for j in range(3) for i in range(3)]
    return np.stack(parts, axis=2)


def _length(x: Array) -> Array:
    return np.asarray(np.sqrt((x * x).sum(axis=1)))
