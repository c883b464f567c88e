"""Triangles: rays through a shared edge, rays that leave one, and triangles that are drawn."""

import numpy as np

from glrt.lab.scenes import Table, matte, scene_of
from glrt.lab.sweep import Array, Lab, Sweep
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.shader_functions import World
from glrt.scene.files.named_meshes import MeshFile, mesh_of_arrays
from glrt.scene.scene import Scene

# Moeller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection" (1997).
TEXTBOOK = """
float textbook(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {
    vec3 u = b - a;
    vec3 v = c - a;
    vec3 across = cross(direction, v);
    float scale = 1.0 / dot(u, across);
    vec3 offset = origin - a;
    float share_b = dot(offset, across) * scale;
    vec3 other = cross(offset, u);
    float share_c = dot(direction, other) * scale;
    if (share_b < 0.0 || share_c < 0.0 || share_b + share_c > 1.0) return 0.0;
    return dot(v, other) * scale;
}"""
SHEARED = """
    ShearedRay ray = sheared(Ray(origin, direction, NO_SHAPE, false));
    vec3 p = sheared_point(ray, a);
    vec3 q = sheared_point(ray, b);
    vec3 r = sheared_point(ray, c);
    vec3 s = sheared_point(ray, d);"""


def edges(lab: Lab) -> Sweep:
    """Share of rays aimed at the edge between two triangles that meet neither."""
    x = np.logspace(0, 6, 13)
    rows = lab.count(1 << 15)
    rays = _at_edges(np.repeat(x, rows))
    ours = lab.path(
        "float(triangle_distance(p, q, r) <= 0.0 && triangle_distance(q, p, s) <= 0.0)",
        rays,
        setup=SHEARED,
    )
    first, second = "origin, direction, a, b, c", "origin, direction, b, a, d"
    naive = lab.path(
        f"float(textbook({first}) <= 0.0 && textbook({second}) <= 0.0)", rays, functions=TEXTBOOK
    )
    missed = [found.reshape(len(x), -1).mean(axis=1).tolist() for found in (ours, naive)]
    return Sweep(
        parameter="length of the edge over the height of the triangles",
        measure="share of rays that pass between\ntwo triangles",
        x=x.tolist(),
        chosen=("glrt: sheared rays (Woop et al. 2013)", missed[0]),
        others={"Moeller and Trumbore 1997": missed[1]},
        promise=f"none of {rows} rays, however thin the triangles",
        bound=[0.5 / rows] * len(x),
    )


def _at_edges(aspects: Array) -> dict[str, Array]:
    """Triangles a b c and b a d in any position, and rays that meet their edge, float32.

    They start near, from where both triangles are seen: the rounding of their direction moves them
    by less than a hundredth of the thinnest triangle.
    """
    random = np.random.default_rng(11)
    rows = len(aspects)
    a, b = random.uniform(-1, 1, (2, rows, 3)).astype(np.float32).astype(np.float64)
    along = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    beside = np.cross(along, random.normal(size=(rows, 3)))
    beside /= np.linalg.norm(beside, axis=1, keepdims=True)
    outward = np.cross(along, beside)
    height = (np.linalg.norm(b - a, axis=1) / aspects)[:, None]
    c = a + random.uniform(0.3, 0.7, (rows, 1)) * (b - a) + height * (beside - 0.3 * outward)
    d = a + random.uniform(0.3, 0.7, (rows, 1)) * (b - a) - height * (beside + 0.3 * outward)
    target = a + random.uniform(0.1, 0.9, (rows, 1)) * (b - a)
    origin = target + 0.02 * (outward + random.uniform(-0.3, 0.3, (rows, 3)))
    corners = {"a": a, "b": b, "c": c, "d": d, "origin": origin}
    rounded = {name: values.astype(np.float32) for name, values in corners.items()}
    aim = target - rounded["origin"]
    direction = aim / np.linalg.norm(aim, axis=1, keepdims=True)
    return rounded | {"direction": direction.astype(np.float32)}


