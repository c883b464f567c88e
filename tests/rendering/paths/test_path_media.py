"""Replayed paths in media: they collide, scatter, and gather the light of lamps and of gas."""

from typing import Any

import pytest

from glrt.analysis.path_report import explanation
from glrt.gpu.context import Context
from tests.support.builders import quad
from tests.support.media import DUSK, ball, medium, with_fog
from tests.support.pixel_paths import assert_same_bits, camera_picture, replayed

GAS = medium(scattering=[2, 1, 0.5], absorption=0.2, emission=[0.1, 0.2, 0.3], g=0.4)
EYE: dict[str, Any] = {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 20}


@pytest.mark.slow
def test_lights_in_gas_add_up_to_the_pixel(context: Context) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    scene = with_fog(
        [ball(), quad([-0.5, 3, -0.5], [1, 0, 0], [0, 0, 1], "lamp")], GAS, EYE, background=DUSK
    )
    picture = camera_picture(scene, context)
    found = replayed(scene, (8, 8), context)
    assert_same_bits(found, picture(8, 8), "the middle")
    vertices = [vertex for path in found.paths for vertex in path.vertices]
    scattered = [it for it in vertices if it.event == "scattering in a medium"]
    assert scattered
    for it in scattered:
        assert (it.object, it.name, it.material) == (None, "fog", None)
        assert sum(x * x for x in it.position) < 1.0001
        assert it.pdf > 0
    lights = [light for path in found.paths for light in path.contributions]
    assert {it.source for it in lights} == {"object", "background", "medium"}
    assert {it.name for it in lights if it.source == "medium"} == {"fog"}
    glow = next(it for it in lights if it.source == "medium")
    alone = found.paths[0].model_copy(update={"contributions": (glow,), "radiance": glow.added})
    assert "from the medium fog" in explanation(alone)
