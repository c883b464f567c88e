"""Meshes that are used more than once: triangles are kept once, and look as if they were not."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.packing.instances import check_numbers
from glrt.packing.scene_tree import tree_of
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.rendering.schedule import TREE_ROUNDS, iterations_per_sample
from glrt.scene import instancing
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.conftest import CallGlsl
from tests.rendering.test_mesh_hits import FLOOR, at_edges, exact, found, rays
from tests.support.builders import MATTE, box, glass, lamp, plane, quad, scene_of, sphere
from tests.support.meshes import Faces, blob, icosphere, mesh
from tests.support.renders import METHODS, rendered, same

Array = np.ndarray[Any, Any]

BLOB = blob(3)
PLACES: tuple[dict[str, Any], ...] = (
    {"translate": [0.7, 0.1, -0.4], "rotate": [20, 30, 40], "scale": [0.5, 0.25, -0.4]},
    {"translate": [-0.6, -0.2, 0.3], "rotate": [0, 90, 10], "scale": 0.6},
    {"translate": [-0.5, -0.1, 0.4], "rotate": [70, 0, 0], "scale": [0.7, 0.001, 0.7]},
    {
        "translate": [0.2, 0.9, 0.1],
        "matrix": [[1, 0.5, 0, 0.25], [0, 1, 0.25, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        "scale": 0.3,
    },
)
MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [0.75, 0.75, 0.75]},
    "red": {"type": "lambertian", "color": [0.75, 0.25, 0.125]},
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.4},
    "glass": glass(),
    "lamp": lamp(4.0),
}


@pytest.fixture(autouse=True)
def _always(monkeypatch: pytest.MonkeyPatch) -> None:
    """Meshes of any size have trees of their own where they are used twice."""
    monkeypatch.setattr(instancing, "LEAST_SAVED", 1)


def flat(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """From here on they have none."""
    monkeypatch.setattr(instancing, "LEAST_SAVED", 1 << 40)
    assert not SceneFacts(scene).instances


def placed(*places: dict[str, Any], faces: Faces = BLOB, more: Any = ()) -> Scene:
    scene = scene_of([*more, *(mesh(faces, "white", **at) for at in places)], {"white": MATTE})
    assert len(SceneFacts(scene).instances) == len(places)
    return scene


@pytest.mark.usefixtures("exact_kernels")
def test_loops_are_limited_for_the_division_that_is_traced(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three copies of a mesh: one BVH of all triangles, or three instances of one mesh."""
    monkeypatch.setattr(instancing, "LEAST_LARGE", 1)
    scene = placed(*PLACES[:3])
    flat(scene, monkeypatch)
    triangles = len(BLOB[1])
    joined, apart = (
        iterations_per_sample(prepare(scene, settings_for(scene.render, bounces=0), apart=way))
        for way in ("repeated", "large")
    )
    assert joined == 2 + 2 * round(TREE_ROUNDS * np.log2(3 * triangles))
    assert apart == 2 + 2 * round(TREE_ROUNDS * np.log2(triangles + 3))


def in_the_scene(scene: Scene) -> Faces:
    """All triangles, as they stand."""
    points, faces, first = [], [], 0
    for shape in scene.meshes:
        points.append(shape.world_vertices)
        faces.append(shape.triangles.faces + first)
        first += len(points[-1])
    return np.concatenate(points), np.concatenate(faces)


def objects_met(scene: Scene, seen: Array) -> Array:
    """The mesh that each ray met, by its place among the meshes; -1 for none."""
    number = seen[:, 1].astype(int) - len(scene.objects)
    return np.where(number < 0, -1, (number >> SceneFacts(scene).instance_bits) - 1)


@pytest.mark.slow
@pytest.mark.slow_cases("1", "2", "3")
@pytest.mark.parametrize("number", range(len(PLACES)))
def test_rays_find_an_instance_where_it_stands(call_glsl: CallGlsl, number: int) -> None:
    """Hits are as in float64; distances have the bound of float32 in the frame of the mesh."""
    away = {"translate": [4.0, 0, 0]}
    scene = placed(PLACES[number], away)
    origin, direction = rays(4096, 5)
    truth, margin = exact(in_the_scene(scene), origin, direction)
    seen = found(call_glsl, scene, origin, direction)
    clear = margin > 1e-3
    is_hit = np.isfinite(truth) & clear
    assert is_hit.sum() > 30
    assert np.array_equal((seen[:, 1] >= 0)[clear], np.isfinite(truth)[clear])
    assert {0} <= set(objects_met(scene, seen[is_hit])) <= {0, 1}
    off = np.abs(seen[is_hit, 0] / truth[is_hit] - 1)
    assert np.quantile(off, 0.99) < 2e-5
    assert np.array_equal(seen[:, 1] >= 0, seen[:, 2] == 1)
    assert not seen[:, 3].any()


