"""`glrt stress`: every case at a tiny size, verdicts that can fail, files whole or absent."""

import csv
import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from glrt.cli import stress
from glrt.cli.main import main
from glrt.core.resources import folder
from glrt.gpu import glsl
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.lab import report, sweep
from glrt.lab.cases import CASES
from glrt.lab.sweep import Case, Finding, Lab, Sweep
from glrt.scene.scene import Scene
from tests.support.alarms import book

TINY = 1 / 64
VERDICTS = {
    "lamps": 11,
    "spots": 11,
    "ceiling": 18,
    "bulb": 18,
    "caustic": 3,
    "fireflies": 1,
    "frosted": 7,
    "depth": 13,
    "turn": 7,
    "spike": 5,
    "layer": 5,
    "seeds": 7,
    "dimensions": 1,
    "sparks": 6,
}
SLOW = (  # more than a second each, or many kernels
    *("lamps", "spots", "ceiling", "bulb", "focus", "mirrored", "ground", "many", "aperture"),
    *("near", "refracted", "slats", "contact", "leak", "wall", "rooms", "point", "polish"),
    *("stripes", "thin", "layers", "speed", "reflection", "rough", "step"),
    *("crossing", "blur", "lengths"),
    *("flicker", "frosted", "denoised", "uncovered", "lag", "bright"),
    *("drawn", "sun", "frames", "bumps", "plastic", "fireflies", "ior"),
    *("filament", "brushed", "soap", "velvet", "leaf", "bending", "neighbours", "panes"),
)
SWEEP = Sweep(
    parameter="size",
    measure="error",
    x=[1.0, 2.0, 4.0, 8.0],
    chosen=("ours", [0.1, 0.2, 0.1, 9.0]),
    others={"naive": [0.1, 1.0, 2.0, 9.0]},
    promise="below a half up to 4",
    bound=[0.5] * 4,
    guaranteed=[True, True, True, False],
)


@pytest.mark.slow_cases("leave", "stretch", "caustic", "sparks", "still", "albedo")
@pytest.mark.slow_cases(
    "depth", "turn", "spike", "layer", "colors", "skim", "inside", "march", "voxel", "uneven"
)
@pytest.mark.slow_cases("overlap")
@pytest.mark.slow_cases(*SLOW)
@pytest.mark.parametrize("name", CASES)
def test_every_case_holds_and_distinguishes_the_naive_method_from_the_chosen(
    context: Context, name: str
) -> None:
    lab = Lab(context, TINY)
    found = CASES[name].run(lab)
    book(VERDICTS.get(name, 0))
    assert found.broken() == []
    curves = [found.chosen[1], *found.others.values()]
    assert all(len(curve) == len(found.x) > 3 for curve in curves)
    assert np.isfinite(curves).all()
    assert np.min(curves) >= 0
    if found.bound is not None:
        naive = next(iter(found.others.items()))
        assert replace(found, chosen=naive).broken() != []


def test_a_guarantee_holds_where_it_is_given_and_nowhere_else() -> None:
    assert SWEEP.broken() == []
    assert SWEEP.limit() == 4.0
    assert replace(SWEEP, guaranteed=None).broken() == [8.0]
    assert replace(SWEEP, guaranteed=None).limit() is None
    assert replace(SWEEP, guaranteed=[False, False, True, True]).limit() == 4.0
    assert replace(SWEEP, chosen=("naive", SWEEP.others["naive"])).broken() == [2.0, 4.0]
    assert replace(SWEEP, chosen=("nan", [float("nan")] * 4)).broken() == [1.0, 2.0, 4.0]
    free = replace(SWEEP, bound=None, guaranteed=None, chosen=("", [9.0] * 4))
    assert free.broken() == []
    assert replace(free, wrong=[2.0]).broken() == [2.0]
    assert replace(SWEEP, wrong=[8.0]).broken() == [8.0]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """`glrt stress` in this process, at a tiny size."""
    monkeypatch.setattr(stress, "QUICK", TINY)
    return lambda *words: main(["stress", "--quick", *map(str, words)])


