"""Ratios of pictures on the screen to a reference: the table, and its pictures."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Files

from bench import redraw
from bench.redraw import MOST_SEED, Compared, ratios
from glrt.denoise.denoising import Denoised
from glrt.image.image import Image
from glrt.rendering.history.temporal import WAYS

SIZE = (4, 6, 3)


def gray(code: int) -> Any:
    return np.full(SIZE, code, np.uint8)


def test_gains_are_over_the_first_mode_and_denoisers_see_the_last_view(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Off by 51 of 255: 20 log10(5) = 14.0 dB; by half of that: 6.0 more."""
    seeds: list[tuple[str, int, int]] = []

    def film(scene: Any, settings: Any, context: Any, samples: int, seed: int) -> Image:
        seeds.append((settings.denoise, samples, seed))
        black, white = np.zeros(SIZE, np.float32), np.ones(SIZE, np.float32)
        return Image(black, black, samples, denoising=Denoised(white, white, 0.0, 0.0))

    def shown(scenes: Any, settings: Any, context: Any, way: Any) -> Any:
        return gray(102 if way.mode == "reset" else 51) // (1 + (scenes[0] == scenes[-1]))

    monkeypatch.setattr(redraw, "_film", film)
    monkeypatch.setattr(redraw, "_shown", shown)
    ways = WAYS["reset"], WAYS["taa"]
    lines = [*ratios("cornell", None, Compared(ways, ["nlm"], 4, None, tmp_path))]  # type: ignore[arg-type]
    assert lines[2:] == [
        "| reset | 14.0 | +0.0 | 8.0 | +0.0 |",
        "| taa | 20.2 | +6.2 | 14.0 | +6.0 |",
        "| film, nlm | -0.0 | -14.0 | -0.0 | -8.0 |",
    ]
    assert seeds == 2 * [("none", redraw.TRUTH, MOST_SEED), ("nlm", 4, 17)]
    rows = {file.name: np.asarray(Files.open(file)) for file in tmp_path.iterdir()}
    assert sorted(rows) == ["cornell orbit.png", "cornell still.png"]
    assert rows["cornell orbit.png"][0, ::6, 0].tolist() == [102, 51, 255, 0]
