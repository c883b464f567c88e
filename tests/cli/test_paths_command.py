"""`glrt paths`: what it reports, stores and traces again, and what it refuses."""

import json
import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glrt as package
from glrt.cli.main import main
from glrt.core.resources import folder
from glrt.gpu import glsl
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.paths.file import TOLERANCE, first_difference, paths_from_json
from tests.support.drivers import OLD_DRIVER, ZINK
from tests.support.processes import glrt
from tests.support.system_packages import needs_package

PIXEL = ["--pixel", "11", "14"]
SMALL = ["--width", "16", "--height", "16", "--samples", "20", "--bounces", "5"]


@pytest.fixture(scope="module")
def stored(context: Context, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two paths of a pixel of the floor next to the glass ball."""
    file = tmp_path_factory.mktemp("paths") / "stored.json"
    more = ["--brightest", "2", "-o", str(file), "--context", context.route]
    assert main(["paths", "cornell", *PIXEL, *SMALL, *more]) == 0
    return file


def replay(file: Path, context: Context) -> int:
    return main(["paths", "--replay", str(file), "--context", context.route])


def changed(stored: Path, target: Path, keys: list[Any], value: Any) -> Path:
    """A copy of a file, with another value at these keys."""
    table = json.loads(stored.read_text())
    inner = table
    for key in keys[:-1]:
        inner = inner[key]
    inner[keys[-1]] = value
    target.write_text(json.dumps(table))
    return target


def test_it_ranks_samples_and_reports_their_ways(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["paths", "cornell", *PIXEL, *SMALL]) == 0
    out = capsys.readouterr().out
    assert out.startswith("cornell: pixel 11 14 of 16 x 16, 20 samples by mis\nmean radiance ")
    assert " of this pixel's light.\n" in out
    for word in ("glass ball", "specular", "light sampling", "delta", "hidden", " by camera - "):
        assert word in out, word


def test_a_sample_can_be_chosen(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["paths", "cornell", *PIXEL, *SMALL, "--sample", "7", "--sample", "3"]) == 0
    lines = capsys.readouterr().out.splitlines()
    told = [line.split(":")[0] for line in lines if ", ended by: " in line]
    assert told == ["Sample 7", "Sample 3"]


def test_json_on_stdout_is_what_the_file_holds(
    stored: Path, context: Context, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--brightest", "2", "--json", "--context", context.route]
    assert main(["paths", "cornell", *PIXEL, *SMALL, *words]) == 0
    out = capsys.readouterr().out
    assert out == stored.read_text()
    table = json.loads(out)
    assert (table["pixel"], table["samples"], table["lost"]) == ([11, 14], 20, 0)
    assert [path["sample"] for path in table["paths"]] == [
        listed["sample"] for listed in table["brightest"][:2]
    ]
    assert paths_from_json(out, "it").paths[0].model_dump(mode="json") == table["paths"][0]


def test_stored_paths_come_out_again(
    stored: Path, context: Context, capsys: pytest.CaptureFixture[str]
) -> None:
    assert replay(stored, context) == 0
    assert "2 of 2 paths come out again, bit for bit." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        (["paths", 1, "vertices", 2, "pdf"], "vertex 2"),
        (["paths", 0, "vertices", 1, "name"], "vertex 1"),
        (["paths", 0, "contributions", 1, "weight"], "light 1"),
        (["paths", 1, "end"], "its end was 'loop limit of the driver'"),
        (["paths", 0, "vertices", 3, "position", 1], "vertex 3"),
    ],
)
def test_a_change_of_a_stored_path_is_found(
    stored: Path,
    context: Context,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    keys: list[Any],
    told: str,
) -> None:
    value = json.loads(stored.read_text())
    for key in keys:
        value = value[key]
    other = "loop limit of the driver" if keys[-1] == "end" else f"{value} "
    if isinstance(value, float):
        other = float(np.nextafter(np.float32(value), np.float32(9)))  # type: ignore[assignment]
    file = changed(stored, tmp_path / "changed.json", keys, other)
    assert replay(file, context) == 1
    out = capsys.readouterr().out
    number = json.loads(stored.read_text())["paths"][keys[1]]["sample"]
    assert f"sample {number} differs: {told}" in out


@pytest.mark.slow
def test_a_bug_of_a_shader_is_found(
    stored: Path,
    context: Context,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    file = folder("shaders_glsl") / "bsdfs/matte.glsl"
    bug = glsl.read("bsdfs/matte.glsl").replace("wi.z / PI", "1.0 / PI")
    monkeypatch.setitem(glsl._texts, file, bug)
    assert replay(stored, context) == 1
    assert "differs: " in capsys.readouterr().out


def test_numbers_of_another_driver_may_be_near(
    stored: Path, context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    foreign = changed(stored, tmp_path / "a.json", ["recipe", "renderer"], "another driver")
    table = json.loads(foreign.read_text())
    vertex = table["paths"][0]["vertices"][2]
    place, away = vertex["position"], np.linalg.norm(vertex["position"])
    vertex["position"] = [place[0] + 0.5 * TOLERANCE * away, *place[1:]]
    foreign.write_text(json.dumps(table))
    assert replay(foreign, context) == 0
    assert "within 0.1 %: another driver stored them" in capsys.readouterr().out
    vertex["position"] = [place[0] + 2 * TOLERANCE * away, *place[1:]]
    foreign.write_text(json.dumps(table))
    assert replay(foreign, context) == 1


@pytest.mark.slow
def test_another_compiler_comes_near(stored: Path) -> None:
    told = glrt("paths", "--replay", str(stored), cwd=None, **ZINK)
    needs_package(told.returncode != 3, "mesa-vulkan-drivers")
    assert told.returncode == 0, told.stderr
    assert "2 of 2 paths come out again, within 0.1 %" in told.stdout


def test_a_path_that_is_longer_differs(stored: Path) -> None:
    path = paths_from_json(stored.read_text(), "it").paths[0]
    shorter = path.model_copy(update={"contributions": path.contributions[:-1]})
    told = first_difference(shorter, path, 0.0)
    assert told is not None
    assert told.startswith("its number of contributions was ")
    assert first_difference(path, path, 0.0) is None


def test_a_picture_is_a_scene_with_its_settings(
    context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = str(tmp_path / "cornell.exr")
    route = ["--context", context.route]
    assert main(["render", "cornell", *SMALL, "-o", picture, "--quiet", *route]) == 0
    assert main(["paths", picture, *PIXEL, "--json", *route]) == 0
    told = json.loads(capsys.readouterr().out)
    wanted = Image.load(picture).radiance[14, 11]
    assert told["samples"] == 20
    if context.is_software:
        assert np.array_equal(np.array(told["mean"], np.float32), wanted)


@pytest.mark.slow
def test_particles_are_listed_apart_and_come_out_again(
    context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "particles.json"
    more = ["--caustics", "on", "-o", str(file), "--context", context.route]
    assert main(["paths", "cornell", *PIXEL, *SMALL, *more]) == 0
    out = capsys.readouterr().out
    assert "with particles, which are listed apart" in out
    assert "ended by: linked to the camera" in out
    assert replay(file, context) == 0
    told = json.loads(file.read_text())["particles"]
    assert told["samples"] == 32
    assert told["arriving"] > 50
    other = changed(file, tmp_path / "a.json", ["particles", "paths", 0, "particle"], 2**31 - 2)
    assert replay(other, context) == 1
    assert "particle 2147483646 does not reach the pixel" in capsys.readouterr().out


def test_it_is_a_function_of_the_package(context: Context) -> None:
    found = package.paths(
        package.load("cornell"), (11, 14), 20, [3], context, width=16, height=16, bounces=5
    )
    assert [path.sample for path in found.paths] == [3]
    assert isinstance(found, package.PixelPaths)
    assert found.radiances.shape == (20, 3)


REFUSED: dict[str, tuple[list[str], int, str]] = {
    "no scene": ([], 2, "SCENE is missing"),
    "no pixel": (["cornell"], 2, "--pixel X Y is missing"),
    "a pixel outside": (["cornell", "--pixel", "512", "0"], 2, "columns are 0 to 511"),
    "a sample beyond": (["cornell", *PIXEL, "--sample", "256"], 2, "no sample 256"),
    "fragment": (["cornell", *PIXEL, "--pipeline", "fragment"], 2, "fragment pipeline cannot"),
    "a model": (["cornell", *PIXEL, "--method", "phong"], 2, "the method phong"),
    "two wishes": (["cornell", *PIXEL, "--sample", "1", "--brightest", "2"], 2, "give one"),
    "no path": (["cornell", *PIXEL, "--brightest", "0"], 2, "--brightest must be 1 or more"),
    "a picture's name": (["cornell", *PIXEL, "-o", "a.png"], 2, "must end in .json"),
    "no folder": (["cornell", *PIXEL, "-o", "nowhere/a.json"], 2, "there is no folder"),
    "both": (["cornell", "--replay", "a.json"], 2, "from the file alone"),
    "a setting": (["--replay", "a.json", "--samples", "3"], 2, "from the file alone"),
    "no file": (["--replay", "nowhere.json"], 2, "No such file"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_is_refused(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    words, code, told = REFUSED[case]
    assert main(["paths", *words]) == code
    err = capsys.readouterr().err
    assert told in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


FOREIGN: dict[str, tuple[str, str]] = {
    "no JSON": ("{", "it is not valid JSON"),
    "other JSON": ("[1, 2]", "it has no key glrt_paths"),
    "another version": ('{"glrt_paths": 2}', "its format is 2, and this version of glrt reads 1"),
    "a key too few": ('{"glrt_paths": 1}', "pixel: field required"),
    "not text": ("\udcff", "cannot be read"),
}


@pytest.mark.parametrize("case", FOREIGN)
def test_a_foreign_file_is_refused(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content, told = FOREIGN[case]
    file = tmp_path / "a.json"
    file.write_bytes(content.encode(errors="surrogateescape"))
    assert main(["paths", "--replay", str(file)]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("keys", [["recipe"], ["paths", 0, "vertices", 1], ["pixel"]])
def test_a_damaged_file_is_refused(
    stored: Path, tmp_path: Path, keys: list[Any], capsys: pytest.CaptureFixture[str]
) -> None:
    file = changed(stored, tmp_path / "a.json", keys, "gone")
    assert main(["paths", "--replay", str(file)]) == 2
    err = capsys.readouterr().err
    assert "no file of paths that glrt has stored, or it is damaged" in err
    assert str(keys[-1]) in err


def test_an_old_driver_is_refused_by_name() -> None:
    told = glrt("paths", "cornell", *PIXEL, cwd=None, **OLD_DRIVER)
    assert told.returncode == 3
    assert "fragment pipeline" in told.stderr


def test_the_guide_reports_what_the_command_tells(
    context: Context, capsys: pytest.CaptureFixture[str]
) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "paths.md").read_text()
    command, told = re.findall(r"```(?:sh)?\n(.*?)```", page, re.DOTALL)[:2]
    assert main([*shlex.split(command)[1:], "--context", context.route]) == 0
    assert capsys.readouterr().out == told
