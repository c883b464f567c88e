"""The fixture `picture`: what passes, what fails, what it writes, and what it says."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from glrt.core.errors import ContextError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.testing import pictures
from glrt.testing.pictures import Pictures
from tests.support.builders import MATTE, scene_of, sphere

SIZE: Any = {"width": 16, "height": 12}
DIM, BRIGHT = (  # 10 % brighter
    scene_of([sphere([0, 0, -2], 0.7, "white")], {"white": MATTE}, background={"color": [sky] * 3})
    for sky in (1.0, 1.1)
)


@pytest.fixture(autouse=True)
def shared_context(monkeypatch: pytest.MonkeyPatch, context: Context) -> None:
    monkeypatch.setattr(pictures, "_context", lambda: context)


def checker(folder: Path, update: bool = False, most: int = 9) -> Pictures:
    return Pictures(folder, "test_x.py::test_x[a/b]", 1e-3, most, update)


def failure(act: Any, *arguments: Any, **more: Any) -> str:
    with pytest.raises(pytest.fail.Exception) as caught:
        act(*arguments, **more)
    return str(caught.value)


def test_a_reference_is_written_once_and_the_same_scene_passes(tmp_path: Path) -> None:
    update = checker(tmp_path, update=True)
    assert update.check(load("cornell"), "room", 16, **SIZE) is None
    file = tmp_path / "references" / "room.exr"
    assert update.written == [file]
    reference = Image.load(file)
    assert reference.samples == 64
    assert reference.recipe
    assert reference.recipe.settings.seed == 1
    found = checker(tmp_path).check(load("cornell"), "room", 16, **SIZE)
    assert found
    assert found.alpha == 1e-3
    before = file.read_bytes()
    again = checker(tmp_path, update=True)
    assert again.check(load("cornell"), "room", 16, **SIZE)
    assert (again.written, file.read_bytes()) == ([], before)
    assert not (tmp_path / "failed").exists()


def test_a_brighter_lamp_fails_and_leaves_three_pictures(tmp_path: Path) -> None:
    checker(tmp_path, update=True).check(DIM, "ball", 16, **SIZE)
    told = failure(checker(tmp_path).check, BRIGHT, "ball", 16, **SIZE)
    assert told.startswith("ball: different:")
    assert told.endswith("write the reference: pytest --glrt-update 'test_x.py::test_x[a/b]'")
    shown = sorted(file.name for file in (tmp_path / "failed").iterdir())
    assert shown == ["ball-difference.png", "ball-reference.png", "ball.png"]
    assert checker(tmp_path).check(DIM, "ball", 16, **SIZE)
    assert not [*(tmp_path / "failed").iterdir()], "they are of an earlier failure"
    checker(tmp_path, update=True).check(DIM, "deep/ball", 16, **SIZE)
    failure(checker(tmp_path).check, BRIGHT, "deep/ball", 16, **SIZE)
    assert (tmp_path / "failed" / "deep" / "ball.png").exists()
    checker(tmp_path, update=True).check(BRIGHT, "ball", 16, **SIZE)
    assert checker(tmp_path).check(BRIGHT, "ball", 16, **SIZE)


def test_a_missing_reference_is_a_failure(tmp_path: Path) -> None:
    told = failure(checker(tmp_path).check, "cornell", **SIZE)
    assert f"{tmp_path / 'references' / 'cornell.exr'} is missing" in told
    told = failure(checker(tmp_path).same_bits, DIM, **SIZE)
    assert told.startswith("test_x_a_b: ")
    assert "test_x_a_b.bits.exr is missing" in told


def test_a_reference_of_another_size_fails_until_it_is_written(tmp_path: Path) -> None:
    checker(tmp_path, update=True).check(DIM, "ball", 8, width=8, height=8)
    assert "has another size" in failure(checker(tmp_path).check, DIM, "ball", 8, **SIZE)
    checker(tmp_path, update=True).check(DIM, "ball", 8, **SIZE)
    assert checker(tmp_path).check(DIM, "ball", 8, **SIZE)


def test_strict_fails_where_one_percent_might_go_unseen(tmp_path: Path) -> None:
    scene = load("cornell")
    checker(tmp_path, update=True).check(scene, "room", 16, **SIZE)
    found = checker(tmp_path).check(scene, "room", 16, **SIZE)
    assert found
    assert found.verdict == "undecided"
    told = failure(checker(tmp_path).check, scene, "room", 16, strict=True, **SIZE)
    assert told.startswith("room: undecided")


def test_bits_are_compared_on_one_driver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    checker(tmp_path, update=True).same_bits(DIM, "ball", 4, **SIZE)
    image = checker(tmp_path).same_bits(DIM, "ball", 4, **SIZE)
    assert image.samples == 4
    told = failure(checker(tmp_path).same_bits, DIM, "ball", 5, **SIZE)
    assert "its bits are not those of" in told
    assert (tmp_path / "failed" / "ball.png").exists()
    assert image.recipe
    other = replace(image, recipe=image.recipe.model_copy(update={"renderer": "a GPU"}))
    other = replace(other, radiance=other.radiance + 1)
    monkeypatch.setattr(Image, "load", lambda file: other)
    assert "on a GPU, and the picture by" in failure(
        checker(tmp_path).same_bits, DIM, "ball", 4, **SIZE
    )


def test_the_page_shows_bits_that_differ_even_below_the_noise(tmp_path: Path) -> None:
    parts = tmp_path / "parts"
    checker(tmp_path, update=True).same_bits(DIM, "ball", 32, sampler="independent", **SIZE)
    with_page = replace(checker(tmp_path), parts=parts)
    with_page.same_bits(DIM, "ball", 32, sampler="independent", **SIZE)
    failure(with_page.same_bits, DIM, "ball", 32, seed=1, sampler="independent", **SIZE)
    first, second = (json.loads(file.read_text()) for file in sorted(parts.iterdir()))
    assert (first["title"], first["verdict"], first["text"]) == ("ball, bits", "same", "equal bits")
    assert second["verdict"] == "different"
    assert second["text"].startswith("the bits differ; up to noise undecided")


def test_bits_without_errors_are_judged_without_a_part_of_the_page(tmp_path: Path) -> None:
    checker(tmp_path, update=True).same_bits(DIM, "ball", 1, **SIZE)
    with_page = replace(checker(tmp_path), parts=tmp_path / "parts")
    with_page.same_bits(DIM, "ball", 1, **SIZE)
    assert not (tmp_path / "parts").exists()


def test_more_pictures_than_the_chance_is_divided_among_fail(tmp_path: Path) -> None:
    update = checker(tmp_path, update=True, most=1)
    update.check(DIM, "one", 1, **SIZE)
    told = failure(update.check, DIM, "other", 1, **SIZE)
    assert "@pytest.mark.pictures(2)" in told


def test_a_scene_file_is_found_from_the_test_file(tmp_path: Path) -> None:
    from glrt.core.resources import folder

    (tmp_path / "scenes").mkdir()
    text = (folder("scenes") / "cornell.toml").read_text()
    (tmp_path / "scenes" / "room.toml").write_text(text)
    checker(tmp_path, update=True).check("scenes/room.toml", samples=1, **SIZE)
    checker(tmp_path, update=True).check(Path("scenes/room.toml"), "same", 1, **SIZE)
    assert {file.name for file in (tmp_path / "references").iterdir()} == {"room.exr", "same.exr"}
    assert "no_such" in failure(checker(tmp_path).check, "no_such", **SIZE)


def test_errors_of_the_renderer_are_failures_in_one_paragraph(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(scene: Scene, *arguments: Any, **more: Any) -> Image:
        raise ContextError("no OpenGL here")

    monkeypatch.setattr(pictures, "render", refused)
    assert failure(checker(tmp_path, update=True).check, DIM, **SIZE) == "no OpenGL here"
