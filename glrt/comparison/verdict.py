"""Whether two renders show the same picture up to their noise."""

import math
from collections.abc import Mapping
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from glrt.comparison.noise import ROUNDING, Pair, Sums, even_weights
from glrt.comparison.own_numbers import independent
from glrt.comparison.regions import Array, blocks, edges, whole
from glrt.comparison.result import (
    CHANNELS,
    Comparison,
    HeavyTails,
    Interval,
    Place,
    Verdict,
    percent,
)
from glrt.comparison.sensitivity import sensitivity
from glrt.core.errors import UsageError
from glrt.error.estimate import sidak_threshold
from glrt.image.image import Image
from glrt.plan.methods import traits_of

Flags = NDArray[np.bool_]

LEAST = 1e-9  # least values of alpha and bias
HEAVY = 0.5  # share of noise in pixels that met rare light: above it, errors are not believed
SLACK = 1.1  # the standard errors of another renderer may be a tenth off: the spread allows it
ITS_NOISE = ("method", "roulette", "sampler", "caustics")  # settings that decide on the noise
OF_PARTICLES = ("particles", "aimed", "linked")  # the same for particles, if there are any


def compare(
    image: Image,
    reference: Image,
    alpha: float = 0.01,
    bias: float = 0.01,
    alike: bool | None = None,
    groups: Mapping[str, Image] | None = None,
) -> Comparison:
    """Decide whether two renders of one size are the same picture up to their noise.

    Equal pictures are called different with probability `alpha` at most. "same" means that a change
    of all light by `bias` would have been found, and of each light group's; otherwise the verdict
    is "undecided". Each picture needs its number of samples, and one of them its standard errors.
    `alike`: both draw their samples in the same way; by default, the recipes say so. `groups`: for
    each light group, a picture of the same size by its light alone; without them, groups are not
    judged. Raises `UsageError` for pictures that cannot be compared.
    """
    for name, value in (("alpha", alpha), ("bias", bias)):
        if not LEAST <= value < 1:
            raise UsageError(f"{name} must lie between {LEAST:g} and 1, got {value:g}.")
    _check(image, reference)
    image, reference = independent(image), independent(reference)
    broken = _is_broken(image) | _is_broken(reference)
    lights = {name: _light(image, name, picture) for name, picture in (groups or {}).items()}
    pair = _pair(image, reference, broken, alike)
    return _compared(pair, broken, lights, alpha, bias)


def _is_broken(image: Image) -> Flags:
    """Values that cannot be compared. NaN is allowed in an error: the error is unknown."""
    return ~np.isfinite(image.radiance) | np.isinf(image.stderr)


def _check(image: Image, reference: Image) -> None:
    sizes = [f"{i.radiance.shape[1]} x {i.radiance.shape[0]}" for i in (image, reference)]
    if sizes[0] != sizes[1]:
        raise UsageError(f"the pictures differ in size: {sizes[0]} and {sizes[1]} pixels.")
    if not image.radiance.size:
        raise UsageError("the pictures have no pixels.")
    for name, picture in (("image", image), ("reference", reference)):
        if picture.samples < 1:
            raise UsageError(
                f"the {name} does not say how many samples a pixel it has: give them by --samples "
                "for the image and --reference-samples for the reference."
            )
        settings = picture.recipe.settings if picture.recipe else None
        if settings and traits_of(settings).has_probes:
            raise UsageError(
                f"the {name} was rendered by {settings.method}, whose pixels share the noise of "
                "their probes: glrt compare takes the noise of pixels for independent, and would "
                "call equal pictures different. Compare pictures of another method, such as mis."
            )


def _light(image: Image, group: str, picture: Image) -> Array:
    if picture.radiance.shape != image.radiance.shape:
        raise UsageError(f"the picture of light group {group!r} has another size.")
    return np.where(np.isfinite(picture.radiance), picture.radiance.astype(np.float64), 0)


