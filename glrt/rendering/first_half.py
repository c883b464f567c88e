"""Keep the first half of a render on the way, for a denoiser that estimates its own error.

The render itself does not change. A copy of the film holds the first half of the samples; the
difference to the final film gives the second half. The end of a render is not always known. So
copies are also kept at each doubling of the samples, and the one nearest to the middle is used.
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

KEPT = 3  # the newest copies that are held: one of them is near the middle


class Halver:
    """Keeps copies of a picture at some sample counts while its render goes on."""

    def __init__(self) -> None:
        """Begin without copies."""
        self._kept: list[Image] = []

    def restart(self) -> None:
        """Discard all copies."""
        self._kept.clear()

    def wants(self, settings: Settings, samples: int, target: int) -> bool:
        """Whether to keep a copy at `samples` per pixel, on the way to `target`."""
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
        """The sample count at which to keep the next copy; at most `target`."""
        if settings.denoise == "none" or samples >= target:
            return target
        stops = [_middle(settings, target), _doubled(settings, samples), target]
        if not self._kept:
            stops.append(_next_whole(samples + 1, settings.block))
        return min(stop for stop in stops if stop > samples)

    def has_half(self, samples: int, block: int) -> bool:
        """Whether a kept copy splits a picture of `samples` per pixel into two usable halves."""
        return self._first_half(samples, block) is not None

    def keep(self, image: Image) -> None:
        """Keep a copy; only the newest KEPT copies are held."""
        self._kept = [*self._kept, image][-KEPT:]

    def finished(self, image: Image, by: Filtering = denoise) -> Image:
        """The final picture: denoised if the settings ask for it, with the requested AOVs alone.

        `by` filters the two halves. The picture is not denoised if `by` returns None, or if no kept
        copy makes two halves.
        """
        assert image.recipe
        settings = image.recipe.settings
        if settings.denoise != "none":
            first = self._first_half(image.samples, settings.block)
            found = by(halves_of(first, image), settings.denoise) if first else None
            image = replace(image, denoising=found)
        return replace(image, sums=None, aovs={name: image.aovs[name] for name in settings.kept})

    def _first_half(self, samples: int, block: int) -> Image | None:
        """The copy nearest to the middle of `samples`, with enough observations in both halves."""
        least = LEAST * block
        fit = [k for k in self._kept if least <= k.samples <= samples - least]
        return min(fit, key=lambda kept: abs(2 * kept.samples - samples), default=None)


def check_rest(settings: Settings, begun: int) -> None:
    """Raise UsageError if too few samples follow a resumed picture of `begun` to denoise it."""
    needed = _next_whole(begun, settings.block) + LEAST * settings.block
    if settings.denoise != "none" and settings.samples < needed:
        raise UsageError(
            f"--denoise compares new samples with the {begun} that are there: it needs "
            f"--samples {needed} at least"
        )


def _next_whole(samples: int, block: int) -> int:
    """The smallest count of at least `samples` that makes a half of complete observations."""
    return max(LEAST * block, -(-samples // block) * block)


def _middle(settings: Settings, target: int) -> int:
    """Half of `target`, rounded down to complete observations."""
    return target // (2 * settings.block) * settings.block


def _doubled(settings: Settings, samples: int) -> int:
    """The smallest half, doubled until it is more than `samples`."""
    doubled = LEAST * settings.block
    while doubled <= samples:
        doubled *= 2
    return doubled
