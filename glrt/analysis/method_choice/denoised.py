"""Whether fewer samples reach an error once they are denoised, for `inspect --error`.

Method and bounces are the chosen ones, on a larger frame than that of their measurement: a filter
blurs edges, so its gain grows with the size of the picture.
"""

import math
from typing import Any, NamedTuple

from glrt.analysis.method_choice.candidate import Candidate
from glrt.denoise.filters import least_samples
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

MOST_PIXELS = 192  # of either edge of the frame
WORTH = 2  # times fewer samples than a plain picture takes, at least


class DenoisedChoice(NamedTuple):
    """A denoised picture whose error is surely below a given one."""

    by: str
    samples: int
    error: float  # including what the limit of bounces leaves out
    high: float  # upper limit of the error in 95 of 100 cases
    size: tuple[int, int]  # of the frame on which it was measured


def denoised_choice(
    scene: Scene, chosen: Candidate, error: float, context: Context
) -> DenoisedChoice | None:
    """The fewest samples, of doublings, that reach the error denoised; or None.

    None also if more than half of the samples of a plain picture are needed.
    """
    plain, bias = chosen.samples_to(error) or 0, chosen.bias
    samples = least_samples(chosen.settings.block)
    if WORTH * samples > plain:
        return None
    renderer = Renderer(scene, _on_small_frame(chosen.settings, plain), context)
    try:
        while WORTH * samples <= plain:
            found = renderer.render(samples).image().denoising
            assert found
            high = math.hypot(found.error_high, bias.most)
            if high <= error:
                by, told = renderer.settings.denoise, math.hypot(found.error, bias.value)
                return DenoisedChoice(by, samples, told, high, renderer.size)
            samples *= 2
    finally:
        renderer.release()
    return None


def _on_small_frame(settings: Settings, samples: int) -> Settings:
    """Settings for the whole picture with fewer pixels, denoised."""
    scale = min(1.0, MOST_PIXELS / max(settings.size))
    width, height = (max(1, round(scale * side)) for side in settings.size)
    own: dict[str, Any] = {"width": width, "height": height, "samples": samples, "crop": None}
    return settings_for(settings, **own, denoise="auto", aov=())
