"""Light: small lamps, many lamps, lamps behind glass, a lamp close to a ceiling."""

import numpy as np

from glrt.lab.stress.sweep import Lab, Sweep


def lamp(lab: Lab) -> Sweep:
    """The cone that a lamp fills, 1 - cos of its half angle: the density of sampling it."""
    x = np.logspace(-6, 0, 25)
    rows = lab.count(1 << 10)
    random = np.random.default_rng(2)
    distance = 10 ** random.uniform(-2, 2, (len(x), rows))
    radius = (0.999 * distance * x[:, None]).astype(np.float32).ravel()
    center = np.zeros((len(radius), 3), np.float32)
    center[:, 1] = distance.ravel()
    s2 = (radius / center[:, 1].astype(np.float64)) ** 2
    truth = s2 / (1 + np.sqrt(1 - s2))
    naive = "1.0 - sqrt(1.0 - radius * radius / dot(center, center))"
    found = [
        lab.path(what, {"center": center, "radius": radius})
        for what in ("cone_of_sphere(center, radius)", naive)
    ]
    ours, textbook = (np.abs(f / truth - 1).reshape(len(x), -1).max(axis=1) for f in found)
    return Sweep(
        parameter="radius of the lamp over its distance",
        measure="relative error of the light received\n(largest)",
        x=x.tolist(),
        chosen=("glrt: s² / (1 + sqrt(1 - s²))", ours.tolist()),
        others={"textbook: 1 - sqrt(1 - s²)": textbook.tolist()},
        promise="at most 1e-5, down to a radius of 1e-6 of the distance",
        bound=[1e-5] * len(x),
    )