def _pair(image: Image, reference: Image, broken: Flags, alike: bool | None) -> Pair:
    a, b = (np.where(broken, 0, i.radiance.astype(np.float64)) for i in (image, reference))
    va, vb = (np.where(broken, 0, np.square(i.stderr, dtype=float)) for i in (image, reference))
    if (np.isnan(va) & np.isnan(vb)).any():
        raise UsageError(
            "neither picture has standard errors: one of them must be an .exr of glrt, of at least "
            "32 samples, or 2 with --sampler independent."
        )
    if alike is None:
        known = not (np.isnan(va) | np.isnan(vb)).any()
        alike = known and _same_method(image, reference)
    alike = alike and not (np.ptp(image.counts) or np.ptp(reference.counts))
    # The variance of a picture without standard errors: the other's for its number of samples, or
    # the squared difference less the other's, whichever is more.
    ratio, square = image.samples / reference.samples, np.square(a - b)
    filled = (
        np.where(np.isnan(va), np.maximum(vb / ratio, square - vb), va),
        np.where(np.isnan(vb), np.maximum(va * ratio, square - va), vb),
    )
    return Pair(a, b, *filled, image.samples, reference.samples, alike, _block(image, reference))


def _block(image: Image, reference: Image) -> float:
    """Samples of an observation that chance deals out."""
    blocks = {i.recipe.settings.block if i.recipe else 1 for i in (image, reference)}
    return blocks.pop() if len(blocks) == 1 else 1


def _same_method(image: Image, reference: Image) -> bool:
    if not (image.recipe and reference.recipe):
        return False
    a, b = image.recipe.settings, reference.recipe.settings
    names = ITS_NOISE + (OF_PARTICLES if a.caustics == "on" else ())
    return all(getattr(a, name) == getattr(b, name) for name in names)


def _compared(
    pair: Pair, broken: Flags, groups: Mapping[str, Array], alpha: float, bias: float
) -> Comparison:
    """Compare a pair; the whole, the blocks and pixels without noise get a third of alpha each."""
    means, local = Sums(pair, whole), Sums(pair, blocks)
    factors = Sums(pair, whole, even_weights(pair)) if pair.alike else None
    limit = _limit(alpha / 3, local.score.size)
    wide = _limit(alpha / 3, 9 if factors else 6)  # means, spread and factors of three channels
    reasons = [
        _broken(broken),
        _quiet(pair, alpha / 3),
        _whole("the means differ", means, wide),
        _whole("the means of quiet blocks differ", factors, wide),
        _scatter(local.score, wide),
        _blocks(local.score, limit),
    ]
    found = tuple(reason for reason in reasons if reason)
    whole_tests = [(sums, wide) for sums in (means, factors) if sums]
    found_at = sensitivity(pair, [*whole_tests, (local, limit)], groups)
    rare = _heavy_tails(pair)
    agree: Verdict = "same" if found_at.worst <= bias and not rare else "undecided"
    pixel_scores = _pixel_scores(pair)
    worst = _worst_block(local.score, pair.image.shape)
    return Comparison(
        verdict="different" if found else agree,
        reasons=found,
        alpha=alpha,
        bias=bias,
        means=_means(pair),
        differences=_intervals(means, wide),
        factors=_intervals(factors, wide) if factors else (),
        spread=float(np.sqrt(np.square(local.score).mean())),
        limit=limit,
        largest=float(local.score.flat[np.abs(local.score).argmax()]),
        worst=worst,
        pixel=_worst_pixel(pixel_scores, worst),
        sensitivity=found_at,
        heavy_tails=rare,
        needs=None if rare else _needs(pair, found_at.worst / bias),
        alike=pair.alike,
        block_scores=local.score,
        pixel_scores=pixel_scores,
    )


def _heavy_tails(pair: Pair) -> HeavyTails | None:
    """The picture with more rare light in its noise; None up to HEAVY, or for the same method."""
    if pair.alike:
        return None
    found = [
        _rare_share("image", pair.image_variance, pair.image_rare),
        _rare_share("reference", pair.reference_variance, pair.reference_rare),
    ]
    worse = max(found, key=lambda tails: tails.share)
    return worse if worse.share > HEAVY else None


def _rare_share(name: str, variance: Array, rare: Array) -> HeavyTails:
    totals = np.maximum(variance.sum(axis=(0, 1)), 1e-300)
    share = float((rare.sum(axis=(0, 1)) / totals).max())
    return HeavyTails(name, int((rare > 0).any(axis=-1).sum()), share)


def _limit(alpha: float, tests: int) -> float:
    """The score that, with probability alpha, chance exceeds in one of `tests` two-sided tests."""
    return -NormalDist().inv_cdf(sidak_threshold(alpha, tests) / 2)


def _broken(broken: Flags) -> str | None:
    return f"NaN or infinite: {_some(broken)}" if broken.any() else None