@pytest.mark.slow
def test_a_run_writes_table_figures_and_charts(
    run: Callable[..., int], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "new" / "folder"
    assert run("lamp", "distance", "lamp", "-o", target, "--html", target / "page.html") == 0
    names = {"page.html", "stress.md", "stress.csv", "overview.png", "lamp.svg", "distance.svg"}
    assert {file.name for file in target.iterdir()} == names
    told = capsys.readouterr()
    assert told.out == (target / "stress.md").read_text() + "\n"
    assert told.err == ""
    assert told.out.count("| holds |") == 2
    with (target / "stress.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {row["case"] for row in rows} == {"lamp", "distance"}
    assert all(float(row["y"]) >= 0 for row in rows)
    assert {row["guaranteed"] for row in rows} == {"0", "1", ""}


@pytest.mark.slow
def test_a_broken_guarantee_ends_with_code_1_and_its_place(
    run: Callable[..., int],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stable, naive = "s2 / (1.0 + sqrt(1.0 - s2))", "1.0 - sqrt(1.0 - s2)"
    shaders = tmp_path / "shaders"
    shutil.copytree(folder("shaders_glsl"), shaders)
    text = (shaders / "lights/sampling.glsl").read_text()
    assert stable in text
    (shaders / "lights/sampling.glsl").write_text(text.replace(stable, naive))
    monkeypatch.setattr(glsl, "folder", lambda _name: shaders)
    assert run("lamp", "distance", "-o", tmp_path, "--json") == 1
    told = json.loads(capsys.readouterr().out)
    assert told["distance"]["holds"] is True
    assert told["lamp"]["holds"] is False
    assert told["lamp"]["verdict"].startswith("BROKEN at 1e-06, 1.78e-06, 3.16e-06 and ")
    assert min(told["lamp"]["broken"]) == pytest.approx(1e-6)
    assert "| BROKEN at" in (tmp_path / "stress.md").read_text()


def test_what_cannot_be_run_is_refused_before_anything_is_measured(
    run: Callable[..., int],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(stress, "_run", lambda *_: pytest.fail("measured"))
    assert run("lampe", "-o", tmp_path) == 2
    said = capsys.readouterr().err
    assert "did you mean 'lamp'?" in said
    assert all(name in said for name in CASES)
    assert run("lamp") == 2
    assert "-o DIR" in capsys.readouterr().err
    assert run("lamp", "-o", tmp_path / "made", "--html", tmp_path / "no" / "page.html") == 2
    assert f"there is no folder {tmp_path / 'no'}" in capsys.readouterr().err
    assert run("lamp", "-o", tmp_path / "made", "--html", tmp_path / "page.pdf") == 2
    assert "--html must end in .html" in capsys.readouterr().err
    (tmp_path / "file").touch()
    assert run("lamp", "-o", tmp_path / "file") == 2
    (tmp_path / "taken" / "lamp.svg").mkdir(parents=True)
    assert run("lamp", "-o", tmp_path / "taken") == 2
    assert sorted(file.name for file in tmp_path.rglob("*")) == ["file", "lamp.svg", "taken"]


def test_the_list_names_every_case_without_running_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stress", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(CASES)


def test_the_table_names_the_worst_under_the_guarantee() -> None:
    case = Case("sizes", "Sizes", lambda _: SWEEP)
    text = report.table([Finding(case, SWEEP, 1.25)], "a driver")
    row = "| sizes | Sizes | below a half up to 4 | holds | 0.2 | 9 (naive) | 1.2 |"
    assert row in text.splitlines()
    assert "on a driver." in text


class Painted:
    """A renderer without OpenGL, whose pictures are even."""

    samples = 0

    def __init__(self, scene: Scene, **_options: object) -> None: ...

    def render(self, samples: int) -> "Painted":
        self.samples = samples
        return self

    def image(self) -> Image:
        return Image(np.ones((8, 8, 3), np.float32), np.ones((8, 8, 3), np.float32), self.samples)

    def release(self) -> None: ...


def test_a_page_gets_the_pictures_of_each_case_and_nothing_else_does(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sweep, "Renderer", Painted)
    scene = load("cornell")

    def run(lab: Lab) -> Sweep:
        for samples in (1, 2):
            lab.render(scene, samples)
        with lab.rendering(scene):
            pass
        return SWEEP

    context: Context = None  # type: ignore[assignment]
    wanted, unwanted = Lab(context, rendered=[]), Lab(context)
    case = Case("even", "Even pictures", run)
    for _ in range(2):
        found = stress._run(case, wanted)
        assert [image.samples for image in found.rendered] == [1, 2]
    assert stress._run(case, unwanted).rendered == ()
