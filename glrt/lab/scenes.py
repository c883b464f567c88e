"""Builders of small scenes for sweeps, from the tables of scene files."""

from typing import Any

from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene

Table = dict[str, Any]


def matte(albedo: float) -> Table:
    """A grey Lambertian material."""
    return {"type": "lambertian", "color": [albedo] * 3}


def lamp(radiance: float, albedo: float = 0.0) -> Table:
    """A light of this radiance in all channels, which also scatters with this albedo."""
    return {"type": "light", "emission": [radiance] * 3, "color": [albedo] * 3}


def glass(ior: float) -> Table:
    """A smooth dielectric."""
    return {"type": "dielectric", "ior": ior}


def sphere(center: Any, radius: float, material: str) -> Table:
    """A sphere."""
    return {"shape": "sphere", "center": list(center), "radius": radius, "material": material}


def plane(point: Any, normal: Any, material: str) -> Table:
    """A plane."""
    return {"shape": "plane", "point": list(point), "normal": list(normal), "material": material}


def quad(corner: Any, edge_u: Any, edge_v: Any, material: str) -> Table:
    """A parallelogram."""
    edges = {"corner": list(corner), "edge_u": list(edge_u), "edge_v": list(edge_v)}
    return {"shape": "quad", "material": material, **edges}


def scene_of(
    objects: list[Table], materials: dict[str, Table], camera: Table | None = None, **more: Any
) -> Scene:
    """A scene; unless `camera` says otherwise, the camera is at the origin and looks along -z."""
    eye = {"position": [0, 0, 0], "look_at": [0, 0, -1], **(camera or {})}
    return parse_scene(
        {"camera": eye, "materials": materials, "objects": objects, **more}, "stress"
    )