def _quiet(pair: Pair, alpha: float) -> str | None:
    """The reason if pixels without noise differ by more than rounding; else None."""
    variance = pair.image_variance + pair.reference_variance
    quiet = variance <= np.square(np.finfo(np.float32).eps * pair.size)
    wrong = quiet & (np.abs(pair.difference) > ROUNDING * pair.size)
    if not wrong.any() or not _enough_samples(pair, int(quiet.sum()), alpha):
        return None
    return f"pixels without noise differ: {_some(wrong)}"


def _enough_samples(pair: Pair, pixels: int, alpha: float) -> bool:
    """Whether chance rarely deals out two values so that each picture sees only one of them."""
    a, b = pair.image_samples / pair.block, pair.reference_samples / pair.block
    log_ways = math.lgamma(a + b + 1) - math.lgamma(a + 1) - math.lgamma(b + 1)
    return math.log(2 * pixels / alpha) < log_ways


def _whole(what: str, sums: Sums | None, limit: float) -> str | None:
    if sums is None or np.abs(sums.score).max() <= limit:
        return None
    channel = int(np.abs(sums.score).argmax())
    difference = percent(_intervals(sums, limit)[channel].difference, sign="+")
    return f"{what}, {CHANNELS[channel]} by {difference}"


def _scatter(score: Array, limit: float) -> str | None:
    """Test the sum of squares against chi-squared, by the cube root of Wilson and Hilferty."""
    ratio = np.square(score / SLACK).mean(axis=(0, 1)).max()
    narrow = 2 / (9 * score[..., 0].size)
    if (np.cbrt(ratio) - 1 + narrow) / math.sqrt(narrow) <= limit:
        return None
    return f"blocks scatter {math.sqrt(ratio) * SLACK:.2f} times as much as their noise"


def _blocks(score: Array, limit: float) -> str | None:
    wrong = int((np.abs(score) > limit).any(axis=-1).sum())
    return f"{wrong} of {score[..., 0].size} blocks differ" if wrong else None


def _intervals(sums: Sums, limit: float) -> tuple[Interval, ...]:
    reach = sums.reach(limit)
    rows = np.stack([sums.difference, sums.difference - reach, sums.difference + reach])
    with np.errstate(divide="ignore", invalid="ignore"):
        return tuple(Interval(*column) for column in (rows / np.abs(sums.reference)).T.tolist())


def _means(pair: Pair) -> tuple[tuple[float, float], ...]:
    means = [picture.mean(axis=(0, 1)).tolist() for picture in (pair.image, pair.reference)]
    return tuple(zip(*means, strict=True))


def _needs(pair: Pair, ratio: float) -> int | None:
    """Samples that would find `bias`, to two digits; noise falls as the root of the samples."""
    if not math.isfinite(ratio):
        return None
    per_sample = 1 / pair.image_samples + 1 / pair.reference_samples
    samples = max(2 / per_sample * ratio * ratio, 1.0)
    step = int(10 ** max(math.floor(math.log10(samples)) - 1, 0))
    return math.ceil(samples / step) * step


def _pixel_scores(pair: Pair) -> Array:
    variance = pair.shuffled_variance
    scores = np.zeros_like(variance)
    return np.divide(pair.difference, np.sqrt(variance), where=variance > 0, out=scores)


def _worst_block(score: Array, shape: tuple[int, ...]) -> Place:
    row, column, channel = map(int, np.unravel_index(np.abs(score).argmax(), score.shape))
    top, bottom = map(int, edges(shape[0])[row : row + 2])
    left, right = map(int, edges(shape[1])[column : column + 2])
    return Place(CHANNELS[channel], left, top, right - left, bottom - top)


def _worst_pixel(scores: Array, block: Place) -> Place:
    part = scores[block.y : block.y + block.height, block.x : block.x + block.width]
    part = np.abs(part[..., CHANNELS.index(block.channel)])
    row, column = map(int, np.unravel_index(part.argmax(), part.shape))
    return Place(block.channel, block.x + column, block.y + row)


def _some(flags: Flags) -> str:
    """How many pixels are flagged, and where the first one is."""
    row, column, channel = map(int, np.argwhere(flags)[0])
    count = int(flags.any(axis=-1).sum())
    return f"{count} pixels, the first {Place(CHANNELS[channel], column, row)}"
