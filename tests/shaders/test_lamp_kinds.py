"""Every kind of lamp that is sampled is named wherever shaders distinguish kinds of lamps.

A shape of a kind that is missing in a function is no lamp there, so its light would be lost.
"""

import re
from pathlib import Path

from glrt.scene.shapes.kinds import SAMPLED
from tests.support.lamp_kinds import functions, unnamed

SHADERS = Path(__file__).parents[2] / "shaders_glsl"
ORDER = re.findall(
    r"^bool is_(\w+)_lamp\(", (SHADERS / "lights/kinds.glsl").read_text(), re.MULTILINE
)
DISTINGUISHING = {
    *("is_sampled", "pdf_light", "sample_point", "aspect_of", "point_lamp", "place_on"),
    "lamp_normal",
}


def test_every_kind_of_lamp_is_named_where_kinds_are_distinguished() -> None:
    assert unnamed(SAMPLED, SHADERS) == set()


def test_a_kind_without_code_is_missed_everywhere() -> None:
    assert unnamed((*SAMPLED, "no_such_kind"), SHADERS) == DISTINGUISHING


def test_kinds_are_asked_for_in_the_order_of_their_list() -> None:
    """A test that earlier kinds have decided is left out (lights/kinds.glsl)."""
    bodies = functions(SHADERS)
    for name in DISTINGUISHING:
        assert re.findall(r"is_(\w+)_lamp\(", bodies[name]) == ORDER, name
