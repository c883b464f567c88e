"""The studio of a lone model: its lamp lights the model, and what takes the studio away."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.materials.light import Light
from glrt.scene.scene import Scene
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from tests.support.gltf_files import Builder, square
from tests.support.meshes import box
from tests.support.renders import rendered

STUDIO = "studio light"
Array = np.ndarray[Any, Any]


def cube(builder: Builder, size: float, **material: Any) -> dict[str, Any]:
    """A primitive: a cube about the origin."""
    points, faces = box([-size / 2] * 3, [size / 2] * 3)
    return {
        "attributes": {"POSITION": builder.accessor(points)},
        "indices": builder.accessor(faces.ravel(), "u2"),
        "material": builder.add("materials", material),
    }


def scene_of_cubes(folder: Path, *, eye: Any = None, **small: Any) -> Scene:
    """A grey cube of edge 1 with a small one of a material before it, perhaps with a camera."""
    builder = Builder()
    builder.shown(cube(builder, 1.0, name="grey"))
    if small:
        builder.shown(cube(builder, 0.05, name="small", **small), translation=[0, 0, 0.7])
    if eye is not None:
        camera = {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}
        builder.add("nodes", {"camera": builder.add("cameras", camera), "translation": eye})
    (folder / "cubes.glb").write_bytes(builder.glb())
    return load(folder / "cubes.glb")


def lamp_of(scene: Scene) -> Quad:
    (lamp,) = [thing for thing in scene.objects if thing.name == STUDIO]
    assert isinstance(lamp, Quad)
    return lamp


EYES = {
    "its own": None,
    "of the file": [0.0, 0.2, 3.0],
    "far": [0.0, 0.0, 40.0],
    "inside": [0, 0, 0],
}


@pytest.mark.parametrize("name", EYES)
def test_the_lamp_faces_the_model_and_stays_out_of_the_picture(name: str, tmp_path: Path) -> None:
    scene = scene_of_cubes(tmp_path, eye=EYES[name])
    lamp = lamp_of(scene)
    u, v = np.array(lamp.edge_u), np.array(lamp.edge_v)
    middle = np.array(lamp.corner) + (u + v) / 2
    assert lamp.is_one_sided
    assert np.cross(u, v) @ -middle > 0, "the side that shines is that of the model"
    assert middle[1] > 0.5, "from above"
    eye = np.array(scene.camera.position)
    forward = (scene.camera.look_at - eye) / np.linalg.norm(scene.camera.look_at - eye)
    for corner in [np.array(lamp.corner) + a * u + b * v for a in (0, 1) for b in (0, 1)]:
        angle = np.degrees(np.arccos((corner - eye) @ forward / np.linalg.norm(corner - eye)))
        assert angle > scene.camera.fov / 2 * 2**0.5


def test_the_lamp_lights_the_model(tmp_path: Path, context: Context) -> None:
    """The baseline is the same scene with a lamp that emits nothing: the sky alone."""
    scene = scene_of_cubes(tmp_path)
    dark = {**scene.materials, STUDIO: Light(emission=(0, 0, 0))}
    sizes = {"width": 32, "height": 32, "aov": ("object",)}
    image = rendered(scene, context, 16, **sizes)
    without = rendered(scene.model_copy(update={"materials": dark}), context, 16, **sizes)
    seen = image.aovs["object"].value.reshape(32, 32) == 1
    assert image.radiance[seen].mean() > 1.5 * without.radiance[seen].mean()
    assert 0.3 < image.radiance[seen].mean() < 0.9, "neither dark nor burnt out"
    assert image.radiance.min() > 0.1, "nothing is black"


def test_the_model_stands_on_the_ground(tmp_path: Path, context: Context) -> None:
    """The ground behind it, at its foot, lies in its shadow."""
    scene = scene_of_cubes(tmp_path)
    (ground,) = [thing for thing in scene.objects if isinstance(thing, Plane)]
    assert -0.502 < ground.point[1] < -0.5
    eyes = {"behind": [0.53, -0.3, -0.53], "free": [-1.2, -0.3, 1.2]}
    seen = {}
    for name, (x, y, z) in eyes.items():
        view = {"position": (x, y, z), "look_at": (x, -1, z), "up": (0, 0, 1), "fov": 1.0}
        camera = scene.camera.model_copy(update=view)
        image = rendered(
            scene.model_copy(update={"camera": camera}), context, 64, width=2, height=2
        )
        seen[name] = image.radiance.mean()
    assert seen["behind"] < 0.6 * seen["free"]


def test_a_camera_below_the_model_sees_no_ground(tmp_path: Path) -> None:
    scene = scene_of_cubes(tmp_path, eye=[0, -3, 3])
    assert not [thing for thing in scene.objects if isinstance(thing, Plane)]
    assert lamp_of(scene)


def test_what_glows_little_leaves_the_studio(tmp_path: Path) -> None:
    """A headlight of 1.5 % of the surface; a lamp of the same size that lights a room does not."""
    assert STUDIO in scene_of_cubes(tmp_path, emissiveFactor=[1, 1, 1]).materials
    strength = {"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 40}}}
    assert STUDIO not in scene_of_cubes(tmp_path, emissiveFactor=[1, 1, 1], **strength).materials


def test_what_is_unlit_leaves_the_studio(tmp_path: Path) -> None:
    builder = Builder()
    material = builder.add("materials", {"extensions": {"KHR_materials_unlit": {}}})
    builder.shown(square(builder, material=material))
    (tmp_path / "label.glb").write_bytes(builder.glb())
    assert STUDIO in load(tmp_path / "label.glb").materials


def test_an_obj_file_that_lights_itself_has_no_studio(tmp_path: Path) -> None:
    points, faces = box([0, 0, 0], [1, 1, 1])
    lines = ["mtllib a.mtl", *(f"v {x} {y} {z}" for x, y, z in points)]
    lines += ["usemtl wall", *("f {} {} {}".format(*(face + 1)) for face in faces[2:])]
    lines += ["usemtl lamp", *("f {} {} {}".format(*(face + 1)) for face in faces[:2])]
    (tmp_path / "a.obj").write_text("\n".join(lines))
    for emission, has_studio in ((3, False), (0.03, True)):
        (tmp_path / "a.mtl").write_text(f"newmtl wall\nnewmtl lamp\nKe {emission}\n")
        assert (STUDIO in load(tmp_path / "a.obj").materials) == has_studio
