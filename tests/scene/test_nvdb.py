"""Grids of NanoVDB files are those of .npy files; what cannot be read is refused in words."""

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import ContentError, SceneError
from glrt.image.sources import load
from glrt.scene.files.named_grids import MOST_VOXELS
from glrt.scene.files.nvdb_grids import decode_nvdb
from glrt.scene.grids import grid_of
from tests.scene.test_vdb import SCENE, VALUES
from tests.support.nvdb import (
    BLOSC,
    HEAD,
    NOT_PACKED,
    ROOT,
    TILE,
    TREE,
    UPPER,
    ZIP,
    nvdb_file,
)

GOOD = nvdb_file({"density": VALUES})
FIRST = 16 + 176 + len("density") + 1 + HEAD + TREE  # the root
WARP = Path(__file__).parent / "references" / "warp.nvdb"


def decoded(content: bytes, name: str | None = None, most: int = MOST_VOXELS) -> Any:
    return decode_nvdb(content, name, most)


@pytest.mark.parametrize("codec", [NOT_PACKED, ZIP])
def test_a_nanovdb_file_is_the_array(codec: int) -> None:
    content = nvdb_file({"heat": VALUES[::-1], "density": VALUES}, codec)
    assert np.array_equal(decoded(content, "density"), VALUES)
    assert np.array_equal(decoded(content, "heat"), VALUES[::-1])
    assert np.array_equal(decoded(nvdb_file({"fog": VALUES}, codec) + content, "fog"), VALUES)


def test_the_grid_of_another_writer_is_read() -> None:
    """Warp 1.19 wrote (x + 2 y + 3 z) mod 7 + 1 in 20 x 13 x 9 voxels, and 0 up to whole leaves.

    That is warp.Volume.load_from_numpy with bg_value 0, then save_to_nvdb with codec "zip".
    """
    z, y, x = np.indices((9, 13, 20))
    found = decoded(WARP.read_bytes())
    assert found.shape == (16, 16, 24)
    assert np.array_equal(found[:9, :13, :20], (x + 2 * y + 3 * z) % 7 + 1)
    assert found.sum() == found[:9, :13, :20].sum()


def test_a_scene_names_a_nanovdb_file(tmp_path: Path) -> None:
    (tmp_path / "smoke.NVDB").write_bytes(GOOD)
    (tmp_path / "scene.toml").write_text(SCENE.replace("KEYS", 'file = "smoke.NVDB"'))
    assert grid_of(load(tmp_path / "scene.toml"), "smoke").voxels.shape == VALUES.shape


def test_the_box_is_that_of_active_voxels() -> None:
    values = np.zeros((40, 30, 50), np.float32)
    values[13:25, 4, 6:9] = 2.0
    values[14, 4, 7] = 0.0
    found = decoded(nvdb_file({"fog": values}))
    assert np.array_equal(found, values[13:25, 4:5, 6:9])


def other(place: int, value: bytes) -> bytes:
    return GOOD[:place] + value + GOOD[place + len(value) :]


@pytest.mark.parametrize(
    ("content", "name", "message"),
    [
        (GOOD[:-1], None, "no NanoVDB file of version 32, or it is damaged"),
        (GOOD[:100], None, "damaged"),
        (other(0, b"NanoVDB1"), None, "damaged"),
        (other(11, b"\x02"), None, "damaged"),
        (b"", None, "holds no grid"),
        (GOOD, "dnsity", "unknown grid 'dnsity'.*'density'"),
        (nvdb_file({"a": VALUES, "b": VALUES}), None, "2 grids: 'a', 'b'"),
        (nvdb_file({"a": VALUES}, kind=13), None, "'a' is of type Fp4, not of floats"),
        (nvdb_file({"a": VALUES}, kind=77), None, "of type number 77"),
        (nvdb_file({"a": VALUES}, BLOSC), None, "compressed by Blosc"),
        (nvdb_file({"a": VALUES * 0}), None, "no active voxels"),
        (other(FIRST + ROOT + 8, bytes(8) + b"\1"), None, "has tiles"),
        (other(FIRST + ROOT + TILE + 4000, b"\4"), None, "has tiles"),
        (other(FIRST + ROOT + TILE + UPPER + 500, b"\4"), None, "has tiles"),
        (other(FIRST - TREE + 6, b"\x40"), None, "damaged"),
        (other(FIRST - TREE, b"\xff" * 8), None, "damaged"),
        (other(FIRST - TREE + 32, b"\xff" * 4), None, "damaged"),
    ],
)
def test_what_is_no_grid_is_refused(content: bytes, name: str | None, message: str) -> None:
    with pytest.raises(ContentError, match=message) as error:
        decoded(content, name)
    assert "\n" not in str(error.value)


def test_a_grid_that_needs_too_much_memory_is_refused() -> None:
    with pytest.raises(ContentError, match=r"box around its voxels has 9,216, and 9,000"):
        decoded(GOOD, most=9000)
    with pytest.raises(ContentError, match=r"takes 1,099,511,627,776 bytes, and 184,549,376 are"):
        decoded(other(16, (1 << 40).to_bytes(8, "little")))


@pytest.mark.parametrize("codec", [NOT_PACKED, ZIP])
def test_damaged_files_are_read_or_refused(tmp_path: Path, codec: int) -> None:
    draw, whole = np.random.default_rng(2), nvdb_file({"density": VALUES[:9, :9, :9]}, codec)
    (tmp_path / "scene.toml").write_text(SCENE.replace("KEYS", 'file = "smoke.nvdb"'))
    for _ in range(60):
        content = bytearray(whole)
        for end in (300, 1100, len(whole)):
            for place in draw.integers(min(end, len(whole)), size=draw.integers(4)):
                content[place] = draw.integers(256)
        (tmp_path / "smoke.nvdb").write_bytes(content)
        with suppress(SceneError):  # nothing else comes out
            load(tmp_path / "scene.toml")
