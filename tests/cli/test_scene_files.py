"""Scenes and pictures with files, as a user moves, changes, resumes and merges them."""

import io
import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.core.errors import GlrtError
from glrt.image.image import Image, read_recipe
from tests.support.sky_images import random_sky, write_exr

SCENE = """
[camera]
position = [0, 1, 3]
look_at = [0, 0, 0]

[background]
image = "sky.exr"

[materials.floor]
type = "lambertian"
color = [0.5, 0.5, 0.5]

[[objects]]
shape = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "floor"
"""
SMALL = ["--width", "16", "--height", "8", "--quiet"]


@pytest.fixture
def room(tmp_path: Path) -> Path:
    """A folder with a scene, its image, and a picture of it."""
    folder = tmp_path / "room"
    folder.mkdir()
    write_exr(folder / "sky.exr", random_sky(8, 4))
    (folder / "scene.toml").write_text(SCENE)
    assert render(folder / "scene.toml", folder / "a.exr", "--samples", "32") == 0
    return folder


def render(source: Path | str, output: Path, *words: str) -> int:
    return main(["render", str(source), "-o", str(output), *SMALL, *words])


def bits(picture: Path) -> bytes:
    if picture.suffix == ".npy":
        return bytes(np.load(picture).tobytes())
    return Image.load(picture).radiance.tobytes()


def test_a_picture_that_was_moved_with_its_file_renders_again(room: Path, tmp_path: Path) -> None:
    shutil.copytree(room, tmp_path / "moved")
    shutil.rmtree(room)
    place = tmp_path / "moved"
    assert render(place / "a.exr", place / "b.npy") == 0
    assert bits(place / "b.npy") == bits(place / "a.exr")


def test_the_files_may_lie_elsewhere(
    room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    alone = tmp_path / "alone.exr"
    shutil.copy(room / "a.exr", alone)
    assert render(alone, tmp_path / "b.npy") == 2
    said = capsys.readouterr().err
    assert "there is no file 'sky.exr'" in said
    assert "--assets-from" in said or "did you mean" in said
    assert render(alone, tmp_path / "b.npy", "--assets-from", str(room)) == 0
    assert bits(tmp_path / "b.npy") == bits(alone)


def test_a_file_that_has_changed_is_refused_unless_accepted(
    room: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_exr(room / "sky.exr", random_sky(8, 4, seed=2))
    assert render(room / "a.exr", room / "b.exr") == 2
    assert "is not the file that this picture was made with" in capsys.readouterr().err
    assert not (room / "b.exr").exists()
    assert render(room / "a.exr", room / "b.exr", "--assets", "changed") == 0
    assert bits(room / "b.exr") != bits(room / "a.exr")
    before, now = (read_recipe(room / name).assets["sky.exr"] for name in ("a.exr", "b.exr"))
    assert before != now


def test_what_lies_outside_is_the_users_to_allow(
    room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    inner = room / "inner"
    inner.mkdir()
    (inner / "scene.toml").write_text(SCENE.replace('"sky.exr"', '"../sky.exr"'))
    assert render(inner / "scene.toml", room / "b.npy", "--samples", "32") == 2
    assert "--allow-outside" in capsys.readouterr().err
    words = ("--samples", "32", "--allow-outside")
    assert render(inner / "scene.toml", inner / "b.exr", *words) == 0
    assert bits(inner / "b.exr") == bits(room / "a.exr")
    assert render(inner / "b.exr", room / "c.npy") == 2, "a picture never widens access"
    assert "lies outside" in capsys.readouterr().err


def test_a_scene_from_standard_input_has_no_folder(
    room: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for words, code in (((), 2), (("--assets-from", str(room)), 0)):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(SCENE.encode())))
        assert render("-", room / "b.npy", "--samples", "32", *words) == code
    assert "give --assets-from DIR" in capsys.readouterr().err
    assert bits(room / "b.npy") == bits(room / "a.exr")


def test_json_reports_the_files(room: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert render(room / "scene.toml", room / "b.npy", "--samples", "1", "--json") == 0
    told = json.loads(capsys.readouterr().out)["assets"]
    assert told == read_recipe(room / "a.exr").assets
    assert list(told) == ["sky.exr"]


def test_resume_parts_and_comparison_find_the_files(
    room: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole, resumed = room / "whole.exr", room / "resumed.exr"
    assert render(room / "scene.toml", whole, "--samples", "64") == 0
    words = ["render", "--resume", str(room / "a.exr"), "-o", str(resumed), "--samples", "64"]
    assert main([*words, "--quiet"]) == 0
    assert bits(resumed) == bits(whole)
    parts = [room / f"part{k}.exr" for k in (1, 2)]
    for k, part in enumerate(parts):
        assert render(room / "scene.toml", part, "--samples", "64", "--part", f"{k + 1}/2") == 0
    merged = room / "merged.exr"
    assert main(["merge", *map(str, parts), "-o", str(merged), "--quiet"]) == 0
    assert render(merged, room / "again.npy") == 0
    assert bits(room / "again.npy") == bits(merged)
    assert main(["compare", str(whole), str(merged), "--groups"]) in (0, 1)
    assert "light group background" in capsys.readouterr().out


def test_a_picture_under_another_sky_is_not_resumed(
    room: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_exr(room / "sky.exr", random_sky(8, 4, seed=2))
    resume = ["render", "--resume", str(room / "a.exr"), "-o", str(room / "b.exr")]
    assert main([*resume, "--samples", "64"]) == 2
    assert "is not the file that this picture was made with" in capsys.readouterr().err
    assert main([*resume, "--samples", "64", "--assets", "changed"]) == 2
    assert "the SHA-256 of sky.exr is" in capsys.readouterr().err


def test_parts_under_other_skies_are_not_merged(
    room: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    parts = [room / f"part{k}.exr" for k in (1, 2)]
    for k, part in enumerate(parts):
        write_exr(room / "sky.exr", random_sky(8, 4, seed=k))
        assert render(room / "scene.toml", part, "--samples", "64", "--part", f"{k + 1}/2") == 0
    assert main(["merge", *map(str, parts), "-o", str(room / "m.exr")]) == 2
    assert "the SHA-256 of sky.exr is" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["inspect", "render"])
def test_every_command_reads_them(room: Path, command: str) -> None:
    words = [command, str(room / "scene.toml")]
    more = ["-o", str(room / "b.png"), *SMALL, "--samples", "1"] if command == "render" else []
    assert main([*words, *more]) == 0


def test_a_recipe_whose_hashes_are_damaged_is_refused(room: Path) -> None:
    recipe = read_recipe(room / "a.exr")
    for damage in ('"assets": {"sky.exr": 3}', '"assets": []', '"assets": {"sky.exr": "xyz"}'):
        text = recipe.to_json().replace(f'"assets": {json.dumps(recipe.assets)}', damage)
        assert damage in text
        with pytest.raises(GlrtError, match="not SHA-256 by path"):
            type(recipe).from_json(text, "a.exr")
