"""Scenes in a few words, for tests."""

from typing import Any

from glrt.plan.features import everything
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene

EVERYTHING = everything()

_FLAGS = [name for name, value in EVERYTHING.items() if value is True]
_NOTHING = {**EVERYTHING, **dict.fromkeys(_FLAGS, False)}
FEATURE_SETS: dict[str, dict[str, bool | int]] = {
    "everything": EVERYTHING,
    "nothing": _NOTHING,
    "everything, and shared places": {**EVERYTHING, "HAS_COINCIDENT": True},
    **{f"only {name}": {**_NOTHING, name: True} for name in _FLAGS},
    **{f"all but {name}": {**EVERYTHING, name: False} for name in _FLAGS},
}

MATTE = {"type": "lambertian", "color": [0.5, 0.5, 0.5]}


def lamp(radiance: float = 1.0, albedo: float = 0.0, **more: Any) -> dict[str, Any]:
    """A material that emits and reflects the same in all channels."""
    return {"type": "light", "emission": [radiance] * 3, "color": [albedo] * 3, **more}


def glass(ior: float = 1.5, **more: Any) -> dict[str, Any]:
    """A dielectric."""
    return {"type": "dielectric", "ior": ior, **more}


def sphere(center: Any, radius: float, material: str) -> dict[str, Any]:
    """A sphere."""
    return {"shape": "sphere", "center": list(center), "radius": radius, "material": material}


def plane(point: Any, normal: Any, material: str) -> dict[str, Any]:
    """A plane."""
    return {"shape": "plane", "point": list(point), "normal": list(normal), "material": material}


def quad(corner: Any, edge_u: Any, edge_v: Any, material: str) -> dict[str, Any]:
    """A parallelogram."""
    edges = {"corner": list(corner), "edge_u": list(edge_u), "edge_v": list(edge_v)}
    return {"shape": "quad", "material": material, **edges}


def disk(center: Any, normal: Any, radius: float, material: str) -> dict[str, Any]:
    """A flat disk."""
    place = {"center": list(center), "normal": list(normal), "radius": radius}
    return {"shape": "disk", "material": material, **place}


def box(low: Any, high: Any, material: str, rotate: Any = (0, 0, 0)) -> dict[str, Any]:
    """A box, turned about its centre."""
    corners = {"min": list(low), "max": list(high), "rotate": list(rotate)}
    return {"shape": "box", "material": material, **corners}


def cylinder(
    start: Any, end: Any, radius: float, material: str, capped: bool = True
) -> dict[str, Any]:
    """A cylinder."""
    ends = {"from": list(start), "to": list(end), "radius": radius, "capped": capped}
    return {"shape": "cylinder", "material": material, **ends}


def room_of_planes(material: str, half: float = 1.0) -> list[dict[str, Any]]:
    """Six planes that face inwards, around the origin."""
    normals = [[s if i == axis else 0 for i in range(3)] for axis in range(3) for s in (-1, 1)]
    return [plane([-half * c for c in n], n, material) for n in normals]


def box_of_quads(material: str, half: float = 1.0) -> list[dict[str, Any]]:
    """Six quads around the origin."""
    faces = []
    for axis in range(3):
        u, v = [0.0] * 3, [0.0] * 3
        u[(axis + 1) % 3] = v[(axis + 2) % 3] = 2 * half
        for side in (-half, half):
            corner = [-half] * 3
            corner[axis] = side
            faces.append(quad(corner, u, v, material))
    return faces


def scene_of(
    objects: list[dict[str, Any]],
    materials: dict[str, dict[str, Any]],
    camera: dict[str, Any] | None = None,
    **tables: Any,
) -> Scene:
    """A scene from tables as in a file; the camera stands in the origin and looks along -z."""
    eye = {"position": [0, 0, 0], "look_at": [0, 0, -1], **(camera or {})}
    data = {"camera": eye, "materials": materials, "objects": objects, **tables}
    return parse_scene(data, "test")
