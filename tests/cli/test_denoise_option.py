"""`glrt render --denoise`: what is reported, what is written, what is refused."""

import json
from pathlib import Path

import pytest

from glrt.analysis.method_choice import caustics, search
from glrt.cli.main import main
from glrt.core.install import install
from glrt.denoise import oidn
from glrt.gpu.context import Context
from glrt.image.image import Image, read_recipe
from glrt.image.sources import load
from glrt.settings import Settings

SMALL = ["render", "cornell", "--width", "16", "--height", "12", "--bounces", "3"]
NLM = [*SMALL, "--denoise", "nlm"]


def test_both_errors_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.exr"
    assert main([*NLM, "--samples", "64", "-o", str(path), "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    image = Image.load(path)
    assert figures["error"] == pytest.approx(image.error)
    assert figures["denoised_error_high"] >= figures["denoised_error"]
    assert figures["denoised_error"] == pytest.approx(image.denoised().error)
    assert main([*NLM, "--samples", "64", "-o", str(path)]) == 0
    told = capsys.readouterr().err
    plain, denoised = 100 * (image.error or 0), 100 * image.denoised().error
    assert f"estimated error {plain:.2g} %, denoised {denoised:.2g} %." in told


def test_without_it_there_is_no_such_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.exr"
    assert main([*SMALL, "--samples", "64", "-o", str(path), "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["denoised_error"] is figures["denoised_error_high"] is None
    assert Image.load(path).denoising is None


def test_a_picture_is_denoised_again_by_its_recipe(tmp_path: Path) -> None:
    first, second = tmp_path / "a.png", tmp_path / "b.png"
    assert main([*NLM, "--samples", "64", "-o", str(first), "--quiet"]) == 0
    assert read_recipe(first).settings.denoise == "nlm"
    assert main(["render", str(first), "-o", str(second), "--quiet"]) == 0
    assert first.read_bytes() == second.read_bytes()


def test_auto_is_reported_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(oidn, "find_spec", lambda _name: None)
    path = tmp_path / "a.exr"
    words = [*SMALL, "--denoise", "auto", "--samples", "64", "-o", str(path), "--quiet"]
    assert main(words) == 0
    assert read_recipe(path).settings.denoise == "nlm"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--denoise", "nlm", "--samples", "63"], "--denoise needs 64 samples a pixel at least"),
        (["--denoise", "oidn"], install("denoise")),
        (["--denoise", "nlm", "--part", "1/2"], "A part of a render and --denoise do not go"),
        (["--denoise", "best"], "argument --denoise: invalid choice: 'best'"),
    ],
)
def test_what_cannot_be_is_refused_before_rendering(
    words: list[str],
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(oidn, "find_spec", lambda _name: None)
    assert main([*SMALL, *words, "-o", str(tmp_path / "a.png")]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert told.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_a_render_stops_at_the_error_of_what_it_shows(tmp_path: Path) -> None:
    path = str(tmp_path / "a.exr")
    assert main([*NLM, "--samples", "64", "-o", path, "--quiet"]) == 0
    wanted = str(0.5 * (Image.load(path).error or 0))
    assert main([*NLM, "--error", wanted, "-o", path, "--quiet"]) == 0
    image = Image.load(path)
    assert 64 < image.samples <= 4096
    assert (image.error_to_reach or 0) <= float(wanted)
    assert main([*NLM, "--samples", "64", "--error", "1e-5", "-o", path, "--quiet"]) == 1


def test_a_picture_that_ended_too_early_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first dispatch ends at a half at most; the recipe is of the plain picture."""
    path = tmp_path / "a.exr"
    assert main([*NLM, "--time", "0.001", "-o", str(path)]) == 0
    image = Image.load(path)
    assert image.samples < 64
    assert "the picture is not denoised: that takes 64 samples at least" in capsys.readouterr().err
    assert image.recipe
    assert image.recipe.taken.denoise == "none"


def test_pilots_and_trials_measure_plain_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """A denoiser would gather guides there, and refuse as few samples as a pilot takes."""
    seen = []
    monkeypatch.setattr(caustics, "Renderer", lambda _, settings, *__, **___: seen.append(settings))
    wanted = Settings(denoise="nlm", aov=("depth",))
    with pytest.raises(AttributeError):  # there is no renderer to release
        caustics._picture(load("cornell"), wanted, Context.__new__(Context), 64)
    seen.append(search.small_frame(wanted))
    assert [(found.denoise, found.aov) for found in seen] == [("none", ())] * 2
