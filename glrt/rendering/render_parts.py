"""Render a picture that was merged from parts again: part by part, to the same bits."""

from collections.abc import Callable

from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.image.partition import Partition
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption, Limits, render_to_limit


def render_parts(
    renderer: Renderer,
    partition: Partition,
    interruption: Interruption,
    watch: Callable[[Renderer], None] | None = None,
) -> Image | None:
    """Render and merge all parts; if interrupted, the complete ones, or None if there are none."""
    whole = []
    for number in partition.numbers:
        renderer.begin_part(number)
        image = render_to_limit(renderer, Limits(renderer.wanted_samples), interruption, watch)
        if not image or image.samples < renderer.wanted_samples:
            break
        whole.append(image)
    return merge(whole, incomplete=True) if whole else None
