"""The camera: far from the origin, and with narrow and wide fields of view."""

import numpy as np

from glrt.lab.rays import TEXTBOOK
from glrt.lab.scenes import matte, scene_of, sphere
from glrt.lab.sweep import Array, Lab, Sweep
from glrt.packing.scene_arrays import pack_camera
from glrt.rendering.shader_functions import World
from glrt.scene.scene import Scene


def offset(lab: Lab) -> Sweep:
    """Error of points hit on a sphere of radius 1, five units from a camera far from the origin."""
    x = np.logspace(0, 9, 19)
    rows = lab.count(1 << 12)
    random = np.random.default_rng(4)
    direction = random.uniform(-0.1, 0.1, (rows, 3))
    direction[:, 2] = -1
    direction = (direction / np.linalg.norm(direction, axis=1, keepdims=True)).astype(np.float32)
    ours, world = [], []
    for far in x:
        eye = far * np.array([0.6, 0.5, -0.62])
        center = eye + np.array([0.1, 0.2, -5])
        scene = scene_of(
            [sphere(center, 1, "grey")],
            {"grey": matte(0.5)},
            {"position": eye.tolist(), "look_at": center.tolist()},
        )
        truth = _hit_points(center - eye, direction)
        place = "surface_at(ray, Hit(sphere_distance(ray, sphere_at(0), 0), 0)).position"
        ray = "Ray ray = Ray(vec3(0.0), direction, NO_SHAPE, false);"
        point = lab.path(place, {"direction": direction}, World(scene), returns="vec3", setup=ray)
        ours.append(_distances(point - truth))
        given = {"direction": direction, "origin": eye[None], "center": center[None]}
        setup = "float t = textbook(origin, direction, center, 1.0);"
        point = lab.path(
            "origin + t * direction", given, returns="vec3", setup=setup, functions=TEXTBOOK
        )
        world.append(_distances(point - eye - truth))
    return Sweep(
        parameter="distance from the origin, in radii of the sphere",
        measure="error of the point hit, in radii\n(99 % quantile)",
        x=x.tolist(),
        chosen=("glrt: relative to the camera, in float64", ours),
        others={"world coordinates in float32": world},
        promise="at most 1e-5 of a radius",
        bound=[1e-5] * len(x),
    )


def _hit_points(center: Array, direction: Array) -> Array:
    """The points at which rays from the origin enter a sphere of radius 1, (n, 3), in float64."""
    d = direction.astype(np.float64)
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    along = d @ center
    t = along - np.sqrt(1 - (center @ center - along**2))
    points: Array = t[:, None] * d
    return points


def _distances(errors: Array) -> float:
    """The 99 % quantile of the lengths of error vectors, (n, 3)."""
    return float(np.quantile(np.linalg.norm(errors, axis=1), 0.99))


SIDE = 512  # pixels of the frame in `fov`
BOOK = "first + (pixel.x + jitter.x) * step_x + (pixel.y + jitter.y) * step_y - eye"


def fov(lab: Lab) -> Sweep:
    """Error of the directions of camera rays, for fields of view from 0.001 to 179.9 degrees.

    The camera is 700 units from the origin.
    """
    x = np.array([1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 90, 150, 179, 179.9])
    random = np.random.default_rng(6)
    rows = lab.count(1 << 12)
    pixel = random.integers(0, SIDE, (rows, 2)).astype(np.float32)
    seeds = {"seed": np.arange(rows, dtype=np.uint32), "pixel": pixel}
    setup = "Sampler rng = make_sampler(seed);"
    jitter = lab.path("next_2d(rng)", seeds, returns="vec2", setup=setup)
    ours, book = [], []
    for angle in x:
        eye = {"position": [300, 400, 500], "look_at": [297, 396, 500], "fov": angle}
        scene = scene_of([], {}, eye, background={"color": [1, 1, 1]})
        truth, camera = _camera_rays(scene, pixel + jitter.astype(np.float64))
        ray = f"camera_ray(frame.camera, vec2({SIDE}.0), pixel, rng).direction"
        found = lab.path(ray, seeds, World(scene), returns="vec3", setup=setup)
        ours.append(_pixels_off(found, truth, angle))
        given = {**camera, "pixel": pixel, "jitter": jitter}
        book.append(_pixels_off(lab.path(BOOK, given, returns="vec3"), truth, angle))
    return Sweep(
        parameter="vertical field of view, in degrees",
        measure=f"error of the direction, in pixels of {SIDE}\n(99 % quantile)",
        x=x.tolist(),
        chosen=("glrt: from the axes of the camera", ours),
        others={"textbook: pixels as points in world space": book},
        promise="at most a tenth of a pixel, from 0.03 degrees on",
        bound=[0.1] * len(x),
        guaranteed=(x >= 0.03).tolist(),
    )


def _camera_rays(scene: Scene, place: Array) -> tuple[Array, dict[str, Array]]:
    """Unit directions through points of the frame, (n, 3), and the camera of the textbook."""
    camera = pack_camera(scene.camera, 1.0)
    right, up, forward = (np.asarray(camera[name]) for name in ("right", "up", "forward"))
    tan = float(np.tan(np.radians(scene.camera.fov) / 2))
    flat = (2 * place / SIDE - 1) * tan
    rays = forward + flat[:, :1] * right - flat[:, 1:] * up
    eye = np.array(scene.camera.position)
    length = scene.camera.resolved_focus_distance
    book = {
        "first": eye + length * (forward - tan * right + tan * up),
        "step_x": length * 2 * tan / SIDE * right,
        "step_y": -length * 2 * tan / SIDE * up,
        "eye": eye,
    }
    return rays / np.linalg.norm(rays, axis=1, keepdims=True), {k: v[None] for k, v in book.items()}


def _pixels_off(found: Array, truth: Array, angle: float) -> float:
    """The 99 % quantile of the angles between directions, in angles of the middle pixel."""
    unit = found / np.linalg.norm(found.astype(np.float64), axis=1, keepdims=True)
    off = np.linalg.norm(np.cross(unit, truth), axis=1)
    return float(np.quantile(off, 0.99) / (2 * np.tan(np.radians(angle) / 2) / SIDE))
