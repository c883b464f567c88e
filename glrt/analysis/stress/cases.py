"""Every case of `glrt stress`, by name."""

from glrt.analysis.stress import glass, lamps, rays, sums, views
from glrt.analysis.stress.sweep import Case

_ALL = (
    Case("distance", "A sphere seen from afar", rays.distance),
    Case("scale", "Large and small spheres", rays.scale),
    Case("offset", "Far from the origin", views.offset),
    Case("grazing", "A floor at a flat angle", rays.grazing),
    Case("fov", "Narrow and wide fields of view", views.fov),
    Case("ior", "Glass that hardly refracts", glass.ior),
    Case("lamp", "A small lamp", lamps.lamp),
    Case("lamps", "Many lamps", lamps.lamps),
    Case("ceiling", "A lamp close below a ceiling", lamps.ceiling),
    Case("bulb", "A small lamp in a ball of glass", glass.bulb),
    Case("caustic", "A glass ball and a small lamp", glass.caustic),
    Case("fireflies", "The brightest samples of a caustic", glass.fireflies),
    Case("albedo", "Walls that hardly absorb", sums.albedo),
    Case("seeds", "Pixels that share random numbers", sums.seeds),
    Case("frames", "Many frames accumulated", sums.frames),
)
CASES = {case.name: case for case in _ALL}
