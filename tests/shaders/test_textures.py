"""Images on surfaces as the kernel reads them, against float64 and formulas."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.plan.facts import SceneFacts
from glrt.scene import instancing
from glrt.scene.files.named_meshes import MeshFile
from glrt.scene.materials.principled import Principled
from glrt.scene.materials.textures import Texture
from glrt.scene.meshes.checked_meshes import MeshArrays, checked
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import disk, plane, quad, scene_of, sphere
from tests.support.meshes import mesh
from tests.support.textures import random_image, value64, with_images

CORNERS = np.array([[-1.0, -1, -3], [2, -1, -4], [0, 2, -5]])
TEXTURED = {"type": "lambertian", "color": {"image": "a.png"}}
HIT = "Hit hit = closest_hit(Ray(vec3(0.0), direction, NO_SHAPE, false));"
SURFACE = f"Ray ray = Ray(vec3(0.0), direction, NO_SHAPE, false); {HIT}"


def of_texture(texture: dict[str, Any], width: int = 5, height: int = 3) -> Scene:
    """A scene with one texture, on a sphere."""
    material = {"type": "lambertian", "color": {"image": "a.png", **texture}}
    scene = scene_of([sphere([0, 0, -3], 1, "m")], {"m": material})
    return with_images(scene, {"a.png": random_image(width, height)})


def sampled(call_glsl: CallGlsl, scene: Scene, uv: Any) -> Any:
    return call_glsl(
        "map_value(0, Coordinates(uv, uv))", "vec4", scene=scene, uv=np.asarray(uv, np.float32)
    )


WRAPS = [(name, name) for name in ("repeat", "mirror", "clamp")]
WRAPS += [("repeat", "clamp"), ("clamp", "mirror")]


@pytest.mark.parametrize("wrap", WRAPS)
@pytest.mark.parametrize("filtered", ["linear", "nearest"])
@pytest.mark.parametrize("size", [(5, 3), (1, 1), (1, 4)])
def test_an_image_is_read_between_its_pixels_and_beyond_its_edges(
    call_glsl: CallGlsl, wrap: tuple[str, str], filtered: str, size: tuple[int, int]
) -> None:
    scene = of_texture({"wrap": wrap, "filter": filtered}, *size)
    uv = np.random.default_rng(1).uniform(-3, 4, (4000, 2)).astype(np.float32)
    expected = value64(random_image(*size), uv.astype(float), wrap, filtered == "nearest")
    found = sampled(call_glsl, scene, uv)
    if filtered == "linear":
        assert_allclose(found, expected, atol=1e-5)
    else:  # at the edges of pixels rounding decides
        assert (found == expected).all(axis=1).mean() > 0.999


def test_the_first_row_of_an_image_is_on_top(call_glsl: CallGlsl) -> None:
    image = random_image(2, 2)
    uv = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]
    found = sampled(call_glsl, of_texture({}, 2, 2), uv)
    assert np.array_equal(found, image.reshape(4, 4))


@pytest.mark.parametrize("far", [1e3, -1e6, 1e15])
def test_places_far_away_are_within_the_image(call_glsl: CallGlsl, far: float) -> None:
    """Coordinates with no digits left for the place still give a pixel."""
    uv = np.random.default_rng(2).uniform(0, 1, (500, 2)) + far
    found = sampled(call_glsl, of_texture({}), uv)
    assert np.isfinite(found).all()
    assert (found >= 0).all()
    assert (found <= 1).all()


def test_a_transform_is_that_of_gltf(call_glsl: CallGlsl) -> None:
    """KHR_texture_transform: offset + rotation (counter-clockwise in u, v down) of scale."""
    texture = {"scale": [2, 3], "rotation": 30, "offset": [0.1, 0.2]}
    uv = np.random.default_rng(3).uniform(-1, 1, (1000, 2)).astype(np.float32)
    cos, sin = np.cos(np.pi / 6), np.sin(np.pi / 6)
    u, v = (uv * [2.0, 3.0]).T
    turned = np.stack([cos * u + sin * v + 0.1, -sin * u + cos * v + 0.2], axis=1)
    found = sampled(call_glsl, of_texture(texture), uv)
    assert_allclose(found, value64(random_image(5, 3), turned, ("repeat", "repeat")), atol=2e-5)


def test_a_checkerboard_has_its_first_color_at_the_origin(call_glsl: CallGlsl) -> None:
    board = {"type": "lambertian", "color": {"checker": [[1, 0, 0], [0, 0.5, 1]], "scale": [2, 3]}}
    scene = scene_of([sphere([0, 0, -3], 1, "m")], {"m": board})
    uv = np.random.default_rng(4).uniform(-2, 2, (2000, 2)).astype(np.float32)
    is_first = (np.floor(uv * [4.0, 6.0]).sum(axis=1) % 2) == 0
    found = sampled(call_glsl, scene, uv)[:, :3]
    same = np.where(is_first[:, None], [1.0, 0, 0], [0, 0.5, 1.0]) == found
    assert same.all(axis=1).mean() > 0.998


def directions_to(points: Any) -> Any:
    points = np.asarray(points, float)
    return (points / np.linalg.norm(points, axis=1, keepdims=True)).astype(np.float32)


def coordinates(call_glsl: CallGlsl, scene: Scene, points: Any, which: str = "first") -> Any:
    return call_glsl(
        f"coordinates_of(ray, surface_at(ray, hit)).{which}",
        "vec2",
        setup=SURFACE,
        scene=with_images(scene, {"a.png": random_image(2, 2)}),
        direction=directions_to(points),
    )


def points_between(corner: Any, u: Any, v: Any, shares: Any) -> Any:
    return np.array(corner) + shares @ np.array([u, v], float)


def shares_of(count: int = 500) -> Any:
    return np.random.default_rng(5).uniform(0.01, 0.99, (count, 2))


@pytest.mark.parametrize("order", [1, -1])
def test_a_quad_has_them_along_its_edges(call_glsl: CallGlsl, order: int) -> None:
    """Whichever is longer: the kernel sorts them."""
    corner, (u, v) = [-1, 1, -4], [[3.0, 0.5, 0], [0.5, -1.5, 0.5]][::order]
    scene = scene_of([quad(corner, u, v, "m")], {"m": TEXTURED})
    shares = shares_of()
    found = coordinates(call_glsl, scene, points_between(corner, u, v, shares))
    assert_allclose(found, shares, atol=3e-6)


FACES = {  # normal, and where u and v grow: v downwards, on floors towards the viewer
    "wall": ([0, 0, 1], [1, 0, 0], [0, -1, 0]),
    "floor": ([0, 1, 0], [1, 0, 0], [0, 0, 1]),
    "ceiling": ([0, -1, 0], [1, 0, 0], [0, 0, -1]),
    "side": ([1, 0, 0], [0, 0, -1], [0, -1, 0]),
}


@pytest.mark.parametrize("face", FACES)
def test_a_plane_has_them_in_scene_units_and_a_disk_in_its_square(
    call_glsl: CallGlsl, face: str
) -> None:
    normal, u, v = FACES[face]
    point = -3.0 * np.array(normal) + [0.3, 0.2, -0.1] * (1 - np.abs(normal))
    offsets = np.random.default_rng(6).uniform(-1, 1, (500, 2))
    points = points_between(point, u, v, offsets)
    floor = scene_of([plane(point, normal, "m")], {"m": TEXTURED})
    assert_allclose(coordinates(call_glsl, floor, points), offsets, atol=3e-6)
    round_ = scene_of([disk(point, normal, 2.0, "m")], {"m": TEXTURED})
    assert_allclose(coordinates(call_glsl, round_, points), offsets / 4 + 0.5, atol=3e-6)


def test_a_sphere_has_them_by_longitude_and_latitude(call_glsl: CallGlsl) -> None:
    """u = atan2(x, -z) / 2 pi + 1/2, v = acos(y) / pi, of the normal; the camera is inside."""
    direction = directions_to(np.random.default_rng(7).normal(size=(2000, 3)))
    scene = scene_of([sphere([0, 0, 0], 2, "m")], {"m": TEXTURED})
    found = coordinates(call_glsl, scene, direction)
    x, y, z = direction.astype(float).T
    expected = np.stack([np.arctan2(x, -z) / (2 * np.pi) + 0.5, np.arccos(y) / np.pi], axis=1)
    assert_allclose(found, expected, atol=2e-6)


def test_a_mesh_has_those_between_its_corners(call_glsl: CallGlsl) -> None:
    uv = np.array([[0.1, 0.2], [5.0, -1.0], [-2.0, 0.7]])
    shares = np.random.default_rng(8).dirichlet([1, 1, 1], 1000)
    triangle = mesh((CORNERS, np.array([[0, 1, 2]])), "m", uv=uv)
    scene = scene_of([triangle], {"m": TEXTURED})
    for which in ("first", "second"):
        found = coordinates(call_glsl, scene, shares @ CORNERS, which)
        assert_allclose(found, shares @ uv, atol=2e-5)


BUMPY = {"type": "principled", "normal": {"image": "n.png"}}
TILT = np.array([0.6, 0.0, 0.8])  # of the normal, towards u


def bent(call_glsl: CallGlsl, scene: Scene, points: Any, normal: Any, **texture: Any) -> Any:
    """The normals that an image of one normal in tangent space gives."""
    image = np.ones((1, 1, 4))
    image[..., :3] = (np.asarray(normal) + 1) / 2
    material = Principled(normal={"image": "n.png", **texture})
    scene = scene.model_copy(update={"materials": {"m": material}})
    return call_glsl(
        "bent_normal(ray, surface_at(ray, hit))",
        "vec3",
        setup=SURFACE,
        scene=with_images(scene, {"n.png": image}),
        direction=directions_to(points),
    )


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize("normal", [[0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.48, -0.36, 0.8]])
def test_a_normal_is_bent_along_u_and_against_v(
    call_glsl: CallGlsl, face: str, normal: list[float]
) -> None:
    facing, u, v = (np.array(axis, float) for axis in FACES[face])
    expected = normal[0] * u - normal[1] * v + normal[2] * facing
    scene = scene_of([plane(-3 * facing, facing, "m")], {"m": BUMPY})
    found = bent(call_glsl, scene, points_between(-3 * facing, u, v, shares_of(20)), normal)
    assert_allclose(found, np.broadcast_to(expected, found.shape), atol=1e-3)
    flat = bent(call_glsl, scene, points_between(-3 * facing, u, v, shares_of(20)), [0, 0, 1])
    assert_allclose(flat, np.broadcast_to(facing, found.shape), atol=1e-6)


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_triangle_bends_them_by_its_coordinates(call_glsl: CallGlsl, mirrored: bool) -> None:
    """Whichever way its texture coordinates turn."""
    corners = np.array([[-2.0, -2, -3], [2, -2, -3], [0, 2, -3]])
    uv = corners[:, :2] * ([-1, -1] if mirrored else [1, -1])
    triangle = mesh((corners, np.array([[0, 1, 2]])), "m", uv=uv, smooth=False)
    scene = scene_of([triangle], {"m": BUMPY})
    found = bent(call_glsl, scene, [[0, 0, -3.0], [0.1, -0.3, -3]], [0.48, -0.36, 0.8])
    expected = [-0.48 if mirrored else 0.48, -0.36, 0.8]
    assert_allclose(found, np.broadcast_to(expected, found.shape), atol=1e-3)


def test_a_sphere_bends_them_by_its_longitude(call_glsl: CallGlsl) -> None:
    scene = scene_of([sphere([0, 0, 0], 2, "m")], {"m": BUMPY})
    found = bent(call_glsl, scene, [[0, 0, -1.0], [1.0, 0, 0]], TILT)
    assert_allclose(found, [[0.6, 0, -0.8], [0.8, 0, 0.6]], atol=1e-3)


TURNS: dict[str, dict[str, Any]] = {
    "turned": {"rotation": 90},
    "turned a little": {"rotation": 30, "scale": 3},
    "mirrored along u": {"scale": (-1, 1)},
    "mirrored along v": {"scale": (1, -2)},
    "turned and mirrored": {"rotation": -120, "scale": (-1, 1)},
}


@pytest.mark.parametrize("name", TURNS)
def test_an_image_that_is_turned_turns_its_normals(call_glsl: CallGlsl, name: str) -> None:
    """Along where u of the image grows, and against where its v does."""
    keys = TURNS[name]
    scene = scene_of([plane([0, 0, -3], [0, 0, 1], "m")], {"m": BUMPY})
    found = bent(call_glsl, scene, [[0.2, 0, -3.0]], [0.48, -0.36, 0.8], **keys)
    u, v = Texture(image="n.png", **keys).transform[:, :2]
    along, against = ([u[0], -u[1], 0], [-v[0], v[1], 0])  # v of the surface leads downwards
    expected = 0.48 * unit(along) - 0.36 * unit(against) + np.array([0, 0, 0.8])
    assert_allclose(found, [expected], atol=1e-3)


def unit(vector: Any) -> Any:
    return np.array(vector, float) / np.linalg.norm(vector)


@pytest.mark.parametrize("count", [1, 2])
def test_tangents_of_corners_go_before_those_of_triangles(
    call_glsl: CallGlsl, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file's tangents count: upwards here, in a mesh that is used once, or twice."""
    monkeypatch.setattr(instancing, "LEAST_SAVED", 1)
    corners = np.array([[-2.0, -2, 0], [2, -2, 0], [0, 2, 0]])
    uv, along = np.tile(corners[:, :2] * [1, -1], 2), np.tile([0.0, 2, 0], (3, 1))
    given = checked(MeshArrays(corners, [[0, 1, 2]], uv=uv, tangents=along))
    file = MeshFile(file="a.ply").read_as("0" * 64, given, None)
    thing = {"shape": "mesh", "file": file, "material": "m", "smooth": False, "rotate": [0, 0, 90]}
    shapes = [{**thing, "translate": [0, 0, -3.0 - far], "scale": 2} for far in range(count)]
    scene = scene_of(shapes, {"m": BUMPY})
    assert len(SceneFacts(scene).instances) == (2 if count == 2 else 0)
    found = bent(call_glsl, scene, [[0, 0, -3.0]], TILT)
    assert_allclose(found, [[-0.6, 0, 0.8]], atol=1e-3)


def test_strength_inclines_and_what_faces_inwards_is_left(call_glsl: CallGlsl) -> None:
    scene = scene_of([plane([0, 0, -3], [0, 0, 1], "m")], {"m": BUMPY})
    found = bent(call_glsl, scene, [[0, 0, -3.0]], TILT, strength=0.5)
    assert_allclose(found, [np.array([0.3, 0, 0.8]) / np.hypot(0.3, 0.8)], atol=1e-3)
    inwards = bent(call_glsl, scene, [[0, 0, -3.0]], [0.6, 0, -0.8])
    assert_allclose(inwards, [[0, 0, 1]])


@pytest.mark.parametrize("channel", ["r", "g", "b", "a"])
def test_a_channel_alone(call_glsl: CallGlsl, channel: str) -> None:
    scene = of_texture({"channel": channel}, 1, 1)
    value = random_image(1, 1)[0, 0, "rgba".index(channel)]
    found = call_glsl(
        "color_at(0, Coordinates(uv, uv))", "vec3", scene=scene, uv=np.zeros((1, 2), np.float32)
    )
    assert np.array_equal(found, [[value] * 3])
