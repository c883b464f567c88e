"""Lights and cameras of USD files."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glrt
from tests.support.usd_files import layer, left_out, moved, placed, prim, scene_of, square

pytest.importorskip("pxr", reason="usd-core is not installed")

DOWN = placed(("double3", "translate", "(1, 3, 2)"), ("float", "rotateX", "-90"))


def lamp(scene: glrt.Scene, name: str) -> tuple[Any, Any]:
    """The object and the material of a light."""
    (thing,) = [it for it in scene.objects if it.name == f"light {name}"]
    return thing, scene.materials[thing.material]


def test_lamps_have_their_radiance_and_place(tmp_path: Path) -> None:
    """Radiance is intensity times 2^exposure times color, over the area where normalized."""
    bright = "float inputs:intensity = 3\nfloat inputs:exposure = 2\n"
    red = "color3f inputs:color = (1, 0.5, 0)\n"
    normal = "bool inputs:normalize = 1\n"
    text = (
        square()
        + prim("SphereLight", "ball", bright + red + "float inputs:radius = 2" + moved(0, 9, 0))
        + prim("SphereLight", "even", normal + "float inputs:radius = 2" + moved(9, 9, 0))
        + prim("RectLight", "panel", bright + "float inputs:width = 4\n" + DOWN)
        + prim("RectLight", "sized", normal + "float inputs:width = 4\n" + moved(0, 20, 0))
        + prim("DiskLight", "spot", "float inputs:radius = 2\n" + normal + DOWN)
        + prim("CylinderLight", "tube", "float inputs:length = 4\n" + normal + moved(0, 30, 0))
    )
    scene = scene_of(tmp_path, layer(text))
    assert scene.background.color in (None, (0, 0, 0))
    thing, material = lamp(scene, "ball")
    assert (thing.center, thing.radius, material.emission) == ((0, 9, 0), 2, (12, 6, 0))
    assert lamp(scene, "even")[1].emission == pytest.approx((1 / (16 * math.pi),) * 3)
    thing, material = lamp(scene, "panel")
    u, v = np.array(thing.edge_u), np.array(thing.edge_v)
    assert np.allclose(thing.corner + (u + v) / 2, (1, 3, 2))
    assert np.allclose(np.cross(u, v), (0, -4, 0))  # area, and it shines down
    assert (thing.emission_side, material.emission) == ("front", (12, 12, 12))
    assert lamp(scene, "sized")[1].emission == (0.25, 0.25, 0.25)
    thing, material = lamp(scene, "spot")
    assert np.allclose(thing.normal, (0, -1, 0))
    assert (thing.emission_side, thing.radius) == ("front", 2)
    assert material.emission == pytest.approx((1 / (4 * math.pi),) * 3)
    thing, material = lamp(scene, "tube")
    assert (thing.from_, thing.to) == ((-2, 30, 0), (2, 30, 0))
    assert material.emission == pytest.approx((1 / (4 * math.pi),) * 3)


def test_units_change_no_radiance(tmp_path: Path) -> None:
    """In centimetres the lamp of 2 units has a radius of 2 cm, and the same radiance."""
    own = "bool inputs:normalize = 1\nfloat inputs:radius = 2"
    scene = scene_of(tmp_path, layer(square() + prim("SphereLight", "ball", own), unit=0.01))
    thing, material = lamp(scene, "ball")
    assert thing.radius == pytest.approx(0.02)
    assert material.emission == pytest.approx((1 / (16 * math.pi),) * 3)


def test_the_sun_has_its_irradiance_and_what_is_not_known_is_reported(tmp_path: Path) -> None:
    """Radiance times the solid angle, or the intensity where normalized."""
    own = "float inputs:intensity = 1000\nfloat inputs:angle = 2\n"
    other = "bool inputs:normalize = 1\nfloat inputs:intensity = 3"
    sky = prim("DomeLight", "sky", "color3f inputs:color = (0.5, 1, 2)")
    unread = prim("PortalLight", "door") + prim("SphereLight", "dim", "float inputs:diffuse = 0.5")
    turned = placed(("float", "rotateX", "-30"))
    text = square() + prim("DistantLight", "sun", own + turned)
    scene = scene_of(tmp_path, layer(text + prim("DistantLight", "b", other) + sky + unread))
    assert scene.sun
    assert np.allclose(scene.sun.towards, (0, 0.5, math.cos(math.pi / 6)))
    assert scene.sun.irradiance == pytest.approx(
        (1000 * math.pi * math.sin(math.pi / 180) ** 2,) * 3
    )
    assert scene.sun.angle == 2
    assert scene.background.color == (0.5, 1, 2)
    told = left_out(scene)
    assert "PortalLight" in told
    assert "diffuse of lights" in told
    assert "directional lights but the first" in told


def test_a_lamp_of_a_temperature_and_a_cone(tmp_path: Path) -> None:
    """A flame of 2000 K is red; the cone opens from the share of its softness."""
    own = """
    bool inputs:enableColorTemperature = 1
    float inputs:colorTemperature = 2000
    float inputs:shaping:cone:angle = 40
    float inputs:shaping:cone:softness = 0.5
    """
    about = 'prepend apiSchemas = ["ShapingAPI"]'
    scene = scene_of(tmp_path, layer(square() + prim("SphereLight", "flame", own, about)))
    material = lamp(scene, "flame")[1]
    red, green, blue = material.emission
    assert red > green > blue >= 0
    assert (material.cone.inner, material.cone.outer) == (20, 40)
    assert np.allclose(material.cone.axis, (0, 0, -1))


def test_the_image_of_the_sky_stands_as_usd_has_it(tmp_path: Path) -> None:
    """Its middle lies in +z of the light, and rows run along y."""
    pixels = np.zeros((4, 8, 3), np.float32)
    pixels[:, 4:] = (1, 0, 0)
    (tmp_path / "sky.hdr").write_bytes(radiance_file(pixels))
    for degrees, turn in ((0, 180), (90, -90)):
        own = "asset inputs:texture:file = @sky.hdr@\n" + placed(("float", "rotateY", str(degrees)))
        found = scene_of(tmp_path, layer(square() + prim("DomeLight", "sky", own)))
        assert found.background.image
        assert found.background.image.file == "sky.hdr"
        assert found.background.rotation is not None
        assert math.remainder(found.background.rotation - turn, 360) == pytest.approx(0, abs=1e-6)


def radiance_file(pixels: np.ndarray) -> bytes:
    """A Radiance file without compression."""
    height, width = pixels.shape[:2]
    rows = np.zeros((height, width, 4), np.uint8)
    rows[..., :3] = (pixels * 128).clip(0, 255)
    rows[..., 3] = 129
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    return head.encode() + rows.tobytes()


CAMERA = """
    float focalLength = 50
    float horizontalAperture = 36
    float verticalAperture = 24
    float fStop = 2.5
    float focusDistance = 400
