"""Grids of OpenVDB files are those of .npy files; what cannot be read is refused in words."""

import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.grids import grid_of
from glrt.scene.scene import Scene
from glrt.scene.schema.tables import toml_text
from tests.support.renders import rendered
from tests.support.vdb import vdb_file

SCENE = """
format = 1

[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]

[background]
color = [1, 1, 1]

[media.smoke]
absorption = [1, 1, 1]
density = { KEYS }

[materials.none]
type = "none"

[[objects]]
shape = "box"
min = [-1, -1, -1]
max = [1, 1, 1]
material = "none"
medium = "smoke"
"""
VALUES = np.random.default_rng(1).uniform(0.1, 4, (20, 9, 17)).astype(np.float32)
NAMED = 'file = "smoke.vdb", grid = "density"'


def scene_with(folder: Path, keys: str, content: bytes | None = None) -> Scene:
    """Load the scene with these keys of its density."""
    if content is not None:
        (folder / "smoke.vdb").write_bytes(content)
    (folder / "scene.toml").write_text(SCENE.replace("KEYS", keys))
    return load(folder / "scene.toml")


def test_an_openvdb_file_is_the_same_picture_as_an_array(context: Context, tmp_path: Path) -> None:
    np.save(tmp_path / "smoke.npy", VALUES)
    content = vdb_file({"heat": VALUES[::-1], "density": VALUES})
    both = [scene_with(tmp_path, keys, content) for keys in ('file = "smoke.npy"', NAMED)]
    npy, vdb = (grid_of(it, "smoke") for it in both)
    assert np.array_equal(npy.voxels, vdb.voxels)
    assert npy.top == vdb.top
    first, second = (rendered(it, context, 4, bounces=0).radiance for it in both)
    assert np.array_equal(first, second)
    assert first.std() > 0.01


def test_a_file_with_one_grid_needs_no_name(tmp_path: Path) -> None:
    content = vdb_file({"fog": VALUES})
    found = scene_with(tmp_path, 'file = "smoke.vdb"', content)
    assert grid_of(found, "smoke").voxels.shape == VALUES.shape


def test_the_box_is_that_of_active_voxels(tmp_path: Path) -> None:
    values = np.zeros((20, 9, 17), np.float32)
    values[3:5, 4, 6:9] = 2.0
    grid = grid_of(scene_with(tmp_path, 'file = "smoke.vdb"', vdb_file({"fog": values})), "smoke")
    assert grid.voxels.shape == (2, 1, 3)
    assert grid.top == 2.0


def test_two_grids_of_a_file_differ(tmp_path: Path) -> None:
    content = vdb_file({"heat": 2 * VALUES, "density": VALUES})
    density = scene_with(tmp_path, NAMED, content)
    heat = scene_with(tmp_path, 'file = "smoke.vdb", grid = "heat"')
    assert density != heat
    assert grid_of(heat, "smoke").top == 2 * grid_of(density, "smoke").top
    assert 'grid = "heat"' in toml_text(heat)


GOOD = vdb_file({"density": VALUES[:9, :9, :9]})


@pytest.mark.parametrize(
    ("content", "keys", "message"),
    [
        (GOOD[:-100], NAMED, r"no OpenVDB file that tinyvdb can read, or it is damaged"),
        (GOOD[:9], NAMED, "damaged"),
        (b"\x93NUMPY" + GOOD, NAMED, "damaged"),
        (GOOD, 'file = "smoke.vdb", grid = "dnsity"', r"unknown grid 'dnsity'.*'density'\?"),
        (vdb_file({"a": VALUES, "b": VALUES}), 'file = "smoke.vdb"', "2 grids: 'a', 'b'"),
        (vdb_file({"density": VALUES[:1] * 0}), NAMED, "no active voxels"),
        (vdb_file({"density": -VALUES}), NAMED, r"voxel \[0, 0, 0\] is below 0"),
        (vdb_file({"density": VALUES * np.float32(np.nan)}), NAMED, "is not finite"),
        (GOOD, 'file = "smoke.npy", grid = "density"', "`grid` chooses among the grids"),
        (GOOD, 'file = "smoke.vdb", grid = 1', r"media\.smoke\.density\.grid"),
    ],
    ids=["cut", "head", "other", "misspelt", "two", "empty", "negative", "NaN", "npy", "number"],
)
def test_what_is_no_grid_of_densities_is_refused(
    tmp_path: Path, content: bytes, keys: str, message: str
) -> None:
    np.save(tmp_path / "smoke.npy", VALUES)
    with pytest.raises(SceneError, match=message) as error:
        scene_with(tmp_path, keys, content)
    assert "media.smoke.density" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_grid_with_tiles_is_refused(tmp_path: Path) -> None:
    """A bit in the mask of values of an inner node is a cube of 8 voxels of one density."""
    content = bytearray(GOOD)
    inner = content.index(b"\x06", content.index(b"\x06") + 4 * 32768) - 512
    content[inner + 100] |= 1
    with pytest.raises(SceneError, match="has tiles"):
        scene_with(tmp_path, NAMED, bytes(content))


def test_without_tinyvdb_it_says_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "tinyvdb", None)
    with pytest.raises(SceneError, match=r"-m pip install .*\[volumes\]"):
        scene_with(tmp_path, NAMED, GOOD)


def test_damaged_files_are_read_or_refused(tmp_path: Path) -> None:
    draw = np.random.default_rng(2)
    for _ in range(40):
        content: Any = bytearray(GOOD)
        for place in draw.integers(len(GOOD), size=draw.integers(1, 20)):
            content[place] = draw.integers(256)
        for place in draw.integers(300, size=draw.integers(3)):
            content[place] = draw.integers(256)
        with suppress(SceneError):  # nothing else comes out
            scene_with(tmp_path, NAMED, bytes(content))
