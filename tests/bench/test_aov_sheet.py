"""The picture of the page on AOVs: six different pictures, of which it keeps none behind."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from bench import aov_sheet


@pytest.mark.slow
def test_the_sheet_shows_the_picture_and_every_aov(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(aov_sheet, "SIZE", (48, 27))
    monkeypatch.setattr(aov_sheet, "SAMPLES", 4)
    file = tmp_path / "sheet.png"
    assert aov_sheet.main(["-o", str(file)]) == 0
    sheet = np.asarray(Image.open(file).convert("RGB")).astype(int)
    cells = [cell for row in np.array_split(sheet, 2) for cell in np.array_split(row, 3, axis=1)]
    colors = [cell.mean(axis=(0, 1)) for cell in cells]
    assert all(cell.std() > 10 for cell in cells)
    for number, color in enumerate(colors):
        assert all(np.abs(color - other).max() > 2 for other in colors[:number])
    assert [*tmp_path.iterdir()] == [file]
