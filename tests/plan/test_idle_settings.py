"""Settings that change nothing are named, and those alone."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.cli.reports.warnings import even
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.image.sources import load
from glrt.plan.idle_settings import idle
from glrt.settings import Settings, settings_for

WITHOUT: dict[str, dict[str, Any]] = {  # settings by which one has no effect
    "effects": {"method": "ddgi"},
    "roulette": {"method": "phong"},
    "particles": {"caustics": "off"},
    "aimed": {"caustics": "off"},
    "linked": {"caustics": "off"},
    "probes": {"method": "hybrid", "effects": ("shadows",)},
    "reuse": {"method": "gather"},
    "unbiased": {"method": "resampled", "reuse": "none"},
    "march_step": {"method": "mis"},
}
WITH: dict[str, dict[str, Any]] = {
    "effects": {"method": "hybrid"},
    "roulette": {"method": "whitted"},
    "particles": {"caustics": "on"},
    "aimed": {"caustics": "on"},
    "linked": {"caustics": "on"},
    "probes": {"method": "hybrid"},
    "reuse": {"method": "resampled", "reuse": "none"},
    "unbiased": {"method": "resampled"},
    "march_step": {"method": "march"},
}


@pytest.mark.parametrize("name", WITHOUT)
def test_a_setting_without_effect_is_named(name: str) -> None:
    (text,) = idle(Settings(**WITHOUT[name]), [name])
    assert text.startswith(f"--{name.replace('_', '-')} has no effect here: only ")
    assert not idle(Settings(**WITHOUT[name]), [])
    assert not idle(Settings(**WITH[name]), [name])


def test_render_and_inspect_name_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("glrt.cli.render._render", lambda *_: 0)
    said = "--particles has no effect here: only --caustics on sends particles."
    words = ["cornell", "--particles", "1", "--caustics", "off"]
    assert main(["render", *words, "-o", str(tmp_path / "a.exr"), "--quiet"]) == 0
    assert capsys.readouterr().err == f"glrt: caution: {said}\n"
    assert main(["inspect", *words]) == 0
    assert f"\ncaution: {said}" in capsys.readouterr().out


@pytest.mark.parametrize(("sampler", "floor"), [("sobol", 64), ("sobol64", 256)])
def test_samples_up_to_the_floor_are_not_adaptive(sampler: str, floor: int) -> None:
    assert f"the first {floor} samples are the same in all pixels" in even(taken(floor, sampler))
    assert not even(taken(floor + 1, sampler))
    assert not even(taken(floor, sampler, adaptive="off"))


def taken(samples: int, sampler: str, adaptive: str = "on") -> Image:
    """A picture of as many samples."""
    scene = load("sky")
    settings = settings_for(scene.render, sampler=sampler, adaptive=adaptive)
    recipe = Recipe(scene=scene, settings=settings, samples=samples, version="0", renderer="none")
    return Image(np.ones((1, 1, 3), np.float32), np.ones((1, 1, 3), np.float32), samples, recipe)
