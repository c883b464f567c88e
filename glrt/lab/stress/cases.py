"""Every case of `glrt stress`, by name."""

from glrt.lab.stress import lamps, rays, sums
from glrt.lab.stress.sweep import Case

_ALL = (
    Case("distance", "A sphere seen from afar", rays.distance),
    Case("lamp", "A small lamp", lamps.lamp),
    Case("frames", "Many frames accumulated", sums.frames),
)
CASES = {case.name: case for case in _ALL}
