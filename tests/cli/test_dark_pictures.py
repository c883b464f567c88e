"""Pictures that look black: one caution, with the exposure that shows them."""

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from glrt.cli.main import main

SMALL = ["--width", "16", "--height", "16", "--samples", "4"]
SCENE = """
[camera]
position = [0, 1, 4]
look_at = [0, 0, 0]
[background]
color = [{0}, {0}, {0}]
[materials.matte]
type = "lambertian"
color = [0.5, 0.5, 0.5]
[[objects]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "matte"
"""


def render(folder: Path, light: float, *words: str, name: str = "a.png") -> int:
    (folder / "scene.toml").write_text(SCENE.format(light))
    return main(["render", str(folder / "scene.toml"), "-o", str(folder / name), *SMALL, *words])


def test_a_dim_picture_is_reported_with_the_exposure_that_shows_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert render(tmp_path, 1e-4) == 0
    said = capsys.readouterr().err
    (exposure,) = re.findall(r"is black: .* Use --exposure (\d+)", said)
    assert np.asarray(Pillow.open(tmp_path / "a.png")).max() < 3
    assert render(tmp_path, 1e-4, "--exposure", exposure) == 0
    assert "black" not in capsys.readouterr().err
    codes = np.asarray(Pillow.open(tmp_path / "a.png"))
    assert 100 < codes.mean() < 230


@pytest.mark.parametrize(
    ("light", "words", "name"),
    [(0.5, (), "a.png"), (1e-4, (), "a.exr"), (0.5, ("--quiet",), "a.png")],
)
def test_other_pictures_are_not_reported(
    light: float,
    words: tuple[str, ...],
    name: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert render(tmp_path, light, *words, name=name) == 0
    assert "black" not in capsys.readouterr().err


def test_quiet_hides_no_caution(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert render(tmp_path, 1e-4, "--quiet") == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("glrt: caution: 100 % of the picture is black")


def test_a_scene_without_light_is_reported_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert render(tmp_path, 0.0) == 0
    assert capsys.readouterr().err.count("caution") == 1


def test_a_picture_that_no_light_reaches_has_no_exposure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A ball that fills the picture, without a bounce."""
    (tmp_path / "scene.toml").write_text(SCENE.format(0.5).replace("[0, 1, 4]", "[0, 0, 1.1]"))
    words = ["-o", str(tmp_path / "a.png"), *SMALL, "--bounces", "0"]
    assert main(["render", str(tmp_path / "scene.toml"), *words]) == 0
    said = capsys.readouterr().err
    assert "is black at every exposure: no light reaches what is in view" in said