"""


def test_a_camera_sees_as_in_the_file(tmp_path: Path) -> None:
    """50 mm over 36 x 24 mm at f/2.5, in a file in centimetres with z up."""
    place = placed(("double3", "translate", "(100, -500, 200)"), ("float", "rotateX", "90"))
    text = square() + prim("Camera", "eye", CAMERA + place)
    scene = scene_of(tmp_path, layer(text, up="Z", unit=0.01))
    camera = scene.camera
    assert camera.position == pytest.approx((1, 2, 5))
    assert np.allclose(camera.view, (0, 0, -1))
    assert np.allclose(camera.up, (0, 1, 0))
    assert camera.fov == pytest.approx(math.degrees(2 * math.atan(12 / 50)))
    assert camera.focus_distance == pytest.approx(4)
    radius = 0.05 / 2.5 / 2  # of the lens, in metres
    assert camera.defocus_angle == pytest.approx(math.degrees(2 * math.atan(radius / 4)))
    assert (scene.render.width, scene.render.height) == (512, 341)


def test_a_scene_file_sees_by_a_camera_of_a_usd_file(tmp_path: Path) -> None:
    """As by one of a glTF file, and with a mesh of it."""
    place = placed(("double3", "translate", "(0, 1, 5)"))
    text = square() + prim("Camera", "eye", CAMERA + place)
    (tmp_path / "room.usda").write_text(layer(text))
    (tmp_path / "room.toml").write_text(
        'background = { color = [1, 1, 1] }\n[camera]\nfile = "room.usda"\nnode = "eye"\n'
        '[materials.grey]\ntype = "lambertian"\ncolor = [0.5, 0.5, 0.5]\n'
        '[[objects]]\nshape = "mesh"\nfile = "room.usda"\nmaterial = "grey"\n'
    )
    scene = glrt.load(tmp_path / "room.toml")
    assert scene.camera.position == pytest.approx((0, 1, 5))
    assert len(scene.meshes[0].triangles.faces) == 2
