"""`glrt.render` renders a scene in one call; `glrt.paths` returns the light paths of a pixel."""

from collections.abc import Sequence
from typing import Unpack

from glrt.gpu.context import Choice, Context
from glrt.image.image import Image
from glrt.rendering.paths.replay import Selection, pixel_paths
from glrt.rendering.paths.values import PixelPaths
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.setting_options import FrameOptions
from glrt.settings import settings_for


def render(
    scene: Scene,
    samples: int = 64,
    context: Context | Choice = "auto",
    part: tuple[int, int] | None = None,
    **settings: Unpack[FrameOptions],
) -> Image:
    """Render a scene and return the picture.

    With the shutter of the camera open, whatever the animation of the scene changes is blurred.
    `settings` are fields of Settings; the scene's `[render]` table supplies the others. A `part`
    (k, n) renders the k-th of n parts of the samples, with k from 1; `glrt.merge` joins the parts.

    Raises UsageError for a setting out of range, ContextError without OpenGL, RenderError if the
    driver fails, and SceneError for a scene beyond the limits of the driver.
    """
    renderer = Renderer(
        scene,
        context=context,
        tier="complete",
        part=part,
        opens_shutter=True,
        samples=samples,
        **settings,
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
    """Return the light paths that the samples of a pixel trace.

    `numbers` selects samples by number, from 0; the default is all. `pixel` is the column and row
    in the full frame, from 0, with row 0 on top. `settings` are fields of Settings; the scene's
    `[render]` table supplies the others. `render` traces the same paths with the same settings:
    their light adds up to its pixel, bit for bit on software drivers. With an open shutter, which
    `render` alone blurs, the paths are of the moment when it opens. With caustics "on",
    `particles` of the result holds the particles from lamps that reach the pixel, and the paths of
    the 64 brightest.

    Raises UsageError for a pixel outside the picture, a number beyond the samples, or a lighting
    model older than path tracing. Raises ContextError without OpenGL 4.3, RenderError if the driver
    fails, and SceneError for a scene beyond the limits of the driver.
    """
    wanted = settings_for(scene.render, samples=samples, **settings)
    return pixel_paths(scene, wanted, pixel, Selection(numbers), context)
