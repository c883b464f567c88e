"""Outputs of a render: how they are named, where they may not lie, and figures nobody takes."""

import os
import sys
from errno import ENOSPC
from io import StringIO
from pathlib import Path

import pytest

from glrt.cli.main import main
from glrt.core.resources import folder
from glrt.core.text import escaped
from glrt.image.image import Image

SMALL = ("--width", "8", "--height", "8", "--samples", "2")


def render(*words: str | Path) -> int:
    return main(["render", *map(str, words), *SMALL])


# --- links -----------------------------------------------------------------------------------


def test_a_link_whose_folder_is_missing_is_reported_as_a_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.png").symlink_to("gone/b.png")
    Path("place").symlink_to("gone")
    assert render("sky", "-o", "a.png") == 2
    gone = tmp_path.resolve() / "gone"
    said = capsys.readouterr().err
    assert (
        f"Cannot write a.png: it is a link to {gone}/b.png, and there is no folder {gone}" in said
    )
    assert render("sky", "-o", "place/a.png") == 2
    assert f"place is a link to {gone}, and there is no such folder" in capsys.readouterr().err


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A scene file of the user's."""
    path = tmp_path / "room.toml"
    path.write_bytes((folder("scenes") / "sky.toml").read_bytes())
    return path


@pytest.mark.parametrize("kind", ["symlink_to", "hardlink_to", "rename"])
def test_the_scene_file_is_no_output(
    kind: str, scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is none by a link, nor by its own name if that ends like an image's."""
    output, content = tmp_path / "room.npy", scene.read_bytes()
    if kind == "rename":
        scene = scene.rename(output)
    else:
        getattr(output, kind)(scene)
    assert render(scene, "-o", tmp_path / "a.png", "-o", output) == 2
    said = capsys.readouterr().err
    assert f"Cannot write {output}: it is the scene file itself, or a link to it, {scene}." in said
    assert said.count("\n") == 1
    assert scene.read_bytes() == content
    assert not (tmp_path / "a.png").exists()


def test_a_picture_may_take_the_place_of_the_picture_that_is_its_scene(tmp_path: Path) -> None:
    picture = tmp_path / "a.exr"
    assert render("sky", "-o", picture, "--quiet") == 0
    assert render(picture, "-o", picture, "--quiet", "--seed", "3") == 0
    more = ["--resume", str(picture), "-o", str(picture), "--samples", "3", "--quiet"]
    assert main(["render", *more]) == 0
    assert Image.load(picture).samples == 3


# --- what is reported ------------------------------------------------------------------------


def test_control_characters_of_a_name_are_escaped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "new\nline\x1b[31m.png"
    assert render("sky", "-o", name) == 0
    assert Path(name).exists()
    said = capsys.readouterr().err
    assert said.startswith(r"Wrote new\nline\x1b[31m.png: 8 x 8")
    assert said.count("\n") == 1


def test_escaped_text_is_whole_and_printable() -> None:
    assert escaped("plain Ö 球") == "plain Ö 球"
    assert escaped("a\tb\udcff\x85") == r"a\tb\udcff\x85"


class Full(StringIO):
    """A stream to a full disk."""

    def write(self, _: str) -> int:
        raise OSError(ENOSPC, os.strerror(ENOSPC))


def test_figures_that_cannot_be_written_do_not_hide_where_the_picture_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "a.exr"
    monkeypatch.setattr(sys, "stdout", Full())
    assert render("sky", "-o", picture, "--json") == 4
    said = capsys.readouterr().err
    assert said.startswith(f"glrt: The picture is saved in {picture}, but its figures could not be")
    assert "No space left on device" in said
    assert said.count("\n") == 1
    assert Image.load(picture).samples == 2
