"""Probes as balls on a sheet."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from bench import probe_sheet


@pytest.mark.slow
def test_the_sheet_has_a_dark_room_with_a_leak_and_one_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the test of visibility its walls shine."""
    monkeypatch.setattr(probe_sheet, "SIZE", 48)
    monkeypatch.setattr(probe_sheet, "SAMPLES", 16)
    file = tmp_path / "sheet.png"
    assert probe_sheet.main([str(file)]) == 0
    sheet = np.asarray(Pillow.open(file).convert("RGB")).astype(int)
    light, distances = np.array_split(sheet, 2)
    lit, leaking, dark = (part.mean() for part in np.array_split(light, 3, axis=1))
    assert min(lit, leaking) > 2 * dark
    colored = distances.max(axis=2) - distances.min(axis=2) > 60
    assert 0.01 < colored.mean() < 0.5
