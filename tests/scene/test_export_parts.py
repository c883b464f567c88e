"""Files next to scene files of Mitsuba and pbrt, and how `glrt export` writes them."""

import io
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL.Image import open as opened

from glrt.cli.main import main
from glrt.scene.export.companions import exact_png, pfm_of, ply_of, vol_of
from glrt.scene.export.meshes import form_of
from glrt.scene.export.pbrt.skies import directions_of
from glrt.scene.images.codes import linear
from glrt.scene.model_files.ply import read_ply
from glrt.scene.shapes.mesh import Mesh
from tests.mitsuba.scenes import meshes
from tests.support.builders import glass, plane, scene_of
from tests.support.exported import (
    CAMERA,
    WHITE,
    as_pbrt,
    as_xml,
    found,
    read_pfm,
)
from tests.support.meshes import icosphere, mesh
from tests.support.sky_images import spot, under


def test_a_mirrored_mesh_faces_outwards_for_mitsuba(tmp_path: Path) -> None:
    one = mesh(icosphere(1), "m", scale=[-1, 1, 1], smooth=False)
    scene = scene_of([one], {"m": glass()}, CAMERA, **WHITE)
    (shape,) = as_xml(scene, tmp_path).findall("shape")
    matrix = np.array(value_of_matrix(shape)).reshape(4, 4)
    (path,) = (it.get("value") for it in shape if it.get("name") == "filename")
    read, _ = read_ply((tmp_path / str(path)).read_bytes())
    corners = (np.array(read.vertices) @ matrix[:3, :3].T)[np.array(read.faces)]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("nk,nk->n", across, corners.mean(axis=1)) > 0).all()


def value_of_matrix(shape: ElementTree.Element) -> list[float]:
    matrix = shape.find("transform/matrix")
    assert matrix is not None
    return [float(it) for it in str(matrix.get("value")).split()]


def test_a_bright_pixel_of_the_sky_stays_in_its_direction(tmp_path: Path) -> None:
    """Also proved by Mitsuba's own picture, in tests/crosscheck."""
    scene = under(spot(11, 1), plane([0, -1, 0], [0, 1, 0], "m"), rotation=30.0)
    azimuth, polar = 2 * np.pi * (11.5 / 16 - 0.5 - 30 / 360), np.pi * 1.5 / 8
    flat = np.sin(polar)
    expected = [flat * np.sin(azimuth), np.cos(polar), -flat * np.cos(azimuth)]
    lines = as_pbrt(scene, tmp_path)
    path = found(lines, "LightSource").parameters["string filename"]
    square = read_pfm(tmp_path / path)[..., 0]
    assert_allclose(
        directions_of(len(square))[square == square.max()].mean(axis=0), expected, atol=0.01
    )
    assert_allclose(square.mean(), 1 / 128 * np.pi / 2 * flat, rtol=0.02)
    emitter = as_xml(scene, tmp_path).find("emitter")
    assert emitter is not None
    (path,) = (it.get("value") for it in emitter if it.get("name") == "filename")
    image = read_pfm(tmp_path / str(path))[..., 0]
    row, column = np.argwhere(image == image.max()).mean(axis=0)
    assert_allclose(row / (len(image) - 1) * np.pi, polar, atol=0.01)
    assert_allclose((column + 0.5) / image.shape[1] * 2 * np.pi, azimuth % (2 * np.pi), atol=0.01)


def test_the_map_of_pbrt_covers_all_directions_evenly() -> None:
    towards = directions_of(64).reshape(-1, 3)
    assert_allclose(np.linalg.norm(towards, axis=1), 1)
    assert_allclose(towards.mean(axis=0), 0, atol=1e-12)
    assert_allclose(towards.T @ towards / len(towards), np.eye(3) / 3, atol=1e-3)
    assert_allclose(directions_of(3)[1, 1], [0, 0, 1], atol=1e-12)  # the middle
    assert directions_of(64)[32, 63, 0] > 0.9  # u to the right is +x, v downwards is +y
    assert directions_of(64)[63, 32, 1] > 0.9


def test_triangles_are_read_again() -> None:
    scene = meshes()
    item = scene.objects[2]
    assert isinstance(item, Mesh)
    form = form_of(item)._replace(uv=np.array(item.triangles.vertices[:, :2]))
    read, _ = read_ply(ply_of(form))
    assert_allclose(read.vertices, form.points, rtol=1e-6)
    assert np.array_equal(read.faces, form.faces)
    assert form.normals is not None
    assert read.normals is not None
    assert_allclose(read.normals, form.normals, atol=1e-6)


def test_images_are_exact_in_the_smallest_file_that_holds_them() -> None:
    codes = np.arange(256, dtype=np.uint8).reshape(16, 16, 1).repeat(3, axis=2)
    values = linear(codes, True).astype(np.float16)
    content = exact_png(values)
    assert content is not None

    assert np.array_equal(np.array(opened(io.BytesIO(content))), codes)
    assert exact_png(values * 0.7) is None
    pixels = np.arange(24, dtype=np.float32).reshape(2, 4, 3)
    assert pfm_of(pixels) == b"PF\n4 2\n-1.0\n" + pixels[::-1].tobytes()
    voxels = np.arange(72, dtype=np.float32).reshape(2, 3, 4, 3)
    assert vol_of(voxels)[:24] == b"VOL\x03" + np.array([1, 4, 3, 2, 3], "<i4").tobytes()
    assert vol_of(voxels)[48:] == voxels.tobytes()


@pytest.mark.parametrize("suffix", [".xml", ".pbrt"])
def test_the_command_writes_the_file_and_what_it_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    target = tmp_path / f"the $room{suffix}"
    assert main(["export", "spot", "-o", str(target), "--width", "64"]) == 0
    told = capsys.readouterr()
    assert "of 'gold'" in told.err
    assert "and the__room-files/" in told.out
    assert "the__room-files/mesh-" in target.read_text()
    first = {path.name: path.read_bytes() for path in (tmp_path / "the__room-files").iterdir()}
    assert main(["export", "spot", "-o", str(target), "--width", "64"]) == 0
    second = {path.name: path.read_bytes() for path in (tmp_path / "the__room-files").iterdir()}
    assert first == second


@pytest.mark.parametrize("suffix", [".xml", ".pbrt"])
def test_nothing_is_written_where_a_part_cannot_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    target = tmp_path / f"room{suffix}"
    (tmp_path / "room-files").write_text("no folder")
    assert main(["export", "cornell", "-o", str(target)]) == 2
    assert "room-files" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["room-files"]
