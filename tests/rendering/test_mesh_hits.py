"""The hits of rays among triangles: against Embree and against arithmetic in float64."""

from typing import Any

import numpy as np
import pytest

from glrt.plan.facts import SceneFacts
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import MATTE, box, plane, quad, scene_of, sphere
from tests.support.meshes import Faces, blob, icosphere, mesh
from tests.support.meshes import box as box_mesh
from tests.support.system_packages import needs

Array = np.ndarray[Any, Any]

HIT = """
    Hit hit = find_hit(Ray(o, d, leaves, false), 3.4e38, NO_SHAPE, false);
    bool hidden = occluded(Ray(o, d, leaves, false), 3.4e38, NO_SHAPE);"""
RATIO = 1e-6  # of distances that count as equal
FLOOR = plane([0, -2, 0], [0, 1, 0], "white")


def of_meshes(*faces: Faces, more: tuple[dict[str, Any], ...] = ()) -> Scene:
    return scene_of([*more, *(mesh(some, "white") for some in faces)], {"white": MATTE})


def found(call_glsl: CallGlsl, scene: Scene, origin: Array, direction: Array, **more: Any) -> Array:
    """Distance, shape, whether anything is met, and whether a loop was cut, of each ray."""
    tree = bool(SceneFacts(scene).tree_kinds)
    return call_glsl(
        "vec4(hit.distance, float(hit.shape), float(hidden), float(loop_was_cut))",
        "vec4",
        setup=HIT,
        scene=scene,
        constants={"HAS_TREE": tree, "HAS_SPHERE_TREE": False},
        o=origin,
        d=direction,
        leaves=more.get("leaves", np.array([-1])),
    )


def rays(count: int, seed: int, size: float = 1.5) -> tuple[Array, Array]:
    """Rays from anywhere near, to anywhere near; as the kernel has them, in float32."""
    draw = np.random.default_rng(seed)
    origin = draw.uniform(-size, size, (count, 3)).astype(np.float32)
    direction = draw.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return origin, direction.astype(np.float32)


def from_afar(faces: Faces, count: int, seed: int) -> tuple[Array, Array]:
    """Rays from all around, half of them to points of triangles, the others to anywhere."""
    draw = np.random.default_rng(seed)
    origin = draw.normal(size=(count, 3))
    origin *= 4 / np.linalg.norm(origin, axis=1, keepdims=True)
    origin = origin.astype(np.float32)
    corner = faces[0][faces[1][draw.integers(0, len(faces[1]), count)]]
    on_one = (draw.dirichlet([1.0] * 3, count)[:, :, None] * corner).sum(axis=1)
    target = np.where(np.arange(count)[:, None] % 2, draw.uniform(-1, 1, (count, 3)), on_one)
    direction = target - origin
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return origin, direction.astype(np.float32)


def slivers(count: int, aspect: float) -> Faces:
    """Long thin triangles, in all directions."""
    draw = np.random.default_rng(4)
    start = draw.uniform(-1, 1, (count, 3))
    along = draw.normal(size=(count, 3))
    across = draw.normal(size=(count, 3)) / aspect
    corners = np.stack([start, start + along, start + along / 2 + across], axis=1)
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def large_and_small() -> Faces:
    """Triangles whose boxes are mostly empty, which are cut, around many small ones."""
    draw = np.random.default_rng(7)
    points, faces = blob(3)
    large = draw.uniform(-1, 1, (24, 3))
    return np.concatenate([0.2 * points, large]), np.concatenate(
        [faces, len(points) + np.arange(24).reshape(-1, 3)]
    )


MESHES = {
    "blob": blob(4),
    "ball": icosphere(3),
    "box": box_mesh([-1, -0.5, -0.7], [0.6, 1, 0.8]),
    "slivers": slivers(500, 1000.0),
    "one triangle": (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])),
    "large and small": large_and_small(),
    "a heap": (blob(3)[0] * 0.3, blob(3)[1]),
}