LEAVE = """
    Ray ray = Ray(origin, direction, first_triangle() + triangle, false);
    Hit hit = find_hit(ray, FAR, NO_SHAPE, false);
    float side = dot(direction, normal) < 0.0 ? -1.0 : 1.0;
    Ray moved = Ray(origin + 0.0001 * side * normal, direction, NO_SHAPE, false);
    Hit other = find_hit(moved, FAR, NO_SHAPE, false);
    bool expected = inward == 1;"""


def leave(lab: Lab) -> Sweep:
    """Share of wrong answers for rays that leave a triangle of a ball, most of them near its edges.

    Outwards they must meet nothing; inwards they must meet the other side.
    """
    x = np.logspace(-6, 6, 7)
    rows = lab.count(1 << 14)
    wrong = []
    for radius in x:
        scene, rays = _on_a_ball(float(radius), rows)
        expression = (
            "vec2((hit.shape != NO_SHAPE) != expected, (other.shape != NO_SHAPE) != expected)"
        )
        found = lab.path(expression, rays, World(scene), returns="vec2", setup=LEAVE)
        wrong.append(found.mean(axis=0))
    ours, fixed = np.array(wrong).T.tolist()
    return Sweep(
        parameter="radius of the ball, in scene units",
        measure="share of rays with a wrong answer",
        x=x.tolist(),
        chosen=("glrt: starts 16 roundings off the triangle", ours),
        others={"textbook: starts 1e-4 off": fixed},
        promise=f"none of {rows} rays at any scale",
        bound=[0.5 / rows] * len(x),
    )


STRETCHED = """
    Ray ray = Ray(origin, direction, first_triangle() + (1 << INSTANCE_BITS) + triangle, false);
    Hit hit = find_hit(ray, FAR, NO_SHAPE, false);
    Hit other = find_hit(Ray(origin, direction, NO_SHAPE, false), FAR, NO_SHAPE, false);"""


def stretch(lab: Lab) -> Sweep:
    """Share of rays that leave a flattened ball with a tree of its own, outwards, and meet it."""
    x = np.logspace(0, 4, 5)
    rows = lab.count(1 << 14)
    ball = mesh_of_arrays(*_ball(72))  # of 20,448 triangles: a large mesh
    wrong = []
    for factor in x:
        scene, rays = _on_a_flat_ball(ball, float(factor), rows)
        expression = "vec2(hit.shape != NO_SHAPE, other.shape != NO_SHAPE)"
        found = lab.path(
            expression, rays, World(scene, apart="large"), returns="vec2", setup=STRETCHED
        )
        wrong.append(found.mean(axis=0))
    ours, naive = np.array(wrong).T.tolist()
    return Sweep(
        parameter="width of the ball over its thickness",
        measure="share of rays that meet\nwhat they leave",
        x=x.tolist(),
        chosen=("glrt: starts clear of all roundings along the normal", ours),
        others={"starts where it was hit": naive},
        promise=f"none of {rows} rays, however flat the ball",
        bound=[0.5 / rows] * len(x),
    )


RINGS = (4, 8, 32, 128)  # of triangles around a ball
AT_MIDDLES = Variant({"WITHOUT_MARGIN": True})
TRACED = Variant({"RASTERS": False})


def drawn(lab: Lab) -> Sweep:
    """Share of samples that see another first surface in a raster than by a ray."""
    side, samples = lab.count(96), 4
    way = {"width": side, "height": side, "method": "hybrid", "effects": ()}
    wrong, sizes = [], []
    for rings in RINGS:
        points, faces = _ball(rings)
        thing: Table = {"shape": "mesh", "material": "white", "smooth": False}
        mesh = {**thing, "file": mesh_of_arrays(points, faces), "rotate": [20.0, 30.0, 40.0]}
        sky = {"bottom": [0.2, 0.3, 0.9], "top": [0.9, 0.5, 0.1]}
        eye = {"position": [0.0, 0.0, 3.0], "fov": 40.0}
        scene = scene_of([mesh], {"white": matte(0.5)}, eye, background=sky)
        seen = [
            lab.render(scene, samples, by, **way).radiance for by in (PLAIN, AT_MIDDLES, TRACED)
        ]
        wrong.append([float((it != seen[2]).any(axis=2).mean()) for it in seen[:2]])
        sizes.append(side**2 / len(faces))
    ours, naive = np.array(wrong).T.tolist()
    return Sweep(
        parameter="pixels for each triangle of a ball",
        measure="share of pixels with another\nfirst surface than rays find",
        x=sizes,
        chosen=("glrt: triangles grown by a pixel's half, and solved again", ours),
        others={"drawn where they cover the middle of a pixel": naive},
        promise="none, however small the triangles",
        bound=[0.0] * len(sizes),
    )


