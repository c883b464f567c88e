"""Keeps the first half of a render as it passes by, for a denoiser that judges itself.

The film goes on as ever: half of its samples are told from a copy of it, and the rest follows from
the difference. Where a render ends is not always known, so copies are kept at each doubling too,
and of these the one nearest to the middle serves.
"""

from collections.abc import Callable
from dataclasses import replace

from glrt.core.errors import UsageError
from glrt.denoise.denoising import Denoised, denoise
from glrt.denoise.filters import LEAST
from glrt.denoise.half import Half
from glrt.image.halves import halves_of
from glrt.image.image import Image
from glrt.settings import Settings

Filtering = Callable[[tuple[Half, Half], str], Denoised | None]

KEPT = 3  # copies held at once: more than half as far as the render can be


class Halver:
    """The picture at some sample counts, while it is rendered on."""

    def __init__(self) -> None:
        """Nothing is kept yet."""
        self._kept: list[Image] = []

    def restart(self) -> None:
        """Forget everything."""
        self._kept.clear()

    def wants(self, settings: Settings, samples: int, target: int) -> bool:
        """Whether the picture is to be kept as it is now, on its way to `target` samples."""
        if (
            settings.denoise == "none"
            or samples >= target
            or samples != _next_whole(samples, settings.block)
        ):
            return False
        if any(kept.samples == samples for kept in self._kept):
            return False
        is_stop = samples in (_middle(settings, target), _doubled(settings, samples - 1))
        return is_stop or not self._kept

    def next_stop(self, settings: Settings, samples: int, target: int) -> int:
        """Up to which sample count to render before the picture is kept, `target` at most."""
        if settings.denoise == "none" or samples >= target:
            return target
        stops = [_middle(settings, target), _doubled(settings, samples), target]
        if not self._kept:
            stops.append(_next_whole(samples + 1, settings.block))
        return min(stop for stop in stops if stop > samples)

    def has_half(self, samples: int, block: int) -> bool:
        """Whether what is kept makes halves of a picture of so many samples."""
        return self._first_half(samples, block) is not None

    def keep(self, image: Image) -> None:
        """Keep the picture as it is now."""
        self._kept = [*self._kept, image][-KEPT:]

    def finished(self, image: Image, by: Filtering = denoise) -> Image:
        """The picture denoised if that is asked for, with the AOVs that are asked for alone.

        `by` filters; where it has no result the picture is not denoised.
        """
        assert image.recipe
        settings = image.recipe.settings
        if settings.denoise != "none":
            first = self._first_half(image.samples, settings.block)
            found = by(halves_of(first, image), settings.denoise) if first else None
            image = replace(image, denoising=found)
        return replace(image, sums=None, aovs={name: image.aovs[name] for name in settings.aov})

    def _first_half(self, samples: int, block: int) -> Image | None:
        """The kept picture nearest to the middle, with observations enough on either side."""
        least = LEAST * block
        fit = [k for k in self._kept if least <= k.samples <= samples - least]
        return min(fit, key=lambda kept: abs(2 * kept.samples - samples), default=None)


def check_rest(settings: Settings, begun: int) -> None:
    """UsageError where a picture of `begun` samples leaves too few of the settings' for a half."""
    needed = _next_whole(begun, settings.block) + LEAST * settings.block
    if settings.denoise != "none" and settings.samples < needed:
        raise UsageError(
            f"--denoise compares the samples to come with those that it has, {begun}: it needs "
            f"--samples {needed} at least"
        )


def _next_whole(samples: int, block: int) -> int:
    """The least sample count from `samples` on that makes a half of whole observations."""
    return max(LEAST * block, -(-samples // block) * block)


def _middle(settings: Settings, target: int) -> int:
    """Half of the samples, in whole observations."""
    return target // (2 * settings.block) * settings.block


def _doubled(settings: Settings, samples: int) -> int:
    """The first doubling of the least half that is more than `samples`."""
    doubled = LEAST * settings.block
    while doubled <= samples:
        doubled *= 2
    return doubled
