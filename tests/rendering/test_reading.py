"""Single pixels read from a film, against the whole picture."""

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.plan.plan import Layering
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import with_lights
from tests.support.mixed_scene import everything


@pytest.mark.parametrize("layering", ["none", "groups"])
def test_each_pixel_is_read_as_it_is_in_the_picture(context: Context, layering: Layering) -> None:
    sizes = {"width": 7, "height": 5, "bounces": 2, "samples": 40}
    scene = everything()
    renderer = Renderer(scene, None, context, layering=layering, **sizes)  # type: ignore[arg-type]
    renderer.render()
    if layering == "groups":
        group = next(iter(scene.light_groups))
        renderer.update(with_lights(scene, {group: 0.5}), layering)
        assert renderer.samples == 40
    weights = renderer.plan.weights
    image = renderer.image(weights)
    with context.gl:
        for y in range(5):
            for x in range(7):
                found = renderer.reading(weights, x, y)
                assert np.array_equal(found.radiance, image.radiance[y, x])
                assert np.array_equal(found.stderr, image.stderr[y, x], equal_nan=True)
                assert found.samples == 40
    renderer.release()
