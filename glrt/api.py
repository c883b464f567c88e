"""`glrt.render`: a scene to a picture in one call; `glrt.paths`: the paths of one pixel of it."""

from collections.abc import Sequence
from typing import Unpack

from glrt.gpu.context import Choice, Context
from glrt.image.image import Image
from glrt.rendering.paths.replay import pixel_paths
from glrt.rendering.paths.values import PixelPaths
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import FrameOptions, settings_for


def render(
    scene: Scene,
    samples: int = 64,
    context: Context | Choice = "auto",
    part: tuple[int, int] | None = None,
    **settings: Unpack[FrameOptions],
) -> Image:
    """Render a scene; `settings` are fields of Settings, the rest comes from the scene.

    A `part` (k, n) renders the k-th of n parts of the samples, k from 1; `glrt.merge` puts parts
    together.

    Raises UsageError for a setting out of range, ContextError without OpenGL, RenderError, and
    SceneError for a scene beyond the driver.
    """
    renderer = Renderer(
        scene, context=context, tier="baked", part=part, samples=samples, **settings
    )
    try:
        return renderer.render().image()
    finally:
        renderer.release()


def paths(
    scene: Scene,
    pixel: tuple[int, int],
    samples: int = 64,
    numbers: Sequence[int] | None = None,
    context: Context | Choice = "auto",
    **settings: Unpack[FrameOptions],
) -> PixelPaths:
    """The paths of the samples of a pixel: of all, or of those with these `numbers`, from 0.

    `pixel` is its column and row in the full frame, from 0, row 0 on top. `settings` are fields of
    Settings, the rest comes from the scene. The paths are those that `render` traces with the same
    settings: their light adds up to its pixel, to the bit on software drivers. With caustics "on"
    `particles` of the result are those from lamps that reach the pixel, with the paths of 64.

    Raises UsageError for a pixel outside of the picture, a number beyond the samples or a lighting
    model before path tracing, ContextError without OpenGL 4.3, RenderError, and SceneError for a
    scene beyond the driver.
    """
    wanted = settings_for(scene.render, samples=samples, **settings)
    return pixel_paths(scene, wanted, pixel, numbers, context=context)
