"""A scene as a glTF file, of what that format holds."""

import math
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import quoted
from glrt.core.version import VERSION
from glrt.scene.export.gltf_materials import MaterialWriter
from glrt.scene.export.left_out import LeftOut, Report
from glrt.scene.export.triangles import Ball, corners_around, triangles_of
from glrt.scene.lit_scene import SUN_GROUP
from glrt.scene.materials.nothing import Nothing
from glrt.scene.model_files.gltf.lights import LIT, LUMENS
from glrt.scene.model_files.gltf_file import GltfFile, Table
from glrt.scene.scene import Scene
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.sphere import Sphere

Floats = NDArray[np.float64]
_LIGHTS = "KHR_lights_punctual"
_SHEAR = 1e-6  # cosine between axes from which a matrix has no rotation and scale alone
_NEAR = 1e-3  # clipping in front of the camera, over the distance to what it looks at


def to_gltf(scene: Scene, is_binary: bool) -> tuple[bytes, list[str]]:
    """Return a .glb or .gltf file of a scene, and what is left out or changed, in words.

    Each object is a node. Analytic shapes become triangles. The file holds its buffer and images.
    """
    left_out = LeftOut()
    writer = _Writer(scene, left_out)
    writer.write()
    file = writer.file
    return (file.binary() if is_binary else file.text()), left_out.things


