"""Intersections of rays: with distant shapes, at every scale, at grazing angles."""

import numpy as np

from glrt.lab.sweep import Array, Lab, Sweep

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
    """Error of the distance to a sphere, passed at up to 0.9 of its radius; a miss counts as 1."""
    x = np.logspace(0.25, 6, 24)
    rays = aimed(np.repeat(x, lab.count(1 << 14)))
    truth = nearest_root(rays)
    ours = lab.path(f"sphere_distance({RAY}, Sphere(center, radius, 0, -1), 0)", rays)
    naive = lab.path("textbook(origin, direction, center, radius)", rays, functions=TEXTBOOK)
    errors = [quantile(np.abs(t / truth - 1), len(x)) for t in (ours, naive)]
    return Sweep(
        parameter="distance of the sphere, in radii",
        measure="relative error of the distance hit\n(99 % quantile)",
        x=x.tolist(),
        chosen=("glrt: keeps r² (Haines et al. 2019)", errors[0]),
        others={"textbook: b² - c": errors[1]},
        promise="at most 2e-6 up to a distance of 1e5 radii",
        bound=[2e-6] * len(x),
        guaranteed=(x <= 1e5).tolist(),
    )


LEAVING = """
    vec3 n = normalized(normal);
    vec3 position = center + radius * n;
    float side = inward == 1 ? -1.0 : 1.0;
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    vec3 local = vec3(sine * cos(azimuth), sine * sin(azimuth), cosine);
    vec3 direction = normalized(frame_around(side * n) * local);
    Ray ray = Ray(position, direction, 7, inward == 1);"""
FIXED = """
float beyond(vec3 origin, vec3 direction, vec3 center, float radius, float least) {
    vec3 to_center = center - origin;
    float b = dot(to_center, direction);
    float discriminant = b * b - (dot(to_center, to_center) - radius * radius);
    if (discriminant < 0.0) return 0.0;
    float root = sqrt(discriminant);
    if (b - root > least) return b - root;
    return b + root > least ? b + root : 0.0;
}"""


def scale(lab: Lab) -> Sweep:
    """Share of wrong answers for rays that leave a sphere.

    Outwards they must not hit it again; inwards they must hit its far side.
    """
    x = np.logspace(-6, 6, 25)
    rows = lab.count(1 << 14)
    rays = _leaving(np.repeat(x, rows))
    radius, cosine = (rays[name].astype(np.float64) for name in ("radius", "cosine"))
    expected = np.where(rays["inward"] == 1, 2 * cosine * radius, 0)
    known = "Ray(position, direction, 7, inward == 1)"
    found = [
        lab.path(
            f"sphere_distance({known}, Sphere(center, radius, 0, -1), 7)", rays, setup=LEAVING
        ),
        lab.path(
            "beyond(position, direction, center, radius, 0.0001)",
            rays,
            setup=LEAVING,
            functions=FIXED,
        ),
    ]
    wrong = [np.abs(t - expected) > 0.01 * radius * cosine for t in found]
    ours, fixed = (share.reshape(len(x), -1).mean(axis=1).tolist() for share in wrong)
    return Sweep(
        parameter="radius of the sphere, in scene units",
        measure="share of rays with a wrong answer",
        x=x.tolist(),
        chosen=("glrt: the ray stores the shape it leaves", ours),
        others={"textbook: t > 1e-4": fixed},
        promise=f"none of {rows} rays at any scale",
        bound=[0.5 / rows] * len(x),
    )


def _leaving(radii: Array) -> dict[str, Array]:
    """Points on spheres with directions at least 3 degrees above the surface, float32."""
    random = np.random.default_rng(3)
    rows = len(radii)
    given = {
        "radius": radii,
        "center": random.uniform(-3, 3, (rows, 3)) * radii[:, None],
        "normal": random.normal(size=(rows, 3)),
        "azimuth": random.uniform(0, 2 * np.pi, rows),
        "cosine": random.uniform(0.05, 1, rows),
    }
    rays = {name: values.astype(np.float32) for name, values in given.items()}
    return rays | {"inward": random.integers(0, 2, rows).astype(np.int32)}


def grazing(lab: Lab) -> Sweep:
    """Error of the distance to a floor, seen from a height of 1; a miss counts as 1."""
    x = np.logspace(-5, 0, 21)
    rows = lab.count(1 << 12)
    sines = np.repeat(x, rows)
    tilted = _floor_rays(sines, tilted=True)
    level = _floor_rays(sines, tilted=False)
    hit = f"plane_distance({RAY}, -normal, normal)"
    errors = []
    for rays in (tilted, level):
        normal, direction = (rays[name].astype(np.float64) for name in ("normal", "direction"))
        truth = -(normal * normal).sum(axis=1) / (normal * direction).sum(axis=1)
        errors.append(np.abs(lab.path(hit, rays) / truth - 1))
    ball = {**level, "center": np.array([[0, -100_001.0, 0]]), "radius": np.array([1e5])}
    t = lab.path("textbook(origin, direction, center, radius)", ball, functions=TEXTBOOK)
    errors.append(np.minimum(np.abs(t / truth - 1), 1))
    ours, axis, ground = (quantile(error, len(x)) for error in errors)
    return Sweep(
        parameter="sine of the angle to the floor",
        measure="relative error of the distance hit\n(99 % quantile)",
        x=x.tolist(),
        chosen=("glrt: tilted plane", ours),
        others={"sphere of radius 100,000 as floor": ground, "glrt: level plane": axis},
        promise="at most 5e-7 / sine",
        bound=(5e-7 / x).tolist(),
    )


def _floor_rays(sines: Array, tilted: bool) -> dict[str, Array]:
    """Rays from the origin to a floor at distance 1, by the sines of the angles to it, float32."""
    random = np.random.default_rng(5)
    normal = (
        random.normal(size=(len(sines), 3)) if tilted else np.tile([0.0, 1, 0], (len(sines), 1))
    )
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = np.cross(normal, random.normal(size=normal.shape))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    direction = np.sqrt(1 - sines**2)[:, None] * along - sines[:, None] * normal
    rays = {"normal": normal, "direction": direction, "origin": np.zeros((1, 3))}
    return {name: values.astype(np.float32) for name, values in rays.items()}


def aimed(distances: Array, most_beside: float = 0.9) -> dict[str, Array]:
    """Rays that hit spheres at `distances`, in radii; radii from 1e-3 to 1e3, float32.

    They pass the centre at up to `most_beside` radii.
    """
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
    """The distance at which each ray enters its sphere, computed in float64."""
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
    """The quantile `share` of the errors in each of `rows` equal parts."""
    found: list[float] = np.quantile(errors.reshape(rows, -1), share, axis=1).tolist()
    return found