@pytest.mark.slow
def test_rays_find_the_nearest_of_instances_and_shapes(call_glsl: CallGlsl) -> None:
    draw = np.random.default_rng(2)
    things: list[dict[str, Any]] = [sphere(draw.uniform(-1, 1, 3), 0.1, "white") for _ in range(8)]
    things += [quad(draw.uniform(-1, 1, 3), [0.3, 0, 0], [0, 0.3, 0], "white") for _ in range(8)]
    things += [box(c - 0.1, c + 0.1, "white") for c in draw.uniform(-1, 1, (8, 3))]
    single = mesh(icosphere(2), "white", translate=[0.1, -0.8, 0.2], scale=0.3)
    origin, direction = rays(20_000, 6)
    alone = [
        found(call_glsl, scene, origin, direction)
        for scene in (
            placed(*PLACES, more=[FLOOR]),
            scene_of([*things, FLOOR], {"white": MATTE}),
            scene_of([single, FLOOR], {"white": MATTE}),
        )
    ]
    seen = found(call_glsl, placed(*PLACES, more=[*things, single, FLOOR]), origin, direction)
    nearest = np.min([np.where(some[:, 1] >= 0, some[:, 0], np.inf) for some in alone], axis=0)
    is_hit = np.isfinite(nearest)
    assert np.array_equal(seen[:, 1] >= 0, is_hit)
    assert np.array_equal(seen[:, 2] == 1, is_hit)
    off = np.abs(seen[is_hit, 0] / nearest[is_hit] - 1)
    assert np.quantile(off, 0.999) < 1e-5
    assert off.max() < 0.02, "where a thin mesh is met along its surface"
    assert not seen[:, 3].any()


def edges_missed(call_glsl: CallGlsl, count: int, seed: int) -> int:
    """Rays from inside one of two instances, at its edges, that meet nothing."""
    where = {"rotate": [20, 30, 40], "scale": [1.5, 0.7, -1.1], "translate": [0.1, 0.05, -0.02]}
    scene = placed(where, {"translate": [4, 0, 0]})
    stood = scene.meshes[0]
    points = stood.world_vertices, stood.triangles.faces
    seen = found(call_glsl, scene, *at_edges(points, count, seed))
    return int((seen[:, 1] < 0).sum())


@pytest.mark.slow
def test_no_ray_gets_out_of_an_instance_at_an_edge(call_glsl: CallGlsl) -> None:
    assert edges_missed(call_glsl, 200_000, 3) == 0


@pytest.mark.slow
def test_of_ten_million_rays_none_gets_out_of_an_instance(call_glsl: CallGlsl) -> None:
    assert sum(edges_missed(call_glsl, 500_000, seed) for seed in range(20)) == 0


@pytest.mark.slow_cases("2-0.0")
@pytest.mark.slow_cases("2-300.0")
@pytest.mark.parametrize("offset", [0.0, 300.0])
@pytest.mark.parametrize("number", range(len(PLACES)))
def test_a_ray_leaves_the_triangle_of_an_instance(
    call_glsl: CallGlsl, number: int, offset: float
) -> None:
    """Rays go outwards from points on a convex mesh: none meets it, even at edges and corners."""
    at = PLACES[number]
    at = {**at, "translate": [value + offset for value in at["translate"]]}
    scene = placed(at, {"translate": [-50.0, 0, 0]}, faces=icosphere(3))
    stood, draw, count = scene.meshes[0], np.random.default_rng(8), 100_000
    faces = stood.triangles.faces if stood.is_upright else stood.triangles.faces[:, ::-1]
    picked = draw.integers(0, len(faces), count)
    corner = stood.world_vertices[faces[picked]]
    origin = (draw.dirichlet([0.3] * 3, count)[:, :, None] * corner).sum(axis=1)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    direction = draw.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction *= np.sign((direction * normal).sum(axis=1))[:, None]
    bits = SceneFacts(scene).instance_bits
    leaves = picked + len(scene.objects) + (1 << bits)
    out = found(call_glsl, scene, origin, direction, leaves=leaves)
    assert not (objects_met(scene, out) == 0).any()
    if min(map(abs, stood.scale)) < 0.01:
        return  # its rim is thinner than the roundings of a point
    back = found(call_glsl, scene, origin, -direction, leaves=leaves)
    assert (back[:, 1] >= 0).all()
    steep = (direction * normal).sum(axis=1) > 0.3
    assert back[steep, 0].min() > 0.02, "the other side, not a neighbour"