class _Writer:
    def __init__(self, scene: Scene, report: Report) -> None:
        self.file = GltfFile(f"glrt {VERSION}")
        self._scene, self._report = scene, report
        self._materials = MaterialWriter(self.file, scene, report)
        count = sum(isinstance(item, Sphere | Disk | Cylinder) for item in scene.visible)
        self._around = corners_around(count)
        self._nodes = list[int]()
        self._meshes = dict[object, int]()

    def write(self) -> None:
        """Add all that the scene holds."""
        scene = self._scene
        self._camera()
        for index in scene.shown:
            item = scene.objects[index]
            name = item.name or f"{item.shape} {index}"
            if isinstance(scene.materials[item.material], Nothing):
                self._report(f"the medium of {quoted(name)}")
            elif isinstance(item, Mesh):
                self._mesh(item, name)
            else:
                self._shape(item, name)
        self._sun()
        if self._has_light:
            self.file.note(LIT, True)
        self.file.add("scenes", {"nodes": self._nodes})
        if scene.background.is_pictured or any(map(any, scene.background_colors)):
            self._report("the background")
            if not self._has_light:
                self._report("all light with it, so that glrt renders the file in a studio")
        if scene.media_in_use:
            self._report("media")
        if scene.animation:
            self._report("the animation")

    def _node(self, table: Table) -> None:
        self._nodes.append(self.file.add("nodes", table))

    def _camera(self) -> None:
        camera, render = self._scene.camera, self._scene.render
        away = -np.array(camera.view, np.float64)
        near = _NEAR * float(np.linalg.norm(away))
        lens = {"yfov": math.radians(camera.fov), "aspectRatio": render.width / render.height}
        number = self.file.add(
            "cameras", {"type": "perspective", "perspective": {**lens, "znear": near}}
        )
        matrix = _facing(away, np.array(camera.up, np.float64), np.array(camera.position))
        self._node({"name": "camera", "camera": number, "matrix": _columns(matrix)})
        if camera.defocus_angle:
            self._report("the defocus of the camera")

    def _mesh(self, item: Mesh, name: str) -> None:
        mesh, material = item.triangles, self._materials.number(self._scene.finish(item))
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = item.linear, item.origin
        if item.hides_backs:
            self._report(f"the hidden backs of {quoted(name)}")
        key: tuple[object, ...] = item.form, material, item.smooth
        points, normals, faces = mesh.vertices, mesh.shading_normals, mesh.faces
        if _is_sheared(item.linear):  # no node of glTF turns and scales so
            key = *key, matrix.tobytes()
            points, normals = item.world_vertices, item.world_normals
            faces = faces if item.is_upright else faces[:, ::-1]
            matrix = np.eye(4)
        if key not in self._meshes:
            rows: dict[str, Any] = {"POSITION": points}
            if item.smooth:
                length = np.linalg.norm(normals, axis=1, keepdims=True)
                rows["NORMAL"] = np.divide(
                    normals, length, out=np.tile([0.0, 0, 1], (len(points), 1)), where=length > 0
                )
            if mesh.colors is not None:
                rows["COLOR_0"] = mesh.colors
            if mesh.uv is not None:
                rows |= {"TEXCOORD_0": mesh.uv[:, :2], "TEXCOORD_1": mesh.uv[:, 2:]}
            self._meshes[key] = self._added(rows, faces, material)
        self._node({"name": name, "mesh": self._meshes[key], "matrix": _columns(matrix)})

    def _shape(self, item: Any, name: str) -> None:
        found = triangles_of(item, self._ball, self._around)
        if found is None:
            self._report(f"{quoted(name)}, a {item.shape}")
            return
        if isinstance(item, Plane):
            self._report(f"the far parts of {quoted(name)}, a plane, which is a square")
        elif isinstance(item, Sphere | Disk | Cylinder):
            self._report(f"the roundness of a {item.shape}, which has {self._around} corners")
        rows: dict[str, Any] = {"POSITION": found.points, "NORMAL": found.normals}
        if found.uv is not None:
            rows["TEXCOORD_0"] = found.uv
        elif getattr(self._scene.materials[item.material], "anisotropy", 0):
            self._report(f"the direction of anisotropy on {quoted(name)}, a {item.shape}")
        number = self._materials.number(self._scene.finish(item))
        self._node({"name": name, "mesh": self._added(rows, found.faces, number)})

    def _added(self, rows: dict[str, Any], faces: NDArray[np.int64], material: int) -> int:
        attributes = {name: self.file.vertices(values) for name, values in rows.items()}
        primitive = {"attributes": attributes, "indices": self.file.corners(faces)}
        return self.file.add("meshes", {"primitives": [{**primitive, "material": material}]})

    @cached_property
    def _ball(self) -> Ball:
        """A ball about the camera that holds what has an end, and what it looks at."""
        eye = np.array(self._scene.camera.position)
        reaches = [
            float(np.linalg.norm(np.subtract(item.middle, eye))) + item.reach
            for item in self._scene.visible
            if math.isfinite(item.reach)
        ]
        return Ball(eye, max([*reaches, float(np.linalg.norm(self._scene.camera.view))]))

    @property
    def _has_light(self) -> bool:
        """Whether the file has a lamp, or the sun."""
        scene = self._scene
        lamps = any(any(scene.emission_of(item)) for item in scene.visible)
        return lamps or bool(scene.sun and any(scene.sun_radiance))

    def _sun(self) -> None:
        scene = self._scene
        if scene.sun is None or not any(scene.sun_radiance):
            return
        irradiance = np.array(scene.sun_irradiance) * scene.lights.get(SUN_GROUP, 1.0)
        strongest = float(irradiance.max())
        color = {"color": (irradiance / strongest).tolist(), "intensity": LUMENS * strongest}
        self.file.use(_LIGHTS)
        self.file.put("extensions", {_LIGHTS: {"lights": [{"type": "directional", **color}]}})
        matrix = _facing(scene.sun.towards, np.array([0.0, 1.0, 0.0]), np.zeros(3))
        light = {"extensions": {_LIGHTS: {"light": 0}}, "matrix": _columns(matrix)}
        self._node({"name": "sun", **light})
        self._report(f"the width of the sun, {scene.sun.angle:g} degrees")


def _facing(back: Floats, up: Floats, place: Floats) -> Floats:
    """Return the matrix, (4, 4), of what stands at a place with its z axis along `back`."""
    z = back / np.linalg.norm(back)
    x = np.cross(up, z)
    if not np.linalg.norm(x) > _SHEAR * np.linalg.norm(up):
        x = np.cross([1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    found = np.eye(4)
    found[:3] = np.stack([x, np.cross(z, x), z, place], axis=1)
    return found


def _columns(matrix: Floats) -> list[float]:
    columns: list[float] = matrix.T.ravel().tolist()
    return columns


def _is_sheared(linear: Floats) -> bool:
    axes = linear / np.linalg.norm(linear, axis=0)
    return bool(np.abs(axes.T @ axes - np.eye(3)).max() > _SHEAR)
