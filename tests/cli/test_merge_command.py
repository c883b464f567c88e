"""`glrt render --part` and `glrt merge`: from a queue of parts to one picture, or a refusal."""

import hashlib
import json
import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.image.image import Image, read_recipe
from tests.support.first_hits import same_aovs
from tests.support.images import picture
from tests.support.processes import glrt
from tests.support.raw_samples import render_of
from tests.support.renders import same

RENDER = render_of(149, "depth")
SCENE = ["cornell", "--width", "12", "--height", "9", "--bounces", "3", "--quiet"]


def saved(folder: Path, number: int, count: int = 3, name: str = "") -> str:
    """A part in a file, by its name."""
    path = folder / (name or f"part{number}.exr")
    RENDER.part(number, count).save(path)
    return str(path)


def three(folder: Path) -> list[str]:
    return [saved(folder, number) for number in (1, 2, 3)]


def said(capsys: pytest.CaptureFixture[str]) -> str:
    """The command's message: one paragraph, on stderr alone."""
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("glrt: ")
    assert told.err.count("\n") == 1
    assert "Traceback" not in told.err
    return told.err


# --- what merges -------------------------------------------------------------------------------


def test_parts_are_merged_into_files_of_every_kind(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outputs = [str(tmp_path / f"whole.{suffix}") for suffix in ("exr", "png", "npy")]
    words = [word for output in outputs for word in ("-o", output)]
    assert main(["merge", *three(tmp_path), *words]) == 0
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith(f"Wrote {', '.join(outputs)}: 3 of 3 parts, 149 samples, estimated")
    assert told.err.count("\n") == 1
    image = Image.load(outputs[0])
    assert np.array_equal(np.load(outputs[2]), image.radiance)
    assert read_recipe(outputs[1]) == image.recipe
    assert image.samples == 149
    assert [*image.aovs] == ["depth"]


def test_figures_come_as_a_line_of_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = str(tmp_path / "whole.exr")
    given = three(tmp_path)
    assert main(["merge", *given[:2], "-o", output, "--json", "--incomplete"]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    error = Image.load(output).error
    figures = {"parts": 2, "of": 3, "samples": 96, "error": error}
    assert json.loads(told.out) == {**figures, "error_doubtful": False}
    assert main(["merge", *given, "-o", output, "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")


def test_an_output_may_be_one_of_the_parts(tmp_path: Path) -> None:
    """They have been read by then."""
    given = three(tmp_path)
    assert main(["merge", *given, "-o", str(tmp_path / "whole.exr"), "--quiet"]) == 0
    assert main(["merge", *given, "-o", given[1], "--quiet"]) == 0
    assert Path(given[1]).read_bytes() == (tmp_path / "whole.exr").read_bytes()


def test_parts_of_two_drivers_merge_with_a_caution(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = three(tmp_path)
    image = Image.load(given[1])
    assert image.recipe
    recipe = image.recipe.model_copy(update={"renderer": "another"})
    replace(image, recipe=recipe).save(given[1])
    assert main(["merge", *given, "-o", str(tmp_path / "whole.exr")]) == 0
    told = capsys.readouterr().err
    assert "glrt: caution: the parts come from several drivers" in told
    assert "another and llvmpipe" in told


def test_parts_by_both_pipelines_merge_with_a_caution(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The caution is that for two drivers: rendered again, one of the two makes all parts."""
    for number, pipeline in enumerate(["compute", "fragment"], 1):
        words = ["--samples", "32", "--part", f"{number}/2", "--pipeline", pipeline]
        assert main(["render", *SCENE, *words, "-o", str(tmp_path / f"{number}.exr")]) == 0
    given = [str(tmp_path / f"{number}.exr") for number in (2, 1)]
    assert main(["merge", *given, "-o", str(tmp_path / "whole.exr")]) == 0
    recipe = read_recipe(tmp_path / "whole.exr")
    assert recipe.pipeline == "compute and fragment"
    assert recipe.samples == 32
    told = capsys.readouterr().err
    assert "caution" in told
    assert "fragment" in told


# --- what does not -------------------------------------------------------------------------------


def twice(folder: Path) -> list[str]:
    first, second, third = three(folder)
    return [first, second, third, first]


def with_foreign(folder: Path) -> list[str]:
    image = replace(picture(), recipe=None, samples=0)
    image.save(folder / "foreign.exr")
    return [*three(folder), str(folder / "foreign.exr")]


def with_plain(folder: Path) -> list[str]:
    picture().save(folder / "plain.exr")
    return [str(folder / "plain.exr"), *three(folder)]


def with_png(folder: Path) -> list[str]:
    RENDER.part(2, 3).save(folder / "part2.png")
    first, _, third = three(folder)
    return [first, str(folder / "part2.png"), third]


def merged_before(folder: Path) -> list[str]:
    first, second, third = three(folder)
    assert main(["merge", first, second, "--incomplete", "--quiet", "-o", first]) == 0
    return [first, third]


def copied(folder: Path) -> list[str]:
    return [*three(folder), saved(folder, 3, name="copy.exr")]


def not_there(folder: Path) -> list[str]:
    return [*three(folder), str(folder / "none.exr")]


def not_an_image(folder: Path) -> list[str]:
    (folder / "text.exr").write_text("no image")
    return [*three(folder), str(folder / "text.exr")]


REFUSED: dict[str, tuple[Callable[[Path], list[str]], list[str]]] = {
    "a name twice": (twice, ["part1.exr is given twice; leave one out"]),
    "a part twice": (copied, ["part3.exr and ", "copy.exr are both part 3 of 3"]),
    "another's picture": (with_foreign, ["foreign.exr", "no recipe"]),
    "a whole picture": (with_plain, ["plain.exr is not a part of a render", "--part K/N"]),
    "a PNG": (with_png, ["part2.png is not an .exr file"]),
    "merged already": (merged_before, ["part1.exr was merged already, of parts 1, 2 of 3"]),
    "no such file": (not_there, ["none.exr", "No such file"]),
    "no image": (not_an_image, ["text.exr", "not an EXR image"]),
    "missing": (lambda f: three(f)[:1], ["2 of 3 parts are missing: 2, 3.", "--part 2/3"]),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_merged_exits_2_and_writes_nothing(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made, words = REFUSED[name]
    given = made(tmp_path)
    before = sorted(tmp_path.iterdir())
    outputs = ["-o", str(tmp_path / "whole.exr"), "-o", str(tmp_path / "whole.png")]
    assert main(["merge", *given, *outputs]) == 2
    message = said(capsys)
    for word in words:
        assert word in message
    assert sorted(tmp_path.iterdir()) == before


OUTPUTS = {
    "suffix": ("whole.jpg", [".exr, .png or .npy"]),
    "no folder": ("nowhere/whole.exr", ["nowhere"]),
    "a folder": ("folder.exr", ["folder.exr"]),
}


@pytest.mark.parametrize("name", OUTPUTS)
def test_an_output_that_cannot_be_written_is_reported_before_anything_is(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output, words = OUTPUTS[name]
    (tmp_path / "folder.exr").mkdir()
    given = three(tmp_path)
    before = sorted(tmp_path.iterdir())
    outputs = ["-o", str(tmp_path / "good.exr"), "-o", str(tmp_path / output)]
    assert main(["merge", *given, *outputs]) == 2
    message = said(capsys)
    for word in words:
        assert word in message
    assert sorted(tmp_path.iterdir()) == before


LINES = {
    "merge {parts}": "-o",
    "merge -o {folder}/a.exr": "PART.exr",
    "render cornell -o {folder}/a.exr --part 4/3": "--part 4/3: parts are numbered from 1 to 3",
    "render cornell -o {folder}/a.exr --part 1/17 --samples 256": "at most 16 parts",
    "render cornell -o {folder}/a.exr --part 1of3": "'1of3' is not K/N, such as 3/7",
    "render cornell -o {folder}/a.exr --aov depht": "'depht'",
}


@pytest.mark.parametrize("line", LINES)
def test_command_lines_that_make_no_sense_exit_2(
    line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = line.format(parts=" ".join(three(tmp_path)), folder=tmp_path).split()
    assert main(words) == 2
    assert LINES[line] in said(capsys)
    assert not (tmp_path / "a.exr").exists()


# --- whole stories -------------------------------------------------------------------------------


def test_an_interrupted_part_is_finished_as_the_message_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from glrt import Renderer, load

    names = [str(tmp_path / f"{number}.exr") for number in (1, 2)]
    words = [*SCENE, "--samples", "48", "--aov", "depth"]
    assert main(["render", *words, "--part", "1/2", "-o", names[0]]) == 0
    assert main(["render", *words, "--part", "2/2", "-o", names[1]]) == 0
    whole = Image.load(names[1])
    assert whole.recipe
    begun = Renderer(load("cornell"), whole.recipe.settings, tier="complete", part=(2, 2))
    begun.render(5).image().save(names[1])
    begun.release()
    assert main(["merge", *names, "-o", str(tmp_path / "whole.exr")]) == 2
    message = said(capsys)
    assert "has 5 of its 32 samples" in message
    advice = message.split("`")[1].split()
    assert advice[:2] == ["glrt", "render"]
    assert main([*advice[1:], "--quiet"]) == 0
    assert same(Image.load(names[1]), whole)
    assert same_aovs(Image.load(names[1]).aovs, whole.aovs)
    assert main(["merge", *names, "-o", str(tmp_path / "whole.exr"), "--quiet"]) == 0


@pytest.mark.slow
def test_seven_parts_in_any_order_are_a_picture_that_can_be_rendered_again(
    tmp_path: Path,
) -> None:
    """The test runs the real commands, the last in their own processes: the bytes are the same."""
    names = [str(tmp_path / f"{number}.exr") for number in range(1, 8)]
    words = [*SCENE, "--samples", "120", "--aov", "depth,object"]
    for number, name in enumerate(names, 1):
        assert main(["render", *words, "--part", f"{number}/7", "-o", name]) == 0
    random.Random(3).shuffle(names)
    whole = tmp_path / "whole.exr"
    done = glrt("merge", *names, "-o", whole, "-o", tmp_path / "whole.npy", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = glrt("render", whole, "-o", tmp_path / "b.npy", "-o", tmp_path / "b.exr", "--quiet")
    assert (done.returncode, done.stderr) == (0, "")
    hashes = [
        hashlib.sha256((tmp_path / name).read_bytes()).hexdigest()
        for name in ("whole.npy", "b.npy")
    ]
    assert hashes[0] == hashes[1]
    assert (tmp_path / "b.exr").read_bytes() == whole.read_bytes()
    assert main(["merge", *sorted(names), "-o", str(tmp_path / "c.exr"), "--quiet"]) == 0
    assert (tmp_path / "c.exr").read_bytes() == whole.read_bytes()
