"""Every kind of lamp that is sampled has its branch wherever the shaders tell kinds apart.

The last branch of such a function takes what is left: without this test another kind of lamp would
be sampled as a quad.
"""

import re

from glrt.gpu.glsl import read
from glrt.plan.facts import SAMPLED

FILES = ("lights/sampling.glsl", "integrators/classic.glsl", "integrators/path.glsl")
TELLING = {
    "is_of_sphere",
    "is_of_disk",
    "point_lamp",
    "shade",
}  # functions that tell kinds of lamps apart


def functions() -> dict[str, str]:
    """The bodies of the functions of FILES, by name."""
    text = "".join(map(read, FILES))
    return dict(re.findall(r"^\w+ (\w+)\([^;]*?\) \{(.*?)^\}", text, re.MULTILINE | re.DOTALL))


def unnamed(kinds: tuple[str, ...]) -> set[str]:
    """Functions that name the flag of one kind of lamp, but not those of all `kinds`."""
    flags = [f"HAS_{kind.upper()}_LIGHT" for kind in kinds]
    bodies = {name: set(re.findall(r"HAS_\w+_LIGHT", b)) for name, b in functions().items()}
    return {name for name, found in bodies.items() if found and not found.issuperset(flags)}


def test_every_kind_of_lamp_is_named_where_kinds_are_distinguished() -> None:
    assert unnamed(SAMPLED) == set()


def test_a_kind_of_lamp_that_is_not_there_is_missed_everywhere() -> None:
    assert unnamed((*SAMPLED, "annulus")) == TELLING
