"""What methods with probes miss: told without the noise of pictures and truths."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from bench import probe_floors
from bench.probe_floors import floor_of
from bench.truth import Truth


def test_noise_is_no_floor() -> None:
    """Pictures a tenth too bright, with noise of their own."""
    first, second, one, other = 0.05 * np.random.default_rng(0).normal(size=(4, 128, 128, 3))
    floor = floor_of(
        (1.1 + one).astype("f4"), (1.1 + other).astype("f4"), Truth(1 + first, 1 + second)
    )
    assert floor.mean == pytest.approx(0.1, abs=0.01)
    assert floor.rms == pytest.approx(0.1, abs=0.005)
    assert floor.median == pytest.approx(0.1, abs=0.01)


@pytest.mark.slow
def test_a_small_run_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["methods/white", "--size", "8", "--seeds", "2", "--truth", "64", "--samples", "16"]
    assert probe_floors.main([*words, "--truths", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    for method in ("ddgi", "gather"):
        assert told.count(f"| methods/white | {method} |") == 4
    assert told.count("| methods/white | mis |") == 1


@pytest.mark.slow
def test_the_row_has_three_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(probe_floors, "ROW", (32, 16))
    file = tmp_path / "row.jpg"
    assert probe_floors.main(["--sheet", str(file)]) == 0
    row = np.asarray(Pillow.open(file).convert("RGB")).astype(int)
    assert row.shape[1] == 1200
    assert all(part.mean() > 20 for part in np.array_split(row, 3, axis=1))
