"""The rim of a small sun: cautioned by every command."""

import json
from pathlib import Path
from typing import Any

import pytest

import glrt as library
from bench.fooling_scenes import fooling_scene
from glrt.cli.main import main
from glrt.image.image import Image
from glrt.scene.scenefile.toml_writer import write_scene

CAUTION = "is not to be believed"
SIZE = ("--width", "48", "--height", "36", "--bounces", "6", "--sampler", "sobol")
RIM, _ = fooling_scene("rims of small suns", 30014)
SEED = ("--seed", "4")  # estimated 2.6 %, true 13 %


@pytest.mark.parametrize("limit", [("--samples", "64"), ("--error", "0.9", "--samples", "64")])
def test_a_render_is_cautioned(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], limit: tuple[str, ...]
) -> None:
    write_scene(RIM, tmp_path / "scene.toml")
    output = tmp_path / "a.exr"
    told: Any = ["render", tmp_path / "scene.toml", "-o", output, "--json", *SIZE, *SEED, *limit]
    assert main([str(word) for word in told]) == 0
    said = capsys.readouterr()
    assert CAUTION in said.err
    assert json.loads(said.out)["error_doubtful"] is True
    assert Image.load(output).error_doubtful is True


def test_python_reports_it() -> None:
    image = library.render(RIM, samples=64, width=48, height=36, bounces=6, sampler="sobol", seed=4)
    assert image.error is not None
    assert image.error < 0.03
    assert image.error_doubtful is True


def test_a_merged_picture_is_cautioned(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_scene(RIM, tmp_path / "scene.toml")
    parts = [str(tmp_path / f"{number}.exr") for number in (1, 2)]
    for number, part in enumerate(parts, 1):
        wanted: Any = ["render", tmp_path / "scene.toml", "-o", part, *SIZE, *SEED, "--quiet"]
        wanted += ["--samples", "128", "--part", f"{number}/2"]
        assert main([str(word) for word in wanted]) == 0
    capsys.readouterr()
    assert main(["merge", *parts, "-o", str(tmp_path / "whole.exr"), "--json"]) == 0
    said = capsys.readouterr()
    assert CAUTION in said.err
    assert json.loads(said.out)["error_doubtful"] is True