def group(scale: float = 1.0, offset: tuple[float, float, float] = (0, 0, 0)) -> Scene:
    """Instances of every material and a lamp of the same mesh, among other shapes."""
    points, faces = blob(2)
    ball = np.rint(points * 2**20) / 2**20, faces

    def at(*point: float) -> list[float]:
        return [scale * (c + o) for c, o in zip(point, offset, strict=True)]

    def place(material: str, where: tuple[float, ...], size: float, **more: Any) -> dict[str, Any]:
        return mesh(ball, material, translate=at(*where), scale=scale * size, **more)

    objects = [
        plane(at(0, -1, 0), [0, 1, 0], "white"),
        place("glass", (-0.625, -0.375, 0), 0.5, rotate=[0, 30, 0]),
        place("brass", (0.75, -0.5, 0.25), 0.25, smooth=False),
        place("red", (0.125, -0.25, -1), 0.5, rotate=[90, 0, 20]),
        place("lamp", (0.25, 0.875, 0.25), 0.125, smooth=False),
        sphere(at(0.25, -0.75, 0.5), 0.25 * scale, "white"),
    ]
    camera = {"position": at(0.125, 0.25, 3.0), "look_at": at(0, 0, 0.125)}
    return scene_of(objects, MATERIALS, camera, background={"color": [0.3, 0.4, 0.5]})


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_instances_look_as_if_their_triangles_were_kept_apart(
    context: Context, method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both use the same random numbers: only rounding is left, which changes few paths."""
    settings: dict[str, Any] = {"method": method, "bounces": 6, "width": 24, "height": 24}
    assert SceneFacts(group()).instances == (0, 1, 2)
    ours = rendered(group(), context, 64, **settings).radiance
    flat(group(), monkeypatch)
    theirs = rendered(group(), context, 64, **settings).radiance
    other = rendered(group(), context, 64, seed=1, **settings).radiance
    apart = np.sqrt(np.mean((ours - theirs) ** 2))
    assert apart < 0.3 * np.sqrt(np.mean((other - theirs) ** 2))


@pytest.mark.slow
def test_stretched_instances_are_shaded_as_if_kept_apart(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Normals between those of corners, stretched and mirrored, with colours of the corners."""
    points, faces = BLOB
    colors = np.abs(np.sin(3 * points))
    things = [mesh((points, faces), "white", colors=colors, **at) for at in PLACES[:2]]
    things += [mesh(icosphere(1), "red", translate=[0, -1, 0], scale=0.3), FLOOR]
    look = {"position": [0, 0, 3.5], "look_at": [0, 0, 0], "fov": 40}
    scene = scene_of(things, MATERIALS, look, background={"color": [0.5, 0.6, 0.7]})
    assert SceneFacts(scene).instances == (0, 1)
    settings: dict[str, Any] = {"bounces": 1, "width": 32, "height": 32}
    ours = rendered(scene, context, 64, **settings).radiance
    flat(scene, monkeypatch)
    theirs = rendered(scene, context, 64, **settings).radiance
    assert np.median(np.abs(ours - theirs)) < 1e-5
    other = rendered(scene, context, 64, seed=1, **settings).radiance
    apart = np.sqrt(np.mean((ours - theirs) ** 2))
    assert apart < 0.1 * np.sqrt(np.mean((other - theirs) ** 2))


@pytest.mark.slow
@pytest.mark.parametrize("power", [-7, 6])
def test_instances_scaled_by_a_power_of_two_keep_their_bits(context: Context, power: int) -> None:
    settings: dict[str, Any] = {"width": 16, "height": 16, "bounces": 6}
    plain = rendered(group(), context, 8, **settings)
    assert same(plain, rendered(group(2.0**power), context, 8, **settings))


def test_instances_far_from_the_origin_keep_their_bits(context: Context) -> None:
    settings: dict[str, Any] = {"width": 16, "height": 16, "bounces": 6}
    plain = rendered(group(), context, 8, **settings)
    assert same(plain, rendered(group(1.0, (2.0**20, -(2.0**19), 2.0**18)), context, 8, **settings))


@pytest.mark.usefixtures("twins_stay")
def test_the_triangles_of_instances_are_kept_once() -> None:
    once = tree_of(SceneFacts(scene := placed(*PLACES[:2])))
    often = tree_of(SceneFacts(scene := placed(*(4 * PLACES))))
    assert once is not None
    assert often is not None
    assert len(once.triangles) == len(often.triangles) == len(BLOB[1])
    assert len(often.instances) == 16
    assert SceneFacts(scene).triangles == len(BLOB[1])


def test_numbers_of_instances_and_triangles_fit() -> None:
    check_numbers(100, 22, 1000)
    with pytest.raises(SceneError, match=r"in 600 places, and meshes of up to 4,194,304 triangles"):
        check_numbers(600, 22, 1000)
