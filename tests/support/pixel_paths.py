"""Paths of pixels for tests, traced in the context of the session."""

from typing import Any

import numpy as np

from glrt.gpu.context import Context
from glrt.rendering.paths.replay import Selection, pixel_paths
from glrt.rendering.paths.values import Path, PixelPaths
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import settings_for

SMALL: dict[str, Any] = {"width": 16, "height": 16, "samples": 18}


def replayed(
    scene: Scene,
    pixel: tuple[int, int],
    context: Context,
    tier: Tier = "complete",
    numbers: list[int] | None = None,
    **settings: Any,
) -> PixelPaths:
    """All paths of a pixel of a small picture, or those with these numbers."""
    wanted = settings_for(scene.render, **{**SMALL, **settings})
    return pixel_paths(scene, wanted, pixel, Selection(numbers), context, tier)


def camera_picture(scene: Scene, context: Context, tier: Tier = "complete", **settings: Any) -> Any:
    """A render, by (x, y) of the full frame, (3,) float32; without particles, if it has some."""
    renderer = Renderer(scene, context=context, tier=tier, **{**SMALL, **settings})
    image = renderer.render().image()
    left, top = (renderer.settings.crop or (0, 0))[:2]
    renderer.release()
    mean = image.particles.camera if image.particles else image.radiance
    return lambda x, y: mean[y - top, x - left]


def summed(path: Path) -> Any:
    """The sum of the lights of a path, in float32 and in their order."""
    total = np.zeros(3, np.float32)
    for light in path.contributions:
        total = total + np.array(light.added, np.float32)
    return total


def assert_same_bits(found: PixelPaths, mean: Any, what: str) -> None:
    """The lights of each path add up to its sample, and the samples to the pixel."""
    for path in found.paths:
        radiance = found.radiances[path.sample]
        assert np.array(path.radiance, np.float32).tobytes() == radiance.tobytes(), (
            what,
            path.sample,
        )
        assert (summed(path) == radiance).all(), (what, path.sample, summed(path), radiance)
    assert (found.mean == mean).all(), (what, found.mean, mean)
