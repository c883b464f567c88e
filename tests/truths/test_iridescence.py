"""Pictures of thin films, against their reflectance."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.materials.thin_film import ThinFilm
from tests.support.builders import plane, scene_of
from tests.support.renders import METHODS, rendered

COLOR = (0.9, 0.5, 0.2)


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_smooth_metal_under_a_film_shows_the_sky_by_the_reflectance_of_the_film(
    context: Context, method: str
) -> None:
    """A plane seen at 60 degrees to its normal: one path for all samples."""
    film = {"iridescence": 0.5, "iridescence_ior": 1.6, "iridescence_thickness": 300.0}
    metal: dict[str, Any] = {"type": "principled", "color": list(COLOR), "metallic": 1.0}
    materials = {"p": {**metal, "roughness": 0.0, **film}}
    eye = {"position": [0, 1, 3**0.5], "look_at": [0, 0, 0], "fov": 0.01}
    floor, sky = plane([0, 0, 0], [0, 1, 0], "p"), {"color": [1.0, 1.0, 1.0]}
    scene = scene_of([floor], materials, eye, background=sky)
    image = rendered(scene, context, 16, method=method)
    wavy = ThinFilm(1.6, 300.0).reflectance(COLOR, np.array([0.5]))[0]
    plain = np.array(COLOR) + (1 - np.array(COLOR)) * 0.5**5
    expected = 0.5 * (wavy + plain)
    assert_allclose(image.radiance, np.broadcast_to(expected, image.radiance.shape), rtol=2e-4)
