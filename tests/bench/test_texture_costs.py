"""What textures cost: each choice is measured, and a table of ratios."""

import pytest

from bench import texture_costs
from glrt.gpu.context import Context


@pytest.mark.slow
def test_each_choice_is_measured(
    context: Context, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(texture_costs, "SIZE", 8)
    monkeypatch.setattr(texture_costs, "SAMPLES", 1)
    monkeypatch.setattr(texture_costs, "TEXELS", 4)
    times = texture_costs.times_of(context, 2)
    names = ["", *texture_costs.CHOICES]
    assert {name: len(seconds) for name, seconds in times.items()} == dict.fromkeys(names, 2)
    fixed = {name: [1.5 if name else 1.0] * 6 for name in names}
    monkeypatch.setattr(texture_costs, "times_of", lambda *_: fixed)
    assert texture_costs.main(["--rounds", "6"]) == 0
    assert capsys.readouterr().out.count("1.500 (1.500-1.500)") == len(texture_costs.CHOICES)