def _on_a_flat_ball(file: MeshFile, factor: float, rows: int) -> tuple[Scene, dict[str, Array]]:
    """A ball that is thin along an axis, turned, and rays that leave it outwards."""
    random = np.random.default_rng(13)
    thing: Table = {"shape": "mesh", "material": "white", "smooth": False, "file": file}
    where: Table = {"translate": [3.0, -2.0, 4.0], "rotate": [20.0, 30.0, 40.0]}
    mesh = {**thing, **where, "scale": [1.0, 1 / factor, 1.0]}
    eye = {"position": [0.0, 0.0, 0.0], "look_at": [3.0, -2.0, 4.0]}
    scene = scene_of([mesh], {"white": matte(0.5)}, eye)
    placed = scene.meshes[0]
    triangle = random.integers(0, len(placed.triangles.faces), rows)
    corner = placed.world_vertices[placed.triangles.faces[triangle]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    direction = random.normal(size=(rows, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction *= np.sign((direction * normal).sum(axis=1))[:, None]
    share = random.dirichlet([0.3] * 3, rows)
    origin = (share[:, :, None] * corner).sum(axis=1)
    rays = {"origin": origin.astype(np.float32), "direction": direction.astype(np.float32)}
    return scene, {**rays, "triangle": triangle.astype(np.int32)}


def _on_a_ball(radius: float, rows: int) -> tuple[Scene, dict[str, Array]]:
    """A ball of triangles, far from the origin, and rays that start on it."""
    random = np.random.default_rng(12)
    points, faces = _ball(24)
    center = radius * np.array([50.0, -20.0, 30.0])
    thing: Table = {"shape": "mesh", "material": "white", "smooth": False}
    mesh = {**thing, "file": mesh_of_arrays(points * radius, faces), "translate": center.tolist()}
    eye = {"position": center.tolist(), "look_at": np.add(center, [0, 0, radius]).tolist()}
    scene = scene_of([mesh], {"white": matte(0.5)}, eye)
    triangle = random.integers(0, len(faces), rows)
    corner = radius * points[faces[triangle]]
    share = random.dirichlet([0.3] * 3, rows)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    direction = random.normal(size=(rows, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    inward = (direction * normal).sum(axis=1) < 0
    given = {
        "origin": (share[:, :, None] * corner).sum(axis=1),
        "direction": direction,
        "normal": normal,
    }
    rays = {name: values.astype(np.float32) for name, values in given.items()}
    numbers = {"triangle": triangle.astype(np.int32), "inward": inward.astype(np.int32)}
    return scene, rays | numbers


def _ball(rows: int) -> tuple[Array, Array]:
    """A unit ball of `rows` rings of triangles."""
    columns = 2 * rows
    polar, around = np.pi * np.arange(1, rows) / rows, 2 * np.pi * np.arange(columns) / columns
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    points = [
        np.stack([np.sin(p) * ring[:, 0], np.full(columns, np.cos(p)), np.sin(p) * ring[:, 1]], 1)
        for p in polar
    ]
    corners = np.concatenate([[[0, 1, 0]], *points, [[0, -1, 0]]])
    here = np.arange(columns)
    after = (here + 1) % columns
    last = 1 + columns * (rows - 2)
    faces = [np.stack([0 * here, 1 + after, 1 + here], axis=1)]
    for row in range(rows - 2):
        first = 1 + row * columns
        below = first + columns
        faces.append(np.stack([first + here, first + after, below + here], axis=1))
        faces.append(np.stack([first + after, below + after, below + here], axis=1))
    faces.append(np.stack([last + here, last + after, 0 * here + len(corners) - 1], axis=1))
    return corners, np.concatenate(faces)
