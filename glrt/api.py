"""`glrt.render`: a scene to a picture in one call."""

from typing import Unpack

from glrt.gpu.context import Choice, Context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import FrameOptions


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
