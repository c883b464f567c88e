"""Keeps the first half of a render as it passes by, for a denoiser that judges itself.

The film goes on as ever: half of its samples are told from a copy of it, and the rest follows from
the difference. Where a render ends is not always known, so copies are kept at each doubling too,
and of these the one nearest to the middle serves.
"""

from dataclasses import replace

from glrt.denoise.denoising import denoise
from glrt.denoise.filters import LEAST
from glrt.errors import UsageError
from glrt.image.halves import halves_of
from glrt.image.image import Image
from glrt.settings import Settings

KEPT = 3  # copies held at once: more than half as far as the render can be


class Halver:
    """The picture at some sample counts, while it is rendered on."""

    def __init__(self) -> None:
        """Nothing is kept yet."""
        self._kept: list[Image] = []

    def restart(self) -> None:
        """Forget everything."""
        self._kept.clear()

    def next_stop(self, settings: Settings, samples: int, target: int) -> int:
        """Up to which sample count to render before the picture is kept, `target` at most."""
        if settings.denoise == "none":
            return target
        doubled = LEAST * settings.block
        while doubled <= samples:
            doubled *= 2
        middle = target // (2 * settings.block) * settings.block
        stops = [middle, doubled, target]
        if not self._kept:
            stops.append(_next_whole(samples + 1, settings.block))
        return min(stop for stop in stops if stop > samples)

    def go_on(self, image: Image, settings: Settings) -> bool:
        """Whether a picture that a render goes on from is to be kept.

        UsageError where the rest of the samples would be too few for a half.
        """
        self.restart()
        if settings.denoise == "none":
            return False
        needed = _next_whole(image.samples, settings.block) + LEAST * settings.block
        if settings.samples < needed:
            raise UsageError(
                f"--denoise compares the samples to come with those that it has, "
                f"{image.samples}: it needs --samples {needed} at least"
            )
        return image.samples % settings.block == 0 and image.samples >= LEAST * settings.block

    def keep(self, image: Image) -> None:
        """Keep the picture as it is now."""
        self._kept = [*self._kept, image][-KEPT:]

    def finished(self, image: Image) -> Image:
        """The picture denoised if that is asked for, with the AOVs that are asked for alone."""
        assert image.recipe
        settings = image.recipe.settings
        if settings.denoise != "none":
            first = self._first_half(image.samples, settings.block)
            found = denoise(halves_of(first, image), settings.denoise) if first else None
            image = replace(image, denoising=found)
        return replace(image, aovs={name: image.aovs[name] for name in settings.aov})

    def _first_half(self, samples: int, block: int) -> Image | None:
        """The kept picture nearest to the middle, with observations enough on either side."""
        least = LEAST * block
        fit = [k for k in self._kept if least <= k.samples <= samples - least]
        return min(fit, key=lambda kept: abs(2 * kept.samples - samples), default=None)


def _next_whole(samples: int, block: int) -> int:
    """The least sample count from `samples` on that makes a half of whole observations."""
    return max(LEAST * block, -(-samples // block) * block)
