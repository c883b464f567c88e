"""Materials, cameras and lights of glTF files, and models as scenes."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.loading.scene_files import files_of
from glrt.scene.materials.light import Light
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.scene.warnings import cautions
from glrt.settings import settings_for
from tests.support.gltf_files import COLORS, Builder, square, textured_square
from tests.support.meshes import box
from tests.support.renders import rendered


def saved(folder: Path, builder: Builder) -> Path:
    path = folder / "thing.glb"
    path.write_bytes(builder.glb())
    return path


def loaded(folder: Path, **material: Any) -> Scene:
    """The scene of a square of a material."""
    builder = Builder()
    builder.shown(square(builder, material=builder.add("materials", {"name": "m", **material})))
    return load(saved(folder, builder))


def principled(scene: Scene, name: str = "thing.glb:m") -> Principled:
    material = scene.materials[name]
    assert isinstance(material, Principled)
    return material


def extended(name: str, **keys: Any) -> dict[str, Any]:
    return {"extensions": {f"KHR_materials_{name}": keys}}


NUMBERS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "nothing": ({}, {"color": (1, 1, 1), "metallic": 1, "roughness": 1, "alpha": 1, "ior": 1.5}),
    "factors": (
        {
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.1, 0.2, 0.3, 0.4],
                "metallicFactor": 0.25,
                "roughnessFactor": 0.75,
            }
        },
        {"color": (0.1, 0.2, 0.3), "metallic": 0.25, "roughness": 0.75, "alpha": 1},
    ),
    "blend": (
        {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.4]}},
        {"alpha": 0.4, "alpha_cutoff": None},
    ),
    "mask": ({"alphaMode": "MASK"}, {"alpha": 1, "alpha_cutoff": 0.5}),
    "emission": (
        {"emissiveFactor": [1, 0.5, 0], **extended("emissive_strength", emissiveStrength=8)},
        {"emission": (8, 4, 0)},
    ),
    "ior": (extended("ior", ior=1.33), {"ior": 1.33}),
    "specular": (
        extended("specular", specularFactor=0.5, specularColorFactor=[1, 0.5, 2]),
        {"specular": 0.5, "specular_color": (1, 0.5, 1)},
    ),
    "a pane": (extended("transmission", transmissionFactor=1), {"transmission": 1, "thin": True}),
    "a coat": (
        extended("clearcoat", clearcoatFactor=1, clearcoatRoughnessFactor=0.25),
        {"clearcoat": 1, "clearcoat_roughness": 0.25},
    ),
    "anisotropy": (
        extended("anisotropy", anisotropyStrength=0.5, anisotropyRotation=1.75 * math.pi),
        {"anisotropy": 0.5, "anisotropy_rotation": pytest.approx(-45)},
    ),
    "a film": (
        extended("iridescence", iridescenceFactor=0.5, iridescenceThicknessMaximum=250),
        {"iridescence": 0.5, "iridescence_ior": 1.3, "iridescence_thickness": 250},
    ),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_of_materials_are_kept(name: str, tmp_path: Path) -> None:
    keys, expected = NUMBERS[name]
    found = principled(loaded(tmp_path, **keys))
    assert {key: getattr(found, key) for key in expected} == expected


def test_textures_have_their_channels_and_factors(tmp_path: Path) -> None:
    builder = Builder()
    image = {"index": builder.texture(COLORS, wrapS=33648, wrapT=33071)}
    moved = {"KHR_texture_transform": {"scale": [2, 3], "offset": [0.5, 0], "rotation": math.pi}}
    material = {
        "pbrMetallicRoughness": {
            "baseColorTexture": {**image, "extensions": moved},
            "baseColorFactor": [0.5, 0.5, 0.5, 0.25],
            "metallicRoughnessTexture": {**image, "texCoord": 1},
            "roughnessFactor": 0.5,
        },
        "normalTexture": {**image, "scale": 2},
        "alphaMode": "BLEND",
    }
    shape = square(builder, material=builder.add("materials", {"name": "m", **material}))
    shape["attributes"]["TEXCOORD_1"] = shape["attributes"]["TEXCOORD_0"]
    builder.shown(shape)
    scene = load(saved(tmp_path, builder))
    found = principled(scene)
    assert found.color == (0.5, 0.5, 0.5)
    assert (found.metallic, found.roughness, found.alpha) == (1, 0.5, 0.25)
    textures = found.textures
    channels = {"color": None, "alpha": "a", "metallic": "b", "roughness": "g", "normal": None}
    assert {key: texture.channel for key, texture in textures.items()} == channels
    assert {texture.wrap for texture in textures.values()} == {("mirror", "clamp")}
    color = textures["color"]
    assert (color.scale, color.offset, round(color.rotation)) == ((2, 3), (0.5, 0), 180)
    assert textures["roughness"].uv == 1
    assert found.normal is not None
    assert found.normal.strength == 2
    assert_allclose(textures["roughness"].texels, COLORS / 255, rtol=1e-3)
    assert files_of(scene) == ["thing.glb"]


@pytest.mark.parametrize("code", [[33071], {}, "repeat", 7])
def test_a_wrap_that_is_no_code_is_the_usual_one(code: Any, tmp_path: Path) -> None:
    builder = Builder()
    image = {"index": builder.texture(COLORS, wrapS=code)}
    material = builder.add(
        "materials", {"name": "m", "pbrMetallicRoughness": {"baseColorTexture": image}}
    )
    builder.shown(square(builder, material=material))
    found = principled(load(saved(tmp_path, builder)))
    assert found.textures["color"].wrap == ("repeat", "repeat")


def test_glass_with_a_label(tmp_path: Path) -> None:
    builder = Builder()
    image = {"index": builder.texture(COLORS)}
    keys = {"transmissionFactor": 0.5, "transmissionTexture": image}
    material = {"name": "m", **extended("transmission", **keys)}
    builder.shown(square(builder, material=builder.add("materials", material)))
    found = principled(load(saved(tmp_path, builder)))
    assert found.transmission == 0.5
    assert found.textures["transmission"].channel == "r"


def test_an_emission_with_an_image(tmp_path: Path) -> None:
    builder = Builder()
    image = {"index": builder.texture(COLORS)}
    material = {"name": "m", "emissiveTexture": image, "emissiveFactor": [1, 1, 1]}
    builder.shown(square(builder, material=builder.add("materials", material)))
    scene = load(saved(tmp_path, builder))
    assert list(principled(scene).textures) == ["emission"]
    assert "studio light" in scene.materials, "a sign that glows lights no room"


def test_closed_glass_has_a_volume_and_open_glass_is_thin(tmp_path: Path) -> None:
    points, faces = box([0, 0, 0], [1, 1, 1])
    volume = {"thicknessFactor": 1, "attenuationColor": [1, 0, 0], "attenuationDistance": 2}
    glass = {
        "name": "m",
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": volume,
        },
    }
    builder = Builder()
    number = builder.add("materials", glass)
    attributes = {"POSITION": builder.accessor(points)}
    order = builder.accessor(faces.ravel(), "u1")
    builder.shown({"attributes": attributes, "indices": order, "material": number})
    closed = principled(load(saved(tmp_path, builder)))
    assert not closed.thin
    assert (closed.attenuation_color, closed.attenuation_distance) == ((1, 0, 0), 2)
    opened = loaded(tmp_path, **glass)
    assert (principled(opened).thin, principled(opened).roughness) == (True, 1)
    told = " ".join(cautions(opened, settings_for(opened.render)))
    assert "the volume of glass that is not closed" in told


def test_what_is_left_out_is_reported_once(tmp_path: Path) -> None:
    builder = textured_square(
        extensions={"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0}}}
    )
    builder.json["extensionsUsed"] = ["KHR_materials_clearcoat", "EXT_strange"]
    scene = load(saved(tmp_path, builder))
    (told,) = cautions(scene, settings_for(scene.render))
    assert "thing.glb: left out: EXT_strange, clearcoatTexture" in told


@pytest.mark.slow
def test_what_is_unlit_looks_the_same_in_every_light(tmp_path: Path, context: Context) -> None:
    builder = textured_square(extensions={"KHR_materials_unlit": {}})
    scene = load(saved(tmp_path, builder))
    camera = scene.camera.model_copy(
        update={"position": (0.75, 0.75, 1), "look_at": (0.75, 0.75, 0), "fov": 10.0}
    )
    image = rendered(scene.model_copy(update={"camera": camera}), context, 4, width=2, height=2)
    assert_allclose(image.radiance, np.broadcast_to([0, 1, 0], (2, 2, 3)), atol=1e-6)


def test_a_camera_of_the_file_is_taken(tmp_path: Path) -> None:
    builder = Builder()
    builder.shown(square(builder))
    camera = {"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 2, "znear": 1}}
    turned = {"translation": [0, 0, 5], "rotation": [0, 0, math.sin(0.5), math.cos(0.5)]}
    builder.add("nodes", {"camera": builder.add("cameras", camera), **turned})
    scene = load(saved(tmp_path, builder))
    assert scene.camera.position == (0, 0, 5)
    assert_allclose(scene.camera.look_at, (0, 0, 4), atol=1e-12)
    assert_allclose(scene.camera.up, (-math.sin(1), math.cos(1), 0), atol=1e-12)
    assert scene.camera.fov == pytest.approx(math.degrees(0.5))
    assert (scene.render.width, scene.render.height) == (512, 256)


def with_light(folder: Path, **light: Any) -> Scene:
    builder = Builder()
    builder.shown(square(builder))
    builder.json["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
    extension = {"KHR_lights_punctual": {"light": 0}}
    builder.add("nodes", {"translation": [0, 0, 3], "extensions": extension})
    return load(saved(folder, builder))


@pytest.mark.slow
def test_a_point_light_has_its_intensity(tmp_path: Path, context: Context) -> None:
    """683 candela, 1 W/sr, above the corner of a white square: radiance cos / (pi d^2)."""
    scene = with_light(tmp_path, type="point", intensity=683.0, color=[1, 0.5, 0])
    (lamp,) = [thing for thing in scene.objects if isinstance(thing, Sphere)]
    material = scene.materials[lamp.material]
    assert isinstance(material, Light)
    assert_allclose(np.array(material.emission) * math.pi * lamp.radius**2, (1, 0.5, 0))
    white = Principled(color=(1, 1, 1), specular=0.0)
    name = "thing.glb:without material"
    camera = scene.camera.model_copy(
        update={"position": (0.5, 0.5, 1), "look_at": (0.5, 0.5, 0), "fov": 10.0}
    )
    scene = scene.model_copy(
        update={"materials": {**scene.materials, name: white}, "camera": camera}
    )
    image = rendered(scene, context, 64, width=1, height=1, bounces=1)
    assert_allclose(image.radiance[0, 0, 0], 3 / 9.5**1.5 / math.pi, rtol=0.02)


def test_a_spot_and_a_sun(tmp_path: Path) -> None:
    cone = {"innerConeAngle": 0.25, "outerConeAngle": 0.5}
    scene = with_light(tmp_path, type="spot", intensity=683.0, spot=cone)
    material = scene.materials["light 1"]
    assert isinstance(material, Light)
    assert material.cone is not None
    assert material.cone.axis == (0, 0, -1)
    assert_allclose((material.cone.inner, material.cone.outer), np.degrees([0.25, 0.5]))
    sun = with_light(tmp_path, type="directional", intensity=1366.0).sun
    assert sun is not None
    assert sun.irradiance == (2, 2, 2)
    assert_allclose(sun.towards, (0, 0, 1))


WRONG: dict[str, dict[str, Any]] = {
    "lights[0].type is none of point, spot and directional": {"type": "area"},
    "lights[0].intensity must be a number": {"type": "point", "intensity": -1},
    "lights[0].color must be a list of 3 numbers": {"type": "point", "color": 1},
}


@pytest.mark.parametrize("message", WRONG)
def test_wrong_lights_are_refused(message: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        with_light(tmp_path, **WRONG[message])
    assert message in str(caught.value)


def test_a_model_without_lights_stands_in_a_studio(tmp_path: Path, context: Context) -> None:
    scene = loaded(tmp_path)
    (lamp,) = [thing for thing in scene.objects if isinstance(thing, Quad)]
    assert lamp.name == "studio light"
    for size in (1.0, 1e-3, 1e4):
        builder = Builder()
        builder.shown(square(builder), scale=[size] * 3, translation=[7 * size, 0, 0])
        found = load(saved(tmp_path, builder))
        image = rendered(found, context, 64, width=32, height=32, aov=("object",))
        there = image.aovs["object"].value.reshape(32, 32) == 1
        assert 0.1 < there.mean() < 0.6, "the model is in the picture, and all of it"
        assert not there[[0, -1]].any()
        assert 0.2 < image.radiance[there].mean() < 1.5, "neither dark nor burnt out"


def test_an_emitting_model_needs_no_studio(tmp_path: Path) -> None:
    assert "studio light" not in loaded(tmp_path, emissiveFactor=[1, 1, 1]).materials
