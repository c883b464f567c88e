"""`glrt compare` as a user runs it: report, figures, exit codes, and the picture."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pillow

from glrt.cli.main import main
from glrt.comparison.heatmap import SPAN, colors, save_picture
from glrt.comparison.result import percent
from glrt.comparison.verdict import compare
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.scene.scene import with_lights
from tests.support.noisy_images import noisy
from tests.support.processes import glrt
from tests.support.renders import rendered

KEYS = [
    *("verdict", "reasons", "alpha", "bias", "means", "factors", "spread", "largest", "limit"),
    *("block", "pixel", "sensitivity", "heavy_tails", "needs", "alike"),
]


@pytest.fixture(scope="module")
def folder(context: Context, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Renders of cornell: a and b differ in seed alone, c also in bounces; as EXR and NPY."""
    place = tmp_path_factory.mktemp("compare")
    for name, settings in {"a": {}, "b": {"seed": 1}, "c": {"seed": 2, "bounces": 2}}.items():
        more: dict[str, Any] = {"width": 32, "height": 24, **settings}
        image = rendered(load("cornell"), context, 64, **more)
        for suffix in ("exr", "npy"):
            image.save(place / f"{name}.{suffix}")
    return place


def run(folder: Path, line: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    words = [str(folder / word) if word.endswith(("exr", "npy")) else word for word in line.split()]
    code = main(["compare", *words])
    captured = capsys.readouterr()
    assert not captured.err
    return code, captured.out


@pytest.mark.parametrize(
    ("line", "code", "verdict"),
    [
        ("a.exr b.exr --alpha 1e-7", 0, "undecided"),
        ("a.exr b.exr --strict --alpha 1e-7", 1, "undecided"),
        ("a.exr b.exr --strict --bias 0.5 --alpha 1e-7", 0, "same"),
        ("c.exr b.exr", 1, "different"),
        ("c.exr b.exr --strict", 1, "different"),
        ("a.npy b.exr --samples 64 --alpha 1e-7", 0, "undecided"),
        ("b.exr c.npy --reference-samples 64", 1, "different"),
    ],
)
def test_exit_code_follows_the_verdict(
    line: str, code: int, verdict: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    done, text = run(folder, line, capsys)
    assert text.startswith(verdict)
    assert done == code


def test_report_reports_the_figures(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, text = run(folder, "a.exr b.exr", capsys)
    comparison = compare(Image.load(folder / "a.exr"), Image.load(folder / "b.exr"))
    assert str(comparison) == text.splitlines()[0]
    assert f"needs {comparison.needs} samples" in text
    assert str(comparison.worst) in text
    assert str(comparison.pixel) in text
    for size in (comparison.sensitivity.light, comparison.sensitivity.block):
        assert percent(size) in text
    for interval in (*comparison.differences, *comparison.factors):
        low, high = (percent(value, 3, "+") for value in (interval.low, interval.high))
        assert f"{low} to {high}" in text


def test_a_notebook_shows_the_report(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """IPython takes `repr`, as Python's own prompt does; `str` is a line for messages."""
    comparison = compare(Image.load(folder / "a.exr"), Image.load(folder / "c.exr"))
    assert repr(comparison) + "\n" == run(folder, "a.exr c.exr", capsys)[1]
    assert "array(" not in repr(comparison)
    assert "\n" not in str(comparison)


def test_percent_is_written_without_exponent() -> None:
    assert percent(1.4567) == "150 %"
    assert percent(0.00123, digits=2) == "0.12 %"
    assert percent(-12.3456, digits=3, sign="+") == "-1230 %"
    assert percent(float("inf")) == "inf %"


def test_report_says_when_methods_may_differ(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "methods may differ" in run(folder, "a.npy b.exr --samples 64", capsys)[1]
    assert "methods may differ" not in run(folder, "a.exr b.exr", capsys)[1]


def test_json_is_one_line_of_finite_figures(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text = run(folder, "c.exr b.exr --json", capsys)
    assert (code, text.count("\n")) == (1, 1)
    figures = json.loads(text, parse_constant=pytest.fail)
    assert list(figures) == KEYS
    assert figures["verdict"] == "different"
    assert list(figures["means"]["red"]) == ["image", "reference", "difference", "low", "high"]
    assert figures["block"]["width"] == 8


def test_json_has_null_for_what_cannot_be_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    black = np.zeros((8, 8, 3), np.float32)
    Image(black, black, 0).save(tmp_path / "black.exr")
    line = "black.exr black.exr --samples 4 --reference-samples 4 --json"
    figures = json.loads(run(tmp_path, line, capsys)[1], parse_constant=pytest.fail)
    assert figures["sensitivity"] == {"light": None, "block": None, "groups": {}}
    assert (figures["needs"], figures["factors"]) == (None, None)
    assert figures["means"]["red"]["difference"] is None


def test_samples_that_the_file_knows_otherwise_are_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [str(folder / "a.exr"), str(folder / "b.exr")]
    assert main(["compare", *files, "--samples", "64", "--json"]) == 0
    assert main(["compare", *files, "--samples", "32"]) == 2
    assert "64 samples" in capsys.readouterr().err


def test_the_command_ends_a_real_process_with_its_exit_code(folder: Path) -> None:
    done = glrt("compare", folder / "c.exr", folder / "b.exr", "--picture", folder / "d.png")
    assert (done.returncode, done.stderr) == (1, "")
    assert done.stdout.startswith("different: ")
    with Pillow.open(folder / "d.png") as picture:
        assert picture.format == "PNG"


# --- The picture -----------------------------------------------------------------------------


def test_colors_are_blue_below_white_at_0_and_red_above() -> None:
    scores = np.array([-2.0 * SPAN, -SPAN, -SPAN / 2, 0.0, SPAN / 2, SPAN, 2.0 * SPAN])
    red, _, blue = colors(scores).astype(int).T
    assert colors(scores)[3].tolist() == [247, 247, 247]
    assert (blue[:3] > red[:3] + 90).all()
    assert (red[4:] > blue[4:] + 90).all()
    assert (colors(scores)[[0, 6]] == colors(scores)[[1, 5]]).all()


@pytest.mark.parametrize(("width", "height"), [(3, 4), (40, 24), (400, 90)])
def test_picture_shows_a_wrong_pixel_where_it_is(width: int, height: int, tmp_path: Path) -> None:
    pixels = np.ones((height, width, 3), np.float32)
    reference = Image(pixels, 0.01 * pixels, 64)
    image = Image(pixels.copy(), 0.01 * pixels, 64)
    image.radiance[height - 1, 1] = 3
    save_picture(compare(image, reference, alike=True), tmp_path / "d.png")
    with Pillow.open(tmp_path / "d.png") as picture:
        found = np.asarray(picture.convert("RGB")).astype(int)
    zoom = max(1, -(-320 // max(width, height)))
    dark_red = (found[..., 0] > 100) & (found[..., 1] < 20) & (found[..., 2] < 20)
    rows, columns = np.nonzero(dark_red[:, : 16 + zoom * width])  # the panel of pixels
    assert rows.size == zoom**2
    assert (columns.min(), columns.max()) == (16 + zoom, 16 + 2 * zoom - 1)
    assert rows.max() == found.shape[0] - 16 - 1


@pytest.mark.parametrize(("sampler", "samples"), [("sobol", 32), ("independent", 2)])
def test_how_many_samples_know_their_noise_is_reported_as_it_is(
    context: Context, sampler: str, samples: int
) -> None:
    few, enough = (
        rendered(load("cornell"), context, count, sampler=sampler)
        for count in (samples - 1, samples)
    )
    with pytest.raises(UsageError, match="at least 32 samples, or 2 with --sampler independent"):
        compare(few, few)
    assert compare(enough, enough)


def test_groups_are_rendered_to_say_what_change_of_them_is_found(
    context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A fainter lamp needs a larger change; one that is off is left out."""
    scene = with_lights(load("lamps"), {"blue": 0.0})
    for name, seed in {"a": 0, "b": 1}.items():
        rendered(scene, context, 64, width=32, height=24, seed=seed).save(tmp_path / f"{name}.exr")
    found = json.loads(run(tmp_path, "a.exr b.exr --groups --json", capsys)[1])["sensitivity"]
    assert list(found["groups"]) == ["amber", "rose"]
    assert found["groups"]["rose"] > 3 * found["groups"]["amber"] > 0
    text = run(tmp_path, "a.exr b.exr --groups", capsys)[1]
    assert f"light group rose  {percent(found['groups']['rose'])}" in text
    assert "of each light by 1 %" in text
    assert json.loads(run(tmp_path, "a.exr b.exr --json", capsys)[1])["sensitivity"]["groups"] == {}


def test_groups_of_a_picture_without_a_recipe_are_unknown(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(
            [
                "compare",
                *(str(folder / n) for n in ("a.npy", "b.exr")),
                "--samples",
                "64",
                "--groups",
            ]
        )
        == 2
    )
    assert "--groups needs the recipe" in capsys.readouterr().err


def test_heavy_tails_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Five pixels met light that is brighter than all the rest of their samples."""
    image = noisy("smooth", 256, 1, 64)
    for pixels in (image.radiance, image.stderr):
        pixels.reshape(-1, 3)[100:4000:900] += 2
    image.save(tmp_path / "a.exr")
    noisy("smooth", 256, 2, 64).save(tmp_path / "b.exr")
    line = "a.exr b.exr --samples 256 --reference-samples 256"
    code, text = run(tmp_path, line, capsys)
    assert code == 0
    assert text.startswith("undecided: heavy tails: ")
    assert "5 pixels of the image carry" in text
    assert "inf" not in text
    tails = json.loads(run(tmp_path, f"{line} --json", capsys)[1])["heavy_tails"]
    assert tails["picture"] == "image"
