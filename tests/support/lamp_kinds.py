"""Which functions of the shaders distinguish kinds of lamps, and kinds that they do not name."""

import re
from collections.abc import Collection
from pathlib import Path

FILES = (
    "lights/sampling.glsl",
    "lights/particle_emission.glsl",
    "integrators/point_lamps.glsl",
    "integrators/particle_start.glsl",
    "paths.comp",
)
ROUND_OR_FLAT = {"start_particle"}  # asks whether a lamp is a sphere, and nothing else


def functions(shaders: Path) -> dict[str, str]:
    """The bodies of the functions of FILES in a folder of shaders, by name."""
    text = "".join((shaders / file).read_text() for file in FILES)
    return dict(re.findall(r"^\w+ (\w+)\([^;]*?\) \{(.*?)^\}", text, re.MULTILINE | re.DOTALL))


def unnamed(kinds: Collection[str], shaders: Path) -> set[str]:
    """Functions that name one kind of lamp, but not all `kinds`."""
    names = {"triangle" if kind == "mesh" else kind for kind in kinds}
    bodies = {n: set(re.findall(r"is_(\w+)_lamp\(", b)) for n, b in functions(shaders).items()}
    found = {name for name, named in bodies.items() if named and not named.issuperset(names)}
    return found - ROUND_OR_FLAT
