"""Views of a sample each, as a window that is never given time would show them."""

from collections.abc import Iterator, Sequence

from glrt.analysis.motion.playing import Picture, screen_of
from glrt.rendering.history.temporal import Temporal
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene


def views(renderer: Renderer, temporal: Temporal, scenes: Sequence[Scene]) -> Iterator[Picture]:
    """The picture shown of each scene, (H, W, 3); the renderer shows the first already."""
    for seed, scene in enumerate(scenes):
        if seed:
            temporal.leave(renderer)
            renderer.update(scene, seed=seed)
            temporal.arrive(renderer)
        renderer.step(1)
        yield screen_of(renderer, temporal)
