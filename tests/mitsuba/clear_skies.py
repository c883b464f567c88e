"""A program of its own: the radiance of Mitsuba's clear sky.

`python -m tests.mitsuba.clear_skies` reads a JSON list of cases from stdin, each with `turbidity`,
`albedo`, `towards` (the sun) and `directions`, and writes a list of lists of RGB.
"""

import json
import sys
from collections.abc import Sequence
from typing import Any

from tests.mitsuba.engine import load_mitsuba

SENSITIVITY = 106.7502593994140625  # what Mitsuba divides by: its own integral of the eye's, nm


def main() -> int:
    mi = load_mitsuba("scalar")
    json.dump([_radiances(mi, **case) for case in json.load(sys.stdin)], sys.stdout)
    return 0


def _radiances(
    mi: Any,
    turbidity: float,
    albedo: float,
    towards: Sequence[float],
    directions: Sequence[Sequence[float]],
) -> list[list[float]]:
    sky = mi.load_dict(
        {
            "type": "sunsky",
            "turbidity": turbidity,
            "albedo": {"type": "rgb", "value": [albedo] * 3},
            "sun_direction": _z_up(*towards),
            "sun_scale": 0.0,
        }
    )
    return [list(map(float, sky.eval(_leaving(mi, *each)))) for each in directions]


def _leaving(mi: Any, x: float, y: float, z: float) -> Any:
    """The interaction of a ray that leaves the scene."""
    found = mi.SurfaceInteraction3f()
    found.wi = -mi.Vector3f(*_z_up(x, y, z))
    return found


def _z_up(x: float, y: float, z: float) -> list[float]:
    return [x, -z, y]


if __name__ == "__main__":
    sys.exit(main())
