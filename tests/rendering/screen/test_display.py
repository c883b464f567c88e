"""The display pass on the driver, against the encoding of PNG files in numpy."""

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from tests.support.builders import glass, lamp, plane, scene_of, sphere

MATERIALS = {"glass": glass(), "lamp": lamp(6.0), "red": {"type": "lambertian", "color": [1, 0, 0]}}
OBJECTS = [
    sphere([-0.8, 0.5, -4], 1.0, "glass"),
    sphere([1.5, 2.0, -4], 0.5, "lamp"),
    plane([0, -1, 0], [0, 1, 0], "red"),
]


@pytest.mark.parametrize("tonemap", ["none", "aces", "agx", "neutral"])
@pytest.mark.parametrize("exposure", [-2.0, 0.0, 1.5])
def test_display_pass_shows_what_a_png_holds(
    context: Context, tonemap: str, exposure: float
) -> None:
    scene = scene_of(OBJECTS, MATERIALS, background={"bottom": [0, 0, 0], "top": [0.2, 0.4, 1]})
    size = {"width": 33, "height": 21, "samples": 4}
    settings = settings_for(scene.render, tonemap=tonemap, exposure=exposure, **size)
    renderer = Renderer(scene, settings, context)
    image = renderer.render().image()
    expected = expose_and_encode(image.radiance, exposure, renderer.settings.tonemap)
    assert len(np.unique(expected)) > 20, "the picture must tell up from down and left from right"
    difference = np.abs(renderer.display().astype(int) - expected.astype(int))
    assert difference.max() <= 1
    assert (difference > 0).mean() < 0.01
    renderer.release()
