"""Scene files whose lamps must be refused."""

from tests.support.bad_scenes import BadScene, bad

_EMISSION = "emission = [8.0, 8.0, 8.0]"
_AXIS = "axis = [0, -1, 0], "


def _cone(name: str, keys: str, *says: str) -> BadScene:
    """The good scene with a cone of these keys at its lamp."""
    return bad(name, _EMISSION, f"{_EMISSION}\ncone = {keys}", *says)


BAD_LAMPS = [
    bad("glass that emits", "ior = 1.5", "ior = 1.5\nemission = [1, 1, 1]", "key 'emission'"),
    bad("a matte minus", "0.75]", "0.75]\nemission = [-1, 1, 1]", "white.emission[0] must be at"),
    _cone("a cone that is none", "30", "lamp.cone must be a table, got 30"),
    _cone("a cone without axis", "{ outer = 30 }", "lamp.cone.axis is missing", "points"),
    _cone("a cone of no axis", "{ axis = [0, 0, 0] }", "lamp.cone.axis must not be zero"),
    _cone("a key of no cone", f"{{ {_AXIS} angle = 3 }}", "'angle'", "axis, inner, outer"),
    _cone("a wide cone", f"{{ {_AXIS} outer = 181 }}", "cone.outer must be at most 180"),
    _cone("no cone", f"{{ {_AXIS} outer = 0 }}", "cone: outer must be at least 0.001 degrees"),
    _cone("a crossed cone", f"{{ {_AXIS} inner = 50 }}", "cone: inner is above outer"),
    bad(
        "a side of a ball", "radius = 0.35", 'radius = 1\nemission_side = "front"', "emission_side"
    ),
    bad("a third side", "edge_v", 'emission_side = "back"\nedge_v', "one of: both, front"),
    bad("a ball of the sky", "radius = 0.35", 'radius = 1\ngroup = "background"', "group must not"),
]
