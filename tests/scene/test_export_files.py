"""Scene files of Mitsuba and pbrt: what they hold, and what is reported."""

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.image.sources import load
from glrt.scene.export.mitsuba.file import to_mitsuba
from glrt.scene.export.pbrt.file import to_pbrt
from glrt.settings import settings_for
from tests.mitsuba.scenes import everything, solids
from tests.support.builders import box, disk, glass, lamp, plane, quad, scene_of, sphere
from tests.support.every_feature import still_life
from tests.support.exported import (
    CAMERA,
    WHITE,
    as_pbrt,
    as_xml,
    companions_of,
    found,
    left_out,
    value,
)
from tests.support.media import filled, medium
from tests.support.meshes import icosphere, mesh


def test_the_camera_keeps_its_field_of_view_lens_and_crop(tmp_path: Path) -> None:
    camera = CAMERA | {"defocus_angle": 4.0, "focus_distance": 5.0}
    scene = scene_of([sphere([0, 0, 0], 1, "m")], {"m": glass()}, camera, **WHITE)
    size = {"width": 40, "height": 80, "samples": 9, "bounces": 6, "crop": (4, 5, 10, 20)}
    sensor = as_xml(scene, tmp_path, **size).find("sensor")
    assert sensor is not None
    assert sensor.get("type") == "thinlens"
    radius = 5 * np.tan(np.radians(2))
    for name, expected in {"fov": 35, "aperture_radius": radius, "focus_distance": 5}.items():
        assert_allclose(value(sensor, name), expected)
    film = sensor.find("film")
    assert film is not None
    crop = ("crop_offset_x", "crop_offset_y", "crop_width", "crop_height")
    assert [value(film, it) for it in ("width", "height", *crop)] == [
        [40],
        [80],
        [4],
        [5],
        [10],
        [20],
    ]
    lines = as_pbrt(scene, tmp_path, **size)
    lens = found(lines, "Camera").parameters
    narrow = 2 * np.degrees(np.arctan(np.tan(np.radians(17.5)) / 2))  # of the shorter side
    assert_allclose(lens["float fov"], narrow)
    assert_allclose(lens["float lensradius"], radius)
    assert found(lines, "Film").parameters["integer pixelbounds"] == [4, 14, 5, 25]
    assert found(lines, "Sampler").parameters["integer pixelsamples"] == [9]
    assert found(lines, "Integrator").parameters["integer maxdepth"] == [6]
    assert found(lines, "LookAt").numbers == (1, 2, 6, 0, 0.5, 0, 0, 1, 0)


def test_a_wide_picture_has_the_vertical_field_of_view_in_both(tmp_path: Path) -> None:
    scene = scene_of([sphere([0, 0, 0], 1, "m")], {"m": glass()}, CAMERA, **WHITE)
    lens = found(as_pbrt(scene, tmp_path, width=80, height=40), "Camera").parameters
    assert_allclose(lens["float fov"], 35)
    sensor = as_xml(scene, tmp_path, width=80, height=40).find("sensor")
    assert sensor is not None
    assert value(sensor, "fov") == [35]
    (axis,) = (it for it in sensor if it.get("name") == "fov_axis")
    assert axis.get("value") == "y"


def test_lamps_emit_as_their_group_says_on_their_sides(tmp_path: Path) -> None:
    light = {"type": "light", "emission": [8.0, 4.0, 2.0], "color": [0.1, 0.2, 0.3], "group": "l"}
    square = quad([-2, 3, -2], [4, 0, 0], [0, 0, 4], "lamp")
    for side, faces in {"both": 2, "front": 1}.items():
        one = square | {"emission_side": side}
        scene = scene_of([one], {"lamp": light}, CAMERA, lights={"l": 0.5})
        shapes = as_xml(scene, tmp_path).findall("shape")
        assert len(shapes) == faces
        for emitter in (shape.find("emitter") for shape in shapes):
            assert emitter is not None
            assert value(emitter, "radiance") == [4, 2, 1]
        lines = as_pbrt(scene, tmp_path)
        shining = found(lines, "AreaLightSource").parameters
        assert shining["rgb L"] == [4, 2, 1]
        assert shining["bool twosided"] == (side == "both")
        reflected = found(lines, "MakeNamedMaterial", "lamp").parameters["rgb reflectance"]
        assert reflected == [0.1, 0.2, 0.3]


