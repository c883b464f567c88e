"""Grids of files become the density of a medium, and are saved and restored with it."""

from pathlib import Path

import numpy as np
import pytest

from glrt.core.errors import SceneError, UsageError
from glrt.image.sources import load
from glrt.scene.grids import grid_of
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.view.edits.grid_files import with_grid_file
from glrt.view.edits.media_edits import with_fog, with_medium_part
from tests.support.kept_windows import Opened, let_all_die, next_to
from tests.support.nvdb import nvdb_file

VALUES = np.random.default_rng(1).uniform(0.1, 4, (3, 4, 5)).astype(np.float32)
BALL = 5  # of cornell
FOG = with_fog(load("cornell"), BALL)


@pytest.fixture
def smoke(tmp_path: Path) -> Path:
    """A file of two grids."""
    (tmp_path / "clouds").mkdir()
    path = tmp_path / "clouds" / "smoke.nvdb"
    path.write_bytes(nvdb_file({"heat": VALUES + 1, "density": VALUES}))
    return path


def test_the_densest_voxel_is_as_dense_as_the_fog_was(tmp_path: Path) -> None:
    np.save(tmp_path / "smoke.npy", VALUES)
    found = with_grid_file(FOG, "fog", tmp_path / "smoke.npy")
    medium = found.media["fog"]
    assert medium.scattering == FOG.media["fog"].scattering
    assert medium.density
    assert medium.density.scale * VALUES.max() == pytest.approx(1, rel=1e-3)
    assert grid_of(found, "fog").voxels.shape == VALUES.shape


def test_another_grid_keeps_scale_and_box(tmp_path: Path, smoke: Path) -> None:
    np.save(tmp_path / "smoke.npy", VALUES)
    changes = {"scale": 3.0, "min": (0.0, 0.0, 0.0), "max": (1.0, 2.0, 3.0)}
    first = with_grid_file(FOG, "fog", tmp_path / "smoke.npy")
    first = with_medium_part(first, "fog", "density", changes)
    density = with_grid_file(first, "fog", smoke).media["fog"].density
    assert density
    assert density.file.file == "smoke.nvdb"
    assert {key: getattr(density, key) for key in changes} == changes


def test_among_several_grids_that_of_densities_is_taken_and_saved(
    tmp_path: Path, smoke: Path
) -> None:
    found = with_grid_file(FOG, "fog", smoke)
    assert found.media["fog"].density.grid == "density"  # type: ignore[union-attr]
    (tmp_path / "saved").mkdir()
    write_scene(found, tmp_path / "saved" / "scene.toml", None)
    again = load(tmp_path / "saved" / "scene.toml")
    assert again.media == found.media
    assert grid_of(again, "fog").top == grid_of(found, "fog").top


def test_a_file_without_such_a_grid_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "smoke.nvdb"
    path.write_bytes(nvdb_file({"heat": VALUES, "fuel": VALUES}))
    with pytest.raises(SceneError, match=r"smoke\.nvdb: the file holds 2 grids: 'heat', 'fuel'"):
        with_grid_file(FOG, "fog", path)


def test_half_a_space_takes_no_grid(smoke: Path) -> None:
    with pytest.raises(UsageError, match="what holds the medium has no end"):
        with_grid_file(with_fog(load("cornell"), 0), "fog", smoke)


def test_a_grid_comes_back_after_a_crash(
    tmp_path: Path, smoke: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    opened = Opened(tmp_path)
    try:
        opened.edit(lambda scene: with_grid_file(with_fog(scene, BALL), "fog", smoke))
        media = opened.session.scene.media
        opened.die()
        later = next_to(opened)
        later.recovery.restore()
        assert later.session.problem == ""
        assert later.session.scene.media == media
        assert grid_of(later.session.scene, "fog").voxels.shape == VALUES.shape
    finally:
        let_all_die()
