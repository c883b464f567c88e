"""The outline of an object as the camera sees it, as line segments in the picture.

Of a sphere it is the circle where rays touch it; of what has faces, the edges between those that
face the camera and those that do not, and the rims of open surfaces.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.memo import kept_for_the_same
from glrt.packing.scene_arrays import pack_camera
from glrt.scene.camera import Camera
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

Array = NDArray[np.float64]
Segments = NDArray[np.float64]  # (n, 2, 2): ends in shares of the picture, (0, 0) upper left

STEPS = 64  # of a circle
MOST_TRIANGLES = 200_000  # of a mesh whose own edges are looked at: beyond, those of its box
_NEAR = 1e-4  # of the distance to its middle: nearer to the camera's plane, lines are cut


class Faces(NamedTuple):
    """Flat faces that share edges: `vertices` (v, 3), `edges` (e, 2) and the faces beside each.

    `beside` (e, 2) are numbers of rows of `points` and `normals` (f, 3), -1 for none. The normals
    of some neighbours point to different sides of the surface: their edges are `turned` (e,).
    """

    vertices: Array
    edges: NDArray[np.intp]
    beside: NDArray[np.intp]
    turned: NDArray[np.bool_]
    points: Array
    normals: Array


def outline(shape: Shape, camera: Camera, aspect: float) -> Segments:
    """Where the object ends in the picture; `aspect` is width over height."""
    eye = np.array(camera.position)
    if isinstance(shape, Sphere):
        ends = _circle_seen(np.array(shape.center), shape.radius, eye)
    else:
        faces = _faces_of(shape)
        ends = faces.vertices[faces.edges[_is_outer(faces, eye)]]
    near = _NEAR * max(float(np.linalg.norm(np.array(shape.middle) - eye)), 1e-9)
    return projected(ends, camera, aspect, near)


def _circle_seen(center: Array, radius: float, eye: Array) -> Array:
    """(n, 2, 3): where rays from the eye touch a ball; nothing from inside."""
    away = center - eye
    square = float(away @ away)
    if square <= radius**2:
        return np.zeros((0, 2, 3))
    share = radius**2 / square
    axis = away / math.sqrt(square)
    return _circle(center - share * away, axis, radius * math.sqrt(1 - share))


def _circle(center: Array, axis: Array, radius: float) -> Array:
    """(STEPS, 2, 3): about an axis of length 1."""
    aside = np.eye(3)[np.argmin(np.abs(axis))]
    u = np.cross(axis, aside)
    u /= np.linalg.norm(u)
    angle = np.linspace(0, 2 * math.pi, STEPS + 1)[:, None]
    ring = center + radius * (np.cos(angle) * u + np.sin(angle) * np.cross(axis, u))
    return np.stack([ring[:-1], ring[1:]], axis=1)


def _is_outer(faces: Faces, eye: Array) -> NDArray[np.bool_]:
    """(e,): edges with a face towards the eye on one side alone, and rims."""
    is_towards = ((eye - faces.points) * faces.normals).sum(axis=1) > 0
    is_rim = (faces.beside < 0).any(axis=1)
    first, second = (is_towards[faces.beside[:, side]] for side in (0, 1))
    outer: NDArray[np.bool_] = is_rim | ((first != second) != faces.turned)
    return outer


def projected(ends: Array, camera: Camera, aspect: float, near: float) -> Segments:
    """Segments (n, 2, 3) in the picture, cut where they come nearer than `near` to its plane."""
    frame = {name: np.asarray(value) for name, value in pack_camera(camera, aspect).items()}
    axes = np.stack([frame[name] for name in ("right", "up", "forward")], axis=1)
    seen = (ends - np.array(camera.position)) @ axes
    seen = seen[(seen[..., 2] > near).any(axis=1)]
    a, b = seen[:, 0], seen[:, 1]
    a, b = _cut(a, b, near), _cut(b, a, near)
    x, y = (
        np.stack([end[:, k] / (end[:, 2] * float(frame[tan])) for end in (a, b)], axis=1)
        for k, tan in ((0, "tan_x"), (1, "tan_y"))
    )
    return np.stack([0.5 + 0.5 * x, 0.5 - 0.5 * y], axis=-1)


def _cut(end: Array, other: Array, near: float) -> Array:
    """The ends of segments, moved along them to where they are before the camera."""
    with np.errstate(all="ignore"):
        share = (near - end[:, 2]) / (other[:, 2] - end[:, 2])
        moved = end + share[:, None] * (other - end)
    return np.where((end[:, 2] < near)[:, None], moved, end)


@kept_for_the_same
def _faces_of(shape: Any) -> Faces:
    if isinstance(shape, Mesh):
        return _of_mesh(shape)
    return _FORMS[type(shape)](shape)


def _of_ring(corners: Array) -> Faces:
    """A flat face: each edge is a rim."""
    count = len(corners)
    edges = np.stack([np.arange(count), (np.arange(count) + 1) % count], axis=1)
    beside, turned = np.tile([0, -1], (count, 1)), np.zeros(count, bool)
    return Faces(corners, edges, beside, turned, corners[:1], np.ones((1, 3)))


def _of_quad(quad: Quad) -> Faces:
    corner, u, v = np.array(quad.corner), np.array(quad.edge_u), np.array(quad.edge_v)
    return _of_ring(np.array([corner, corner + u, corner + u + v, corner + v]))


def _of_disk(disk: Disk) -> Faces:
    axis = np.array(disk.normal) / np.linalg.norm(disk.normal)
    return _of_ring(_circle(np.array(disk.center), axis, disk.radius)[:, 0])


def _of_plane(plane: Plane) -> Faces:
    """A plane has no end: a square about its point, of edges of length 1."""
    axis = np.array(plane.normal) / np.linalg.norm(plane.normal)
    ring = _circle(np.array(plane.point), axis, math.sqrt(0.5))
    return _of_ring(ring[:: STEPS // 4, 0])


def _of_box(box: Box) -> Faces:
    return _of_corners(np.array(box.middle), box.axes * box.halves[:, None])


def _of_corners(middle: Array, halves: Array) -> Faces:
    """A box by its middle and half edges, a row each."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = middle + signs @ halves
    square = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    faces = np.concatenate([square[:, [0, 1, 2]], square[:, [0, 2, 3]]])
    return faces_of_triangles(corners, faces, np.tile(np.arange(6), 2))


