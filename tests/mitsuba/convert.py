"""A scene of glrt in the words of Mitsuba 3: the dictionary that `mitsuba.load_dict` reads."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from glrt.core.errors import SceneError
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import Settings
from tests.mitsuba import media, metal, rough_glass
from tests.mitsuba.faces import is_seen_from_inside, refuse_coincident
from tests.mitsuba.near import EXTENT, Near, Vector, around, corners, length, near, normal_of, unit
from tests.mitsuba.skies import sky, sun
from tests.mitsuba.surfaces import surface_of
from tests.mitsuba.textured import mesh_of

ROULETTE_DEPTH = 5  # where it starts by Mitsuba's own choice
NEVER = 1 << 30
BLOCK = 64  # samples of a pixel among which samplers spread their points

# In lengths of Mitsuba's coordinates. A plane becomes a grid so large that the gap to the horizon
# is a small part of a pixel. Its outer cells are larger, since Mitsuba knows a point on a triangle
# to a part of the triangle's size; few, since they cost it time.
GRID = EXTENT * np.array([-(2.0**15), -8.0, 8.0, 2.0**15])
CELL = EXTENT * np.array([-1000.0, 1000.0])  # of a plane that may end
GAP = 5e-6 * EXTENT  # between the two faces of a lamp
CLIP = (1e-3, 2.0**20 * EXTENT)  # from the lens; Mitsuba renders nothing before it and beyond

Words = dict[str, Any]


class Liberties(NamedTuple):
    """Changes that make Mitsuba faster, and may hardly show."""

    one_sided: bool = False  # quads light their front alone
    finite: bool = False  # planes end far away, before the horizon
    native: bool = False  # rough metal is Mitsuba's own, whose shadowing is not correlated
    sampler: str = "independent"  # of the samplers of Mitsuba; all others take BLOCK samples


def convert(mi: Any, scene: Scene, settings: Settings, liberties: Liberties) -> Words:
    """The scene for Mitsuba, whose variant is set.

    Raises SceneError for what Mitsuba cannot show: coincident faces, and lamps without end.
    """
    refuse_coincident(scene)
    metal.register(mi.variant())
    rough_glass.register(mi.variant())
    at = near(scene)
    words = {
        "type": "scene",
        "integrator": {
            "type": media.integrator(scene),
            "max_depth": settings.bounces + 1,  # Mitsuba counts segments
            "rr_depth": ROULETTE_DEPTH if settings.roulette else NEVER,
        },
        "camera": {
            **_camera(mi, scene, settings, at, liberties.sampler),
            **media.around_camera(scene, at),
        },
    }
    bounds = media.bounds(scene, at)
    if any(map(any, scene.background_colors)):
        words["background"] = sky(mi, scene)
    if any(scene.sun_radiance):
        words["sun"] = sun(mi, scene, EXTENT)
    for index in scene.shown:
        item = scene.objects[index]
        surface = {
            **surface_of(scene, scene.finish(item), liberties.native),
            **bounds.get(index, {}),
        }
        for side, part in enumerate(_shape(mi, scene, item, surface, at, liberties)):
            words[f"object {index} {side}"] = part
    return words


def _camera(mi: Any, scene: Scene, settings: Settings, at: Near, sampler: str) -> Words:
    camera = scene.camera
    focus = camera.resolved_focus_distance * at.factor
    radius = focus * math.tan(math.radians(camera.defocus_angle) / 2)
    lens: Words = {"type": "perspective"}
    if radius:
        lens = {"type": "thinlens", "aperture_radius": radius, "focus_distance": focus}
    eye = at.point(camera.position)
    ahead = eye + EXTENT * unit(camera.view)
    return {
        **lens,
        "to_world": mi.ScalarTransform4f().look_at(eye, ahead, unit(camera.up)),
        "fov": camera.fov,
        "fov_axis": "y",
        "near_clip": CLIP[0],
        "far_clip": CLIP[1],
        "sampler": {"type": sampler, "sample_count": BLOCK},
        "film": {
            "type": "hdrfilm",
            "width": settings.width,
            "height": settings.height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
    }


def _shape(
    mi: Any, scene: Scene, item: Any, surface: Words, at: Near, liberties: Liberties
) -> Iterator[Any]:
    """The shape, or its two faces."""
    if isinstance(item, Sphere):
        yield from _sphere(scene, surface, item, at)
    elif isinstance(item, Plane):
        if scene.materials[item.material].emits:
            raise SceneError(f"material '{item.material}': Mitsuba has no lamp without end.")
        grid = _grid(item, at, CELL if liberties.finite else GRID)
        yield mesh_of(mi, surface, *grid)
    elif isinstance(item, Quad | Disk):
        for lift in _lifts(any(scene.emission_of(item)) and not item.is_one_sided, liberties):
            yield _face(mi, surface, item, at, lift)
    elif isinstance(item, Box | Cylinder):
        yield from _solid(mi, scene, surface, item, at)
    elif isinstance(item, Mesh):
        yield _triangles(mi, scene, surface, item, at)
    else:
        raise SceneError(f"shape '{item.shape}': the converter to Mitsuba does not know it.")


def _face(mi: Any, surface: Words, item: Quad | Disk, at: Near, lift: float) -> Any:
    """One face of a flat shape, lifted to its side: below 0, the back."""
    if isinstance(item, Quad):
        return _quad(mi, surface, item, at, lift)
    normal = normal_of(item)
    center = at.point(item.center) + lift * normal
    radius = item.radius * at.factor
    return {**surface, **_circle(mi, center, normal if lift >= 0 else -normal, radius)}


def _lifts(is_lamp: bool, liberties: Liberties) -> tuple[float, ...]:
    """The offsets of a flat shape's faces: a lamp has two, which face away from each other."""
    if not is_lamp:
        return (0.0,)
    return (GAP / 2,) if liberties.one_sided else (GAP / 2, -GAP / 2)


