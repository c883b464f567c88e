"""Where rays meet shapes: from afar, at every scale, far from the origin, along a floor."""

import numpy as np

from glrt.lab.stress.sweep import Array, Lab, Sweep

RAY = "Ray(origin, direction, NO_SHAPE, false)"
TEXTBOOK = """
float textbook(vec3 origin, vec3 direction, vec3 center, float radius) {
    vec3 to_center = center - origin;
    float b = dot(to_center, direction);
    float c = dot(to_center, to_center) - radius * radius;
    float discriminant = b * b - c;
    if (discriminant < 0.0) return 0.0;
    float t = b - sqrt(discriminant);
    return t > 0.0 ? t : b + sqrt(discriminant);
}"""


def distance(lab: Lab) -> Sweep:
    """Rays that pass a sphere within 0.9 of its radius; a miss counts as an error of 1."""
    x = np.logspace(0.25, 6, 24)
    rays = aimed(np.repeat(x, lab.count(1 << 14)))
    truth = nearest_root(rays)
    ours = lab.path(f"sphere_distance({RAY}, Sphere(center, radius, 0, -1), 0)", rays)
    naive = lab.path("textbook(origin, direction, center, radius)", rays, functions=TEXTBOOK)
    errors = [quantile(np.abs(t / truth - 1), len(x)) for t in (ours, naive)]
    return Sweep(
        parameter="distance of the sphere, in radii",
        measure="relative error of the distance hit\n(of 99 in 100 rays)",
        x=x.tolist(),
        chosen=("glrt: keeps r² (Haines et al. 2019)", errors[0]),
        others={"textbook: b² - c": errors[1]},
        promise="at most 2e-6 from up to 1e5 radii away",
        bound=[2e-6] * len(x),
        guaranteed=(x <= 1e5).tolist(),
    )


def aimed(distances: Array, most_beside: float = 0.9) -> dict[str, Array]:
    """Rays at spheres so many radii away, float32; radii from 1e-3 to 1e3."""
    random = np.random.default_rng(1)
    rows = len(distances)
    axis, other = random.normal(size=(2, rows, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    other = np.cross(axis, other)
    other /= np.linalg.norm(other, axis=1, keepdims=True)
    beside = random.uniform(0, most_beside, (rows, 1))
    radius = 10 ** random.uniform(-3, 3, rows)
    origin = random.uniform(-1, 1, (rows, 3)) * radius[:, None]
    center = origin + (axis * distances[:, None] + other * beside) * radius[:, None]
    given = {"center": center, "radius": radius, "origin": origin, "direction": axis}
    return {name: values.astype(np.float32) for name, values in given.items()}


def nearest_root(rays: dict[str, Array]) -> Array:
    """The distance at which each ray enters its sphere, of the float32 inputs in float64."""
    center, radius, origin, direction = (
        rays[name].astype(np.float64) for name in ("center", "radius", "origin", "direction")
    )
    norm = np.linalg.norm(direction, axis=1)
    to_center = center - origin
    along = (to_center * direction).sum(axis=1) / norm
    beside2 = np.square(
        np.linalg.norm(to_center - along[:, None] * direction / norm[:, None], axis=1)
    )
    root: Array = (along - np.sqrt(radius**2 - beside2)) / norm
    return root


def quantile(errors: Array, rows: int, share: float = 0.99) -> list[float]:
    """Of each of `rows` equal portions, what so large a share of its errors does not exceed."""
    found: list[float] = np.quantile(errors.reshape(rows, -1), share, axis=1).tolist()
    return found
