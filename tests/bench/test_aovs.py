"""What AOVs cost: a row a scene, and a ratio for each choice."""

import pytest

from bench import aovs
from glrt.gpu.context import Context
from glrt.image.sources import load


@pytest.mark.slow
def test_a_row_has_a_ratio_for_each_choice(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(aovs, "SIZE", 16)
    monkeypatch.setattr(aovs, "SAMPLES", 4)
    times = aovs.times_of(load("sky"), context, 2)
    assert {name: len(seconds) for name, seconds in times.items()} == dict.fromkeys(
        ["", *aovs.CHOICES], 2
    )
    fixed = {"": [1.0] * 6, "albedo, normal": [1.1] * 6, "all five": [1.25] * 6}
    fixed["bounces"] = [2.0] * 6
    monkeypatch.setattr(aovs, "times_of", lambda *_: fixed)
    told = aovs.row("sky", load("sky"), context, 6)
    assert told == "| sky | 1.100 (1.100-1.100) | 1.250 (1.250-1.250) | 2.000 (2.000-2.000) |"
