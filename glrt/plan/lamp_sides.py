"""The share of a lamp's particles that leaves from each of its sides."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Array, Object
from glrt.scene.shapes.mesh import Mesh

Things = Mapping[type[Object], Sequence[Object]]
Rows = Mapping[type[Object], Array]  # one for each thing of a kind, in order

CLOSE = 2.5  # times the root of a lamp's area: nearer surfaces glow, and light the rest
MUCH = 2.0  # one side alone is close if the other has so many times its distance
MOST = 0.9  # share of a lamp's particles on its side that is close to something


def front_shares(scene: Scene, lamps: Sequence[Object]) -> list[float]:
    """Return for each lamp the share of its particles that leave its front, without aimed ones.

    Light that leaves into the open is found well by sampling the lamp, except for caustics, for
    which particles are aimed. Light that lands close to the lamp lights the rest of the scene from
    there, which paths from the camera find by chance alone. So most particles leave on the side
    that is close to something. Half leave on each side if neither or both are close, and all leave
    the front of a one-sided lamp.
    """
    things: dict[type[Object], list[Object]] = {}
    for thing in scene.visible:
        things.setdefault(type(thing), []).append(thing)
    rows = {kind: np.array([it.row for it in those], np.float64) for kind, those in things.items()}
    return [_front_share(lamp, things, rows) for lamp in lamps]


def _front_share(lamp: Object, things: Things, rows: Rows) -> float:
    body = lamp.lamp_body
    if body is None or not body.normal.any():
        return 0.5
    if lamp.is_one_sided:
        return 1.0
    normal, size = body.normal / np.linalg.norm(body.normal), math.sqrt(body.area / 2)
    front, back = (_room(lamp, things, rows, body.center, away) for away in (normal, -normal))
    if min(front, back) > CLOSE * size or max(front, back) < MUCH * min(front, back):
        return 0.5
    return MOST if front < back else 1 - MOST


def _room(lamp: Object, things: Things, rows: Rows, middle: Array, away: Array) -> float:
    """Return the distance from the middle of a side to the nearest surface; inf without one."""
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