def test_both_formats_hold_the_same_numbers(tmp_path: Path) -> None:
    scene = everything()
    root, lines = as_xml(scene, tmp_path), as_pbrt(scene, tmp_path)
    balls = [it for it in root.findall("shape") if it.get("type") == "sphere"]
    radii = sorted(value(it, "radius")[0] for it in balls)
    spheres = [it.parameters for it in lines if it.name == "Shape" and it.texts == ("sphere",)]
    assert sorted(it["float radius"][0] for it in spheres) == radii
    colors = {
        tuple(value(it, "reflectance")) for it in root.iter("bsdf") if _has(it, "reflectance")
    }
    painted = {tuple(it.parameters.get("rgb reflectance", ())) for it in lines}
    assert (0.8, 0.75, 0.7) in colors & painted
    indices = {value(it, "int_ior")[0] for it in root.iter("bsdf") if _has(it, "int_ior")}
    assert indices == {1.5}
    assert found(lines, "MakeNamedMaterial", "glass").parameters["float eta"] == [1.5]
    alphas = [value(it, "alpha")[0] for it in root.iter("bsdf") if _has(it, "alpha")]
    assert alphas == found(lines, "MakeNamedMaterial", "rough").parameters["float roughness"]


def _has(element: ElementTree.Element, name: str) -> bool:
    return any(it.get("name") == name for it in element)


def test_media_keep_their_coefficients_and_their_sides(tmp_path: Path) -> None:
    tint = {"attenuation_color": [0.5, 0.25, 1.0], "attenuation_distance": 2.0}
    things = [
        filled(box([-9, -9, -9], [9, 9, 9], "")),
        sphere([0, 0, 0], 1, "g"),
        sphere([0, 3, 0], 0.5, "lamp"),
    ]
    fog = medium([0.2, 0.3, 0.4], [0.05, 0.1, 0.0], g=0.5)
    materials = {"g": glass(1.5, **tint), "lamp": lamp(1)}
    scene = scene_of(things, materials, CAMERA, media={"fog": fog})
    root = as_xml(scene, tmp_path)
    media = {str(it.get("id")): it for it in root.findall("medium")}
    ball = next(it for it in root.findall("shape") if it.get("type") == "sphere")
    sides = {
        str(it.get("name")): media[str(it.get("id"))]
        for it in ball
        if it.get("name") in ("interior", "exterior")
    }
    assert_allclose(value(sides["interior"], "sigma_t"), -np.log([0.5, 0.25, 1]) / 2, atol=1e-11)
    assert value(sides["interior"], "albedo") == [0, 0, 0]
    assert_allclose(value(sides["exterior"], "sigma_t"), [0.25, 0.4, 0.4])
    assert_allclose(value(sides["exterior"], "albedo"), [0.8, 0.75, 1])
    phase, sensor = sides["exterior"].find("phase"), root.find("sensor")
    assert phase is not None
    assert value(phase, "g") == [0.5]
    assert sensor is not None
    inside = sensor.find("ref")
    assert inside is not None
    assert media[str(inside.get("id"))] is sides["exterior"]
    lines = as_pbrt(scene, tmp_path)
    words = found(lines, "MakeNamedMedium", "fog").parameters
    assert words["rgb sigma_s"] == [0.2, 0.3, 0.4]
    assert words["rgb sigma_a"] == [0.05, 0.1, 0.0]
    assert words["float g"] == [0.5]
    pairs = [it.texts for it in lines if it.name == "MediumInterface"]
    assert pairs == [("", "fog"), ("", ""), ("fog", ""), ("g (tint)", "fog")]


def test_meshes_of_one_form_are_held_once(tmp_path: Path) -> None:
    ball = icosphere(1)
    parts = [mesh(ball, "m", translate=[k, 0, 0]) for k in range(3)]
    parts.append(mesh(ball, "m", scale=[-1, 1, 1], translate=[5, 0, 0]))  # mirrored
    scene = scene_of(parts, {"m": glass(1.4)}, CAMERA, **WHITE)
    root = as_xml(scene, tmp_path)
    kinds = [it.get("type") for it in root.findall("shape")]
    assert kinds == ["shapegroup", "instance", "instance", "instance", "ply"]
    lines = as_pbrt(scene, tmp_path)
    assert [it.name for it in lines].count("ObjectInstance") == 4
    assert [it.texts for it in lines if it.name == "Shape"] == [("plymesh",)]