def exact(faces: Faces, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Distances, inf for a miss, and how far from an edge the hit is, in float64."""
    corner = faces[0].astype(np.float32).astype(np.float64)[faces[1]]
    best, margin = np.full(len(origin), np.inf), np.full(len(origin), np.inf)
    for a, b, c in corner:
        pa, pb, pc = (point - origin.astype(np.float64) for point in (a, b, c))
        u = (np.cross(pc, pb) * direction).sum(axis=1)
        v = (np.cross(pa, pc) * direction).sum(axis=1)
        w = (np.cross(pb, pa) * direction).sum(axis=1)
        with np.errstate(all="ignore"):
            shares = np.stack([u, v, w]) / (u + v + w)
            normal = np.cross(b - a, c - a)
            t = (pa @ normal) / (direction.astype(np.float64) @ normal)
        inner = shares.min(axis=0)
        margin = np.where(t > 0, np.minimum(margin, np.abs(inner)), margin)
        is_nearer = (inner >= 0) & (t > 0) & (t < best)
        best[is_nearer] = t[is_nearer]
    return best, margin


@pytest.mark.slow_cases("blob")
@pytest.mark.parametrize("name", sorted({*MESHES} - {"slivers"}))
def test_rays_find_what_arithmetic_in_float64_finds(call_glsl: CallGlsl, name: str) -> None:
    origin, direction = rays(2048, 5)
    faces = MESHES[name]
    truth, margin = exact(faces, origin, direction)
    seen = found(call_glsl, of_meshes(faces), origin, direction)
    clear = margin > 1e-4  # no edge is within rounding of the ray
    assert clear.mean() > 0.9
    is_hit = np.isfinite(truth) & clear
    assert np.array_equal((seen[:, 1] >= 0)[clear], np.isfinite(truth)[clear])
    # The distance of a flat triangle seen from its edge is less exact.
    off = np.abs(seen[is_hit, 0] / truth[is_hit] - 1)
    assert np.quantile(off, 0.99) < RATIO * 10 if len(off) else True
    assert np.array_equal(seen[:, 1] >= 0, seen[:, 2] == 1)
    assert not seen[:, 3].any()


def embree(faces: Faces, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Distances and triangles, -1 for a miss, by Embree."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ModuleNotFoundError:
        needs(False, "the Python package embreex")
    scene = EmbreeScene()
    TriangleMesh(scene, faces[0].astype(np.float32), faces[1].astype(np.int32))
    result = scene.run(origin, direction, output=1)
    return result["tfar"], result["primID"]


def against_embree(call_glsl: CallGlsl, name: str, count: int, seed: int) -> None:
    """Distances across the triangles agree to RATIO; hits apart are ties at edges, and few."""
    faces, scene = MESHES[name], of_meshes(MESHES[name])
    origin, direction = from_afar(faces, count, seed)
    distance, triangle = embree(faces, origin, direction)
    seen = found(call_glsl, scene, origin, direction)
    ours = np.where(seen[:, 1] < 0, -1, seen[:, 1] - len(scene.objects)).astype(int)
    theirs = triangle.astype(np.int32).astype(int)
    both = (ours >= 0) & (theirs >= 0)
    assert both.mean() > 0.3
    corner = faces[0][faces[1][ours[both]]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    cosine = np.abs((normal * direction[both]).sum(axis=1))  # seen from its edge, a plane is far
    same = ours[both] == theirs[both]
    off = (np.abs(seen[both, 0].astype(np.float64) / distance[both] - 1) * cosine)[same]
    apart = ((ours >= 0) != (theirs >= 0)).mean(), (~same).mean()
    rough = name == "slivers"
    told = f"{off.max()} off, {apart[0]} met by one, {apart[1]} by both elsewhere"
    assert off.max() < (1e-3 if rough else RATIO), told
    assert max(apart) < (0.01 if rough else 1e-4), told


@pytest.mark.slow_cases("slivers")
@pytest.mark.parametrize("name", MESHES)
def test_rays_find_what_embree_finds(call_glsl: CallGlsl, name: str) -> None:
    against_embree(call_glsl, name, 50_000, 1)


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
def test_millions_of_rays_find_what_embree_finds(call_glsl: CallGlsl, name: str) -> None:
    for seed in range(8):
        against_embree(call_glsl, name, 210_000, 100 + seed)


def at_edges(faces: Faces, count: int, seed: int) -> tuple[Array, Array]:
    """Rays from near the middle to points of edges, as near as float32 has them."""
    draw = np.random.default_rng(seed)
    origin = draw.uniform(-0.1, 0.1, (count, 3)).astype(np.float32)
    picked, start = draw.integers(0, len(faces[1]), count), draw.integers(0, 3, count)
    a = faces[0][faces[1][picked, start]]
    b = faces[0][faces[1][picked, (start + 1) % 3]]
    share = draw.choice([0.0, 0.5, 1.0, *draw.random(8)], count)[:, None]
    direction = (a + share * (b - a)) - origin
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return origin, direction.astype(np.float32)


def misses(call_glsl: CallGlsl, name: str, count: int, seed: int) -> int:
    faces = MESHES[name]
    seen = found(call_glsl, of_meshes(faces), *at_edges(faces, count, seed))
    return int((seen[:, 1] < 0).sum())


@pytest.mark.parametrize("name", ["blob", "ball", "box"])
def test_no_ray_from_inside_gets_out_at_an_edge(call_glsl: CallGlsl, name: str) -> None:
    assert misses(call_glsl, name, 100_000, 3) == 0


@pytest.mark.slow
def test_of_ten_million_rays_none_gets_out_at_an_edge(call_glsl: CallGlsl) -> None:
    assert sum(misses(call_glsl, "blob", 500_000, seed) for seed in range(20)) == 0


def test_a_ray_leaves_its_triangle_and_its_neighbours(call_glsl: CallGlsl) -> None:
    """Rays go outwards from points on a convex mesh: none meets it, even at edges and corners."""
    points, faces = icosphere(3)
    scene = of_meshes((points, faces))
    draw = np.random.default_rng(8)
    count = 100_000
    picked = draw.integers(0, len(faces), count)
    shares = draw.dirichlet([0.3] * 3, count)  # many near edges and corners
    corner = points.astype(np.float32).astype(np.float64)[faces[picked]]
    origin = (shares[:, :, None] * corner).sum(axis=1)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    direction = draw.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction *= np.sign((direction * normal).sum(axis=1))[:, None]
    leaves = picked + len(scene.objects)
    out = found(call_glsl, scene, origin, direction, leaves=leaves)
    assert not (out[:, 1] >= 0).any()
    back = found(call_glsl, scene, origin, -direction, leaves=leaves)
    assert (back[:, 1] >= 0).all()
    steep = (direction * normal).sum(axis=1) > 0.3
    assert back[steep, 0].min() > 0.3, "the other side, not a neighbour"


@pytest.mark.slow
def test_meshes_and_shapes_in_one_tree(call_glsl: CallGlsl) -> None:
    """The nearest of both kinds, whether the shapes are in the tree or compared one by one."""
    draw = np.random.default_rng(2)
    things: list[dict[str, Any]] = [sphere(draw.uniform(-1, 1, 3), 0.15, "white") for _ in range(8)]
    things += [quad(draw.uniform(-1, 1, 3), [0.3, 0, 0], [0, 0.3, 0], "white") for _ in range(8)]
    things += [box(c - 0.1, c + 0.1, "white") for c in draw.uniform(-1, 1, (8, 3))]
    origin, direction = rays(20_000, 6)
    heap = MESHES["a heap"]
    both = of_meshes(heap, more=(*things, FLOOR))
    assert SceneFacts(both).tree_kinds == ("sphere", "quad", "box")
    alone = found(call_glsl, of_meshes(heap, more=(FLOOR,)), origin, direction)
    shapes = scene_of([*things, FLOOR], {"white": MATTE})
    others = found(call_glsl, shapes, origin, direction)
    seen = found(call_glsl, both, origin, direction)
    nearest = np.minimum(
        *(np.where(some[:, 1] >= 0, some[:, 0], np.inf) for some in (alone, others))
    )
    is_hit = np.isfinite(nearest)
    assert np.array_equal(seen[:, 1] >= 0, is_hit)
    assert np.abs(seen[is_hit, 0] / nearest[is_hit] - 1).max() < 1e-4
