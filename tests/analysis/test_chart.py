"""`glrt chart`: measured rounds, and the files that show and report their results."""

import csv
import json
import re
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glrt.analysis import plot, reference
from glrt.analysis.chart import drawing, experiment
from glrt.analysis.chart.curves import Curve, Interval, Point
from glrt.analysis.chart.experiment import Plan, measure_scene
from glrt.analysis.variants import variants_of
from glrt.cli.main import main
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering import schedule
from tests.support.processes import glrt, start

SIX = [word for name in "abcdef" for word in ("--curve", name)]
QUICK = ("--height", "8", "--rounds", "2", "--seconds", "0.3")


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(tmp_path_factory.mktemp("cache"))


# Scenes whose kernels compile fast: of some twenty variants each.
LAMP = """
title = "A lamp over a floor"
[camera]
position = [0.0, 0.0, 0.0]
look_at = [0.0, 0.0, -1.0]
[materials.floor]
type = "lambertian"
color = [0.5, 0.5, 0.5]
[materials.lamp]
type = "light"
emission = [5.0, 5.0, 5.0]
[[objects]]
shape = "plane"
point = [0.0, -1.0, 0.0]
normal = [0.0, 1.0, 0.0]
material = "floor"
[[objects]]
shape = "sphere"
center = [0.0, 0.5, -3.0]
radius = 0.5
material = "lamp"
"""
SKY = f"""
title = "A floor under the sky"
background = {{ bottom = [0.2, 0.2, 0.2], top = [0.5, 0.6, 0.9] }}
{LAMP[LAMP.index("[camera]") : LAMP.index("[materials.lamp]")]}
{LAMP[LAMP.index("[[objects]]") : LAMP.rindex("[[objects]]")]}
"""
TITLES = {"lamp": "A lamp over a floor", "sky": "A floor under the sky"}


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of their files."""
    folder = tmp_path_factory.mktemp("scenes")
    (folder / "lamp.toml").write_text(LAMP)
    (folder / "sky.toml").write_text(SKY)
    return folder


@pytest.fixture(scope="module")
def charted(tmp_path_factory: pytest.TempPathFactory, cache: str, scenes: Path) -> Path:
    """The folder of their charts."""
    folder = tmp_path_factory.mktemp("charts") / "new" / "folder"
    files = [scenes / f"{name}.toml" for name in TITLES]
    page = folder / "page.html"
    done = glrt("chart", *files, "-o", folder, "--html", page, *QUICK, XDG_CACHE_HOME=cache)
    assert done.returncode == 0, done.stderr
    assert done.stderr == f"Wrote {folder}/chart.md, {page} and the charts of lamp, sky.\n"
    return folder


def table(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / f"{name}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


# --- files ---------------------------------------------------------------------------------


@pytest.mark.slow
def test_every_scene_gets_its_files_and_one_page_shows_all(charted: Path) -> None:
    suffixes = ("csv", "json", "png", "rounds.json", "svg")
    expected = {f"{name}.{suffix}" for name in TITLES for suffix in suffixes}
    assert {file.name for file in charted.iterdir()} == expected | {"chart.md", "page.html"}
    page = (charted / "chart.md").read_text()
    for name, title in TITLES.items():
        assert f"![Error against time for {name}]({name}.svg)" in page
        assert title in page


@pytest.mark.slow
def test_pictures_are_as_large_as_promised_and_name_few_variants(charted: Path) -> None:
    with Image.open(charted / "lamp.png") as picture:
        assert picture.size == (1320, 1001)
        codes = np.asarray(picture.convert("L"))
    assert 0.01 < (codes < 64).mean() < 0.2, "black on white"
    assert (codes > 250).mean() > 0.5
    text = (charted / "lamp.svg").read_text()
    named = {row["variant"] for row in table(charted, "lamp")} & {
        found.partition(": ")[0] for found in re.findall(r"<!-- (.*?) -->", text)
    }
    assert named >= {"naive", "mis"}
    assert 5 <= len(named) <= 7
    assert "reference" in text
    for file in (*charted.glob("*.png"), *charted.glob("*.svg")):
        assert file.stat().st_size < 300_000


@pytest.mark.slow
def test_tables_for_programs_hold_the_same_points(charted: Path) -> None:
    rows = table(charted, "lamp")
    data = json.loads((charted / "lamp.json").read_text())
    assert [str(point["error"]) for point in data["points"]] == [row["error"] for row in rows]
    assert data["size"] == [8, 8]
    assert data["rounds"] == 2
    for row in rows:
        assert float(row["error_low"]) <= float(row["error"]) <= float(row["error_high"])
        assert float(row["rays"]) >= int(row["samples"])


@pytest.mark.slow
def test_points_on_the_front_are_beaten_by_none(charted: Path) -> None:
    dots = [
        (float(row["milliseconds"]), float(row["error"]), row["on_front"] == "True")
        for row in table(charted, "lamp")
    ]
    for x, y, on_front in dots:
        beaten = any(a <= x and b <= y and (a, b) != (x, y) for a, b, _ in dots)
        assert on_front == (not beaten)


@pytest.mark.slow
def test_methods_that_are_one_are_measured_once(charted: Path) -> None:
    """Under the sky there is no lamp."""
    assert "naive = nee = mis" in {row["variant"] for row in table(charted, "sky")}


# --- rounds --------------------------------------------------------------------------------


@pytest.fixture
def few_variants(monkeypatch: pytest.MonkeyPatch) -> None:
    """Charts of two variants: the others would only take time."""
    monkeypatch.setattr(experiment, "variants_of", lambda *scene: variants_of(*scene)[:2])


@pytest.mark.slow
def test_the_same_command_measures_nothing_again_and_more_rounds_add(
    charted: Path, cache: str, scenes: Path
) -> None:
    scene = scenes / "lamp.toml"
    rounds = charted / "lamp.rounds.json"
    before = rounds.read_bytes()
    assert glrt("chart", scene, "-o", charted, *QUICK, XDG_CACHE_HOME=cache).returncode == 0
    assert rounds.read_bytes() == before
    more = [*QUICK, "--rounds", "3", "--quiet"]
    done = glrt("chart", scene, "-o", charted, *more, XDG_CACHE_HOME=cache)
    assert (done.returncode, done.stderr) == (0, "")
    old, new = json.loads(before), json.loads(rounds.read_bytes())
    assert new["rounds"][:2] == old["rounds"]
    assert len(new["rounds"]) == 3


@pytest.mark.slow
@pytest.mark.usefixtures("few_variants")
def test_rounds_of_another_measurement_or_damaged_ones_are_not_gone_on_with(
    tmp_path: Path, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    file = tmp_path / "rounds.json"
    scene = load("sky")

    def measured(height: int) -> list[Any]:
        plan = Plan(height, 2, 0.1)
        measure_scene("sky", scene, plan, context, file, lambda _text, _share: None)
        return list(json.loads(file.read_text())["rounds"])

    first = measured(8)
    assert measured(8) == first
    assert measured(9) != first
    file.write_text('{"key": 1, "rounds": [[]')
    assert len(measured(9)) == 2


@pytest.mark.slow
def test_interruption_keeps_the_rounds_that_are_done(
    tmp_path: Path, cache: str, scenes: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    long = ("--height", "8", "--rounds", "200", "--seconds", "60")
    monkeypatch.setenv("XDG_CACHE_HOME", cache)
    process = start("chart", scenes / "sky.toml", "-o", tmp_path, *long)
    rounds = tmp_path / "sky.rounds.json"
    while not rounds.exists() and process.poll() is None:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=250)
    assert process.returncode == 130
    assert "the same command continues from there" in told
    assert json.loads(rounds.read_text())["rounds"]


@pytest.mark.slow
@pytest.mark.usefixtures("few_variants")
def test_progress_has_a_share_that_grows_to_one(
    tmp_path: Path, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    told: list[tuple[str, float]] = []
    plan = Plan(8, 2, 0.1)
    measure_scene("sky", load("sky"), plan, context, tmp_path / "r", lambda *t: told.append(t))
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1)
    assert told[0][0] == "sky: reference"
    assert told[-1][0] == "sky: round 2 of 2"


def test_an_interval_that_reaches_below_zero_makes_no_band_down_the_whole_chart() -> None:
    errors = [Interval(9, -5, 23), Interval(8, 6, 10), Interval(7, 6, 8)]
    points = tuple(Point(2**i, Interval(2**i, 1, 1), error) for i, error in enumerate(errors))
    curve = Curve("naive", points, None, Interval(0, 0, 0))
    with plot.open_figure((4, 3)) as figure:
        axes = figure.subplots()
        drawing._draw(axes, [curve], [[1, 2, 4]], [0])
    (band,) = axes.collections[0].get_paths()
    assert tuple(band.get_extents().extents) == (2, 6, 4, 10)


@pytest.mark.slow
def test_variants_beyond_the_loop_limit_are_left_out(
    context: Context, tmp_path: Path, scenes: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    for module in (schedule, reference):
        monkeypatch.setattr(module, "usable_rounds", lambda _context: 300)
    scene = load(str(scenes / "lamp.toml"))
    result = measure_scene("c", scene, Plan(8, 2, 0.1), context, tmp_path / "r", lambda *_: None)
    names = [curve.name for curve in result.curves]
    assert "mis" in names
    assert "mis, 80 bounces" not in names


# --- refusals ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["cornel", "-o", "there"], "did you mean 'cornell'"),
        (["cornell", "-o", "there", "--rounds", "1"], "--rounds must be from 2 to 1000"),
        (["cornell", "-o", "there", "--seconds", "nan"], "--seconds must be from 0.1"),
        (["cornell", "scenes/cornell.toml", "-o", "there"], "Two scenes are called cornell"),
        (["cornell", "-o", "there", "--curve", "nobody"], "--curve 'nobody' is in none of these"),
        (["cornell", "-o", "there", *SIX], "--curve may be given at most 5 times"),
        (["cornell", "-o", "there", "--temporal", "reset", "--curve", "mis"], "omit one"),
        (["cornell", "-o", "file"], "Cannot make the folder file"),
        (["cornell"], "give -o DIR, --html FILE, or both"),
        (["cornell", "-o", "there", "--html", "page.pdf"], "--html must end in .html"),
        (["cornell", "-o", "there", "--html", "nowhere/page.html"], "there is no folder nowhere"),
        (["cornell", "--html", "file/page.html"], "Cannot write file/page.html"),
    ],
)
def test_a_bad_command_is_refused_in_a_paragraph(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    assert main(["chart", *arguments]) == 2
    assert message in capsys.readouterr().err
    assert not Path("there").exists()


def test_without_matplotlib_the_command_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(plot, "find_spec", lambda _name: None)
    assert main(["chart", "cornell", "-o", str(tmp_path / "there")]) == 2
    assert "-m pip install" in capsys.readouterr().err
    assert not (tmp_path / "there").exists()