def _of_cylinder(cylinder: Cylinder) -> Faces:
    low, high = np.array(getattr(cylinder, "from")), np.array(cylinder.to)
    axis = (high - low) / np.linalg.norm(high - low)
    below = _circle(low, axis, cylinder.radius)[:, 0]
    vertices = np.concatenate([below, below + (high - low), [low, high]])
    k = np.arange(STEPS)
    n = (k + 1) % STEPS
    wall = np.concatenate([np.stack([k, n, n + STEPS], 1), np.stack([k, n + STEPS, k + STEPS], 1)])
    caps = np.concatenate(
        [
            np.stack([n, k, np.full(STEPS, 2 * STEPS)], 1),
            np.stack([k + STEPS, n + STEPS, np.full(STEPS, 2 * STEPS + 1)], 1),
        ]
    )
    triangles = np.concatenate([wall, caps]) if cylinder.capped else wall
    flat = np.concatenate([np.tile(k, 2), np.repeat([STEPS, STEPS + 1], STEPS)])
    return faces_of_triangles(vertices, triangles, flat[: len(triangles)])


def _of_mesh(mesh: Mesh) -> Faces:
    triangles = mesh.triangles
    if len(triangles.faces) > MOST_TRIANGLES:
        low, high = triangles.box
        middle = mesh.linear @ ((low + high) / 2) + mesh.origin
        return _of_corners(middle, (mesh.linear * ((high - low) / 2)).T)
    return faces_of_triangles(mesh.world_vertices, _welded(triangles.vertices)[triangles.faces])


def _welded(vertices: Array) -> NDArray[np.intp]:
    """(v,): for each vertex the first one of its place, so that seams are no rims."""
    _, first, which = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    same: NDArray[np.intp] = first[which.reshape(-1)]
    return same


def faces_of_triangles(
    vertices: Array, triangles: NDArray[np.intp], flat: NDArray[np.intp] | None = None
) -> Faces:
    """Triangles (n, 3) as faces; `flat` (n,) numbers those that are one face together."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    sides = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    owners = np.tile(np.arange(len(triangles)), 3)
    kept = sides[:, 0] != sides[:, 1]  # of triangles that are no lines
    sides, owners = sides[kept], owners[kept]
    goes_up = sides[:, 0] < sides[:, 1]
    sides = np.sort(sides, axis=1)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides, owners, goes_up = sides[order], owners[order], goes_up[order]
    is_first = np.ones(len(sides), bool)
    is_first[1:] = (sides[1:] != sides[:-1]).any(axis=1)
    starts = np.flatnonzero(is_first)
    has_two = np.diff(np.append(starts, len(sides))) == 2
    other = np.minimum(starts + 1, len(sides) - 1)
    beside = np.stack([owners[starts], np.where(has_two, owners[other], -1)], axis=1)
    turned = has_two & (goes_up[starts] == goes_up[other])
    shown = np.ones(len(starts), bool)
    if flat is not None:
        shown = ~(has_two & (flat[beside[:, 0]] == flat[beside[:, 1]]))
    normals = np.cross(b - a, c - a)
    return Faces(vertices, sides[starts][shown], beside[shown], turned[shown], a, normals)


_FORMS: dict[type, Callable[[Any], Faces]] = {
    Quad: _of_quad,
    Disk: _of_disk,
    Plane: _of_plane,
    Box: _of_box,
    Cylinder: _of_cylinder,
}
