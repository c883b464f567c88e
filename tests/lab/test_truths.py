"""Scenes of stress cases whose radiance is known, as files for any renderer."""

import json
from pathlib import Path

import pytest

from glrt.cli.main import main
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.lab.sweep import SIGMAS, mean_of
from glrt.lab.truths import truths
from tests.support.renders import rendered


def test_scenes_with_a_closed_form_are_written_with_it(tmp_path: Path) -> None:
    assert main(["stress", "--scenes", str(tmp_path)]) == 0
    told = json.loads((tmp_path / "truths.json").read_text())
    assert set(told) == {"albedo", "bulb", "bulb-bare", "depth", "skim", "layers"}
    assert told["bulb-bare"]["radiance"] == 0.5 * 0.16**2 * (1 + 0.5 * (1 - 0.16**2))
    for name, row in told.items():
        assert all((tmp_path / file).is_file() for file in row["files"])
        assert load(tmp_path / f"{name}.toml").render.width == row["width"]
    assert told["bulb"]["files"] == ["bulb.toml", "bulb.xml", "bulb.pbrt"]
    assert told["albedo"]["files"] == ["albedo.toml"]  # its walls are lamps without end
    assert told["depth"]["files"] == ["depth.toml", "depth.pbrt"]  # Mitsuba's gas would not glow


def test_cases_without_a_closed_form_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["stress", "seeds", "--scenes", str(tmp_path / "new")]) == 2
    assert "these do: albedo, bulb" in capsys.readouterr().err
    assert not (tmp_path / "new").exists()


@pytest.mark.slow
def test_scenes_with_a_closed_form_have_its_radiance(context: Context) -> None:
    for truth in truths():
        samples = 2 if truth.name == "albedo" else 2048  # all of its paths agree
        way = {"sampler": "independent", "roulette": False, **truth.settings}
        mean, stderr = mean_of(rendered(truth.scene, context, samples, **way))
        assert abs(mean / truth.radiance - 1) < SIGMAS * stderr / truth.radiance + 2e-4, truth.name
