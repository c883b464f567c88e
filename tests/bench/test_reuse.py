"""What reuse of points brings: noise over seeds, and its price."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from bench import reuse
from bench.reuse import Found


def test_noise_is_the_spread_over_seeds_and_gain_counts_its_square_and_time() -> None:
    random = np.random.default_rng(0).normal(size=(64, 32, 32, 3))
    one = Found(2 + 0.2 * random, [4.0] * 3)
    other = Found(2 + 0.4 * random, [2.0] * 3)
    assert one.noise == pytest.approx(0.1 / 1.01**0.5, rel=0.02)
    assert one.gain_over(other) == pytest.approx(2, rel=0.02)
    assert one.light[0] == pytest.approx(2, abs=4 * one.light[1])
    assert one.light[1] == pytest.approx(0.2 / (64 * 32 * 32 * 3) ** 0.5, rel=0.3)


@pytest.mark.slow
def test_a_small_run_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert reuse.main(["methods/white", "--size", "8", "--seeds", "2"]) == 0
    told = capsys.readouterr().out
    for way in reuse.WAYS:
        assert told.count(f"| methods/white | {way} |") == 1


@pytest.mark.slow
def test_the_row_has_six_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reuse, "ROW", (32, 16))
    monkeypatch.setattr(reuse, "MANY", 16)
    file = tmp_path / "row.jpg"
    assert reuse.main(["--sheet", str(file)]) == 0
    row = np.asarray(Pillow.open(file).convert("RGB")).astype(int)
    assert row.shape[1] == 1200
    lines = np.array_split(row, 2)
    assert all(p.mean() > 20 for line in lines for p in np.array_split(line, 3, axis=1))
