"""How many particles leave each side of a lamp that shines on both, or on one."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Array, Object, Sided
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.quad import Quad

Things = Mapping[type[Object], Sequence[Object]]
Rows = Mapping[type[Object], Array]  # of the things of each kind, in their order

CLOSE = 2.5  # times the size of a lamp, its root area: what is nearer glows, and lights the rest
MUCH = 2.0  # times as far, so that one side alone is close
MOST = 0.9  # of the particles of a lamp, on its side that is close to something


def front_shares(scene: Scene, lamps: Sequence[Object]) -> list[float]:
    """The share of the particles that leave the front of each lamp, of those that are not aimed.

    Light that leaves into the open is found well by sampling the lamp, but for what makes caustics,
    at which particles are aimed. Light that lands close to the lamp lights the rest of the scene
    from there, which paths from the camera find by chance alone. So most particles leave on that
    side. Half do where neither side is close to anything, or both are.
    """
    things: dict[type[Object], list[Object]] = {}
    for thing in scene.visible:
        things.setdefault(type(thing), []).append(thing)
    rows = {kind: np.array([it.row for it in those], np.float64) for kind, those in things.items()}
    return [_front_share(lamp, things, rows) for lamp in lamps]


def _front_share(lamp: Object, things: Things, rows: Rows) -> float:
    if not isinstance(lamp, Quad | Disk):
        return 0.5
    if lamp.is_one_sided:
        return 1.0
    middle, normal, size = _facing(lamp)
    front, back = (_room(lamp, things, rows, middle, away) for away in (normal, -normal))
    if min(front, back) > CLOSE * size or max(front, back) < MUCH * min(front, back):
        return 0.5
    return MOST if front < back else 1 - MOST


def _facing(lamp: Sided) -> tuple[Array, Array, float]:
    """Its middle, its unit normal (3,) and its size."""
    middle = np.array(lamp.middle, np.float64)
    if isinstance(lamp, Quad):
        across = np.cross(lamp.edge_u, lamp.edge_v)
        area = float(np.linalg.norm(across))
        return middle, across / area, math.sqrt(area)
    assert isinstance(lamp, Disk)
    normal = np.array(lamp.normal, np.float64)
    return middle, normal / np.linalg.norm(normal), lamp.radius * math.sqrt(math.pi)


def _room(lamp: Object, things: Things, rows: Rows, middle: Array, away: Array) -> float:
    """How far it is to what lies before the middle of a side; inf where nothing does."""
    nearest = math.inf
    for kind in sorted(rows, key=lambda kind: kind is Mesh):  # meshes last, if they are near enough
        with np.errstate(all="ignore"):
            found = kind.distances(rows[kind], middle, away)
        for number in np.flatnonzero(found < nearest).tolist():
            thing = things[kind][number]
            if thing is not lamp and found[number] < nearest:
                exact = thing.distance(middle, away) if isinstance(thing, Mesh) else found[number]
                nearest = min(nearest, exact)
    return float(nearest)