def test_names_are_escaped(tmp_path: Path) -> None:
    name = 'a "b" <c> & -- \\d --- é]'
    ball = sphere([0, 0, 0], 1, name) | {"name": name}
    scene = scene_of([ball], {name: glass()}, CAMERA, title=name, **WHITE)
    assert len(as_xml(scene, tmp_path).findall("shape")) == 1
    lines = as_pbrt(scene, tmp_path)
    assert found(lines, "MakeNamedMaterial").texts == (name,)


@pytest.mark.parametrize("write", [to_mitsuba, to_pbrt])
def test_equal_scenes_are_equal_files(tmp_path: Path, write: Any) -> None:
    texts = [
        write(still_life(), settings_for(still_life().render), companions_of(tmp_path))
        for _ in "ab"
    ]
    assert texts[0] == texts[1]


def test_what_the_formats_cannot_hold_is_reported(tmp_path: Path) -> None:
    materials = {
        "m": {"type": "metal", "color": [0.9, 0.9, 0.9], "roughness": 0.5},
        "g": glass(1.5, priority=1),
        "f": glass(1.5, roughness=0.5),
        "p": {"type": "principled", "clearcoat": 1.0},
        "brass": {"type": "principled", "metallic": 1.0, "roughness": 0.5},
        "spot": lamp(1) | {"cone": {"axis": [0, -1, 0], "inner": 10, "outer": 20}},
    }
    parts = [
        sphere([0, 0, 0], 1, "g"),
        sphere([0, 5, 0], 1, "f"),
        sphere([9, 5, 0], 1, "m"),
        sphere([9, 9, 0], 1, "p"),
        sphere([9, 13, 0], 1, "brass"),
        plane([0, -2, 0], [0, 1, 0], "spot"),
    ]
    scene = scene_of(parts, materials, CAMERA, **WHITE)
    both = ("cone of 'spot'", "priority of 'g'", "facets of 'f'", "a lamp without end")
    lost = "light that facets of 'brass' send to each other"
    for words in (*both, "facets of 'm'", "exact surface of 'p'", "coat of 'p'", lost):
        assert words in left_out(scene, tmp_path)
    for words in (*both, "exact angles of 'm'", "exact surface of 'p'", "coat of 'p'"):
        assert words in left_out(scene, tmp_path, to_pbrt)


def test_what_the_formats_hold_is_not_reported(tmp_path: Path) -> None:
    things = [it.model_dump() for it in solids().objects if it.material != "rough"]
    materials = {n: it.model_dump() for n, it in solids().materials.items() if n != "rough"}
    scene = scene_of(things, materials, CAMERA, **WHITE)
    assert left_out(scene, tmp_path) == ""


def test_matte_principled_surfaces_are_exact(tmp_path: Path) -> None:
    paint = {"type": "principled", "color": [0.2, 0.4, 0.6], "specular": 0.0}
    scene = scene_of([sphere([0, 0, 0], 1, "p")], {"p": paint}, CAMERA, **WHITE)
    for write in (to_mitsuba, to_pbrt):
        assert left_out(scene, tmp_path, write) == ""
    words = found(as_pbrt(scene, tmp_path), "MakeNamedMaterial", "p").parameters
    assert words == {"string type": "diffuse", "rgb reflectance": [0.2, 0.4, 0.6]}


def test_a_disk_is_round_unless_it_is_painted(tmp_path: Path) -> None:
    board = {"type": "lambertian", "color": {"checker": [[1, 0, 0], [0, 0, 1]]}}
    flat = disk([0, 0, 0], [0, 1, 1], 2, "m")
    for material, kind in ((glass(), "disk"), (board, "ply")):
        pane = {"m": material if kind == "ply" else {"type": "lambertian", "color": [1, 1, 1]}}
        scene = scene_of([flat], pane, CAMERA, **WHITE)
        (shape,) = as_xml(scene, tmp_path).findall("shape")
        assert shape.get("type") == kind
        assert ("roundness" in left_out(scene, tmp_path)) == (kind == "ply")


def test_bundled_scenes_are_read_strictly(tmp_path: Path) -> None:
    for name in ("weekend", "drink", "stage", "gloss", "painted"):
        scene = load(name)
        assert as_xml(scene, tmp_path).findall("shape")
        assert any(it.name == "Shape" for it in as_pbrt(scene, tmp_path))
