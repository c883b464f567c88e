"""Glass with dispersion: the noise of colors that take ways of their own."""

import numpy as np

from glrt.lab.glass import fresnel
from glrt.lab.scenes import glass, scene_of, sphere
from glrt.lab.sweep import Lab, Sweep
from glrt.rendering.shader_functions import World

IOR, DISPERSION = 1.6, 1.0
SLACK = 0.02  # of a variance: steps of the random number, and reflectances that differ by channel
_VERTEX = """
    Vertex vertex = vertex_of(frame_around(vec3(0.0, 0.0, 1.0)), wo, material_at(0), true);
    vertex.etas = etas_of(vertex, vec3(1.0));"""
_OURS = f"""{_VERTEX}
    vec3 weight = sample_dispersing(vertex, u).weight;"""
# Each path begins with one channel, of three times the light, whatever happens to it.
_EARLY = f"""{_VERTEX}
    int channel = min(int(3.0 * u), 2);
    vec3 weight = 3.0 * vec3(equal(ivec3(channel), ivec3(0, 1, 2)));"""


def prism(lab: Lab) -> Sweep:
    """Variance of a sample of white light that meets dispersing glass, the worst channel."""
    angles = np.array([1.0, 30.0, 60.0, 75.0, 80.0, 85.0, 88.0, 89.0, 89.9])
    count = lab.count(3 << 14, 3 << 12)
    materials = {"glass": {**glass(IOR), "dispersion": DISPERSION}}
    world = World(scene_of([sphere([0, 0, -3], 1, "glass")], materials))
    cosines = np.cos(np.radians(angles))
    spread: dict[str, list[float]] = {}
    for name, setup in {"glrt: when light crosses": _OURS, "at the camera": _EARLY}.items():
        spread[name] = []
        for cosine in cosines:
            given = {
                "u": (np.arange(count) + 0.5) / count,
                "wo": np.tile([np.sqrt(1 - cosine**2), 0.0, cosine], (count, 1)),
            }
            weights = lab.path("weight", given, world, returns="vec3", setup=setup)
            spread[name].append(float(weights.astype(np.float64).var(axis=0).max()))
    first, *others = spread.items()
    crossing = 1 - fresnel(cosines, np.full_like(cosines, 1 / IOR))
    return Sweep(
        parameter="angle of incidence (degrees)",
        measure="variance of a sample\n(of white light, largest)",
        x=angles.tolist(),
        chosen=first,
        others=dict(others),
        promise="at most twice the share that crosses",
        bound=(2 * crossing + SLACK).tolist(),
    )
