"""Every case of `glrt stress`, by name."""

from glrt.analysis.stress import (
    glass,
    lamps,
    particles,
    plastic,
    rays,
    rough_glass,
    sky,
    spots,
    sums,
    textures,
    triangles,
    views,
)
from glrt.analysis.stress.sweep import Case

_ALL = (
    Case("distance", "A distant sphere", rays.distance),
    Case("scale", "Large and small spheres", rays.scale),
    Case("offset", "A scene far from the origin", views.offset),
    Case("grazing", "A floor at grazing angles", rays.grazing),
    Case("edges", "Rays at the edge that two triangles share", triangles.edges),
    Case("leave", "Rays that leave a triangle", triangles.leave),
    Case("stretch", "Rays that leave a flattened mesh with a tree of its own", triangles.stretch),
    Case("fov", "Narrow and wide fields of view", views.fov),
    Case("ior", "Glass with an index near 1", glass.ior),
    Case("lamp", "A small lamp", lamps.lamp),
    Case("lamps", "Many lamps", lamps.lamps),
    Case("cone", "The edge of a spot", spots.cone),
    Case("spots", "Many spots", spots.spots),
    Case("ceiling", "A lamp just below a ceiling", lamps.ceiling),
    Case("bulb", "A small lamp inside a glass sphere", glass.bulb),
    Case("caustic", "A glass sphere and a small lamp", glass.caustic),
    Case("focus", "A caustic of a lamp of any size", particles.focused),
    Case("fireflies", "The brightest samples of a caustic", glass.fireflies),
    Case("sun", "A sun of one pixel in an image of the sky", sky.sun),
    Case("rough", "The light that rough glass keeps", rough_glass.furnace),
    Case("plastic", "The light that white plastic keeps", plastic.grazing),
    Case("frosted", "A lamp inside frosted glass", rough_glass.frosted),
    Case("layers", "Layers that are there in part", textures.layers),
    Case("bumps", "A normal bent by an image", textures.bumps),
    Case("far", "Texture coordinates far from the image", textures.far),
    Case("albedo", "Walls that hardly absorb", sums.albedo),
    Case("seeds", "Pixels that share random numbers", sums.seeds),
    Case("frames", "Many frames accumulated", sums.frames),
)
CASES = {case.name: case for case in _ALL}
