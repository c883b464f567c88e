"""`python -m tests.wgsl`: the thesis's tracer as a program, with the files of `glrt render`."""

import json
from pathlib import Path

import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load, load_recipe
from glrt.rendering.renderer import Renderer
from tests.support.renders import same
from tests.wgsl import speed
from tests.wgsl.__main__ import main
from tests.wgsl.device import Device, is_software

SMALL = ["--width", "19", "--height", "11", "--samples", "20", "--bounces", "4", "--seed", "7"]


def test_file_is_that_of_a_render_and_its_recipe_renders_it_again(
    webgpu: Device, context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["cornell", "-o", str(tmp_path / "a.exr"), *SMALL]) == 0
    assert "Wrote" in capsys.readouterr().out
    image = Image.load(tmp_path / "a.exr")
    assert image.radiance.shape == (11, 19, 3)
    assert image.recipe
    assert image.recipe.renderer.startswith("WGSL, ")
    scene, settings = load_recipe(str(tmp_path / "a.exr"))
    renderer = Renderer(scene, settings, context)
    again = renderer.render(image.samples).image()
    renderer.release()
    assert again.samples == 20
    assert scene == load("cornell")
    if context.is_software and is_software(webgpu):
        assert same(image, again)


def test_figures_are_what_a_benchmark_reads(
    webgpu: Device, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["lamps", "-o", str(tmp_path / "a.png"), "--json", *SMALL]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["method"] == "naive"
    assert figures["samples_per_second"] > 0
    assert all(seconds > 0 for seconds in figures["seconds"].values())
    assert figures["seconds"].keys() == {"setup", "compile", "render"}
    work = 19 * 11 * 20
    assert figures["samples_per_second"] == pytest.approx(work / figures["seconds"]["render"], 0.01)


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["nowhere", "-o", "a.exr"], 2, "nowhere"),
        (["cornell", "-o", "a.jpg"], 2, "a.jpg"),
        (["cornell", "-o", "a.exr", "--bounces", "-1"], 2, "bounces"),
        (["weekend", "-o", "a.exr", "--bounces", "1000"], 2, "no tree"),
    ],
)
def test_what_cannot_be_rendered_is_one_paragraph(
    webgpu: Device,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    code: int,
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == code
    complaint = capsys.readouterr().err.strip()
    assert complaint.startswith("glrt: ")
    assert "\n" not in complaint
    assert message in complaint
    assert list(tmp_path.iterdir()) == []


def test_speed_is_reported_as_ratios(webgpu: Device, capsys: pytest.CaptureFixture[str]) -> None:
    few = ["--size", "8", "--samples", "2", "--rounds", "2", "--scenes", "lamps"]
    assert speed.main(few) == 0
    told = capsys.readouterr().out.splitlines()
    assert [line.split(maxsplit=1)[1] for line in told if line.startswith("  ")] == [
        "WGSL",
        "WGSL without `exact`",
        "glrt, one sample a dispatch",
        "glrt, uniform blocks",
        "glrt, constants",
    ]