def _sphere(scene: Scene, surface: Words, item: Sphere, at: Near) -> Iterator[Words]:
    center, radius = at.point(item.center).tolist(), item.radius * at.factor
    ball = {"type": "sphere", "center": center, **surface}
    yield {**ball, "radius": radius}
    if any(scene.emission_of(item)) and is_seen_from_inside(item, scene):
        yield {**ball, "radius": radius - GAP, "flip_normals": True}


def _grid(item: Plane, at: Near, lines: Vector) -> tuple[Vector, list[list[int]]]:
    """Points and triangles of a plane, around the foot of the origin."""
    normal = normal_of(item)
    u, v = around(normal)
    foot = np.dot(at.point(item.point), normal) * normal
    points = [foot + x * u + y * v for y in lines for x in lines]
    side = len(lines)
    cells = [y * side + x for y in range(side - 1) for x in range(side - 1)]
    first = [[cell, cell + 1, cell + side + 1] for cell in cells]
    second = [[cell, cell + side + 1, cell + side] for cell in cells]
    return np.array(points), first + second


def _quad(mi: Any, surface: Words, item: Quad, at: Near, lift: float) -> Any:
    u, v = at.along(item.edge_u) / 2, at.along(item.edge_v) / 2
    center = np.mean([at.point(corner) for corner in corners(item)], axis=0)
    center += lift * normal_of(item)
    if lift < 0:
        u, v = v, u
    if abs(np.dot(u, v)) <= 1e-6 * length(u) * length(v):
        return {**surface, **_square(mi, center, u, v)}
    points = np.array([center - u - v, center + u - v, center + u + v, center - u + v])
    return mesh_of(mi, surface, points, [[0, 1, 2], [0, 2, 3]])  # a rectangle cannot be sheared


def _circle(mi: Any, center: Vector, normal: Vector, radius: float) -> Words:
    u, v = (radius * axis for axis in around(normal))
    return {"type": "disk", "to_world": _placed(mi, center, u, v, normal)}


def _placed(mi: Any, center: Vector, *axes: Vector) -> Any:
    matrix = np.eye(4)
    matrix[:3] = np.stack([*axes, center], axis=1)
    return mi.ScalarTransform4f(matrix)


def _solid(
    mi: Any, scene: Scene, surface: Words, item: Box | Cylinder, at: Near
) -> Iterator[Words]:
    """A box, or the wall and the ends of a cylinder; lamps shine outwards."""
    is_lamp = any(scene.emission_of(item))
    is_around = length(np.subtract(item.middle, scene.camera.position)) < item.reach
    if is_lamp and is_around:
        raise SceneError(f"material '{item.material}': Mitsuba's lamp would not shine inwards.")
    if isinstance(item, Box):
        halves = item.axes * item.halves[:, None] * at.factor
        yield {"type": "cube", "to_world": _placed(mi, at.point(item.middle), *halves), **surface}
        return
    ends, radius = [at.point(item.from_), at.point(item.to)], item.radius * at.factor
    wall = {"type": "cylinder", "p0": ends[0].tolist(), "p1": ends[1].tolist(), **surface}
    yield {**wall, "radius": radius}
    if item.capped:
        for end, outward in zip(ends, (-item.axis, item.axis), strict=True):
            yield {**surface, **_circle(mi, end, outward, radius)}
    elif is_lamp:
        yield {**wall, "radius": radius - GAP, "flip_normals": True}


def _triangles(mi: Any, scene: Scene, surface: Words, item: Mesh, at: Near) -> Any:
    """A mesh; a lamp shines outwards."""
    faces = item.triangles.faces if item.is_upright else item.triangles.faces[:, ::-1]
    is_two_sided = item.triangles.opening and not item.is_one_sided
    if any(scene.emission_of(item)) and is_two_sided:
        raise SceneError(f"material '{item.material}': Mitsuba's lamp would shine on one side.")
    normals = None
    if item.smooth:
        normals = item.world_normals
        normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    uv = None if item.triangles.uv is None else item.triangles.uv[:, :2]
    return mesh_of(mi, surface, at.point(item.world_vertices), faces, normals, uv)


def _square(mi: Any, middle: Vector, u: Vector, v: Vector) -> Words:
    return {"type": "rectangle", "to_world": _placed(mi, middle, u, v, unit(np.cross(u, v)))}
