"""Saves now and then: how often, and what is done when a file cannot be written."""

import re
import shlex
import tempfile
from pathlib import Path
from typing import Any

import pytest

from glrt.cli import autosave
from glrt.cli.autosave import INTERVAL, SHARE, Autosave
from glrt.core.errors import RenderError
from glrt.image.image import Image
from tests.support.images import picture


class Fake:
    """A renderer with a sample more at each look, a clock, and saves that take their time."""

    def __init__(self, seconds: float = 1.0) -> None:
        self.now, self.samples, self.saves = 0.0, 0, 0
        self._seconds = seconds

    def image(self) -> Image:
        self.saves += 1
        self.now += self._seconds
        return picture()


def looked(fake: Fake, outputs: list[Path], until: float, step: float = 1.0) -> Autosave:
    """A autosave that is called every `step` seconds up to a time."""
    keeping = Autosave([str(output) for output in outputs], lambda: fake.now)
    renderer: Any = fake
    while fake.now < until:
        fake.now += step
        fake.samples += 1
        keeping.after(renderer)
    return keeping


def test_a_render_is_saved_every_minute(tmp_path: Path) -> None:
    fake = Fake()
    assert looked(fake, [tmp_path / "a.exr"], INTERVAL - 1).kept == 0
    assert not list(tmp_path.iterdir())
    fake = Fake()
    looked(fake, [tmp_path / "a.exr", tmp_path / "a.png"], 10 * INTERVAL + 10)
    assert 9 <= fake.saves <= 10
    assert {path.name for path in tmp_path.iterdir()} == {"a.exr", "a.png"}


def test_saves_that_take_long_are_rare(tmp_path: Path) -> None:
    fake = Fake(seconds=30.0)
    looked(fake, [tmp_path / "a.npy"], 6000)
    assert fake.saves * 30 <= SHARE * 6000 + 30


def test_nothing_is_saved_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(autosave, "INTERVAL", 0.0)
    fake = Fake(seconds=0.0)
    keeping = looked(fake, [tmp_path / "a.npy"], 3)
    renderer: Any = fake
    keeping.after(renderer)
    assert fake.saves == 3


def test_a_save_that_fails_is_reported_and_tried_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fake = Fake()
    keeping = looked(fake, [tmp_path / "gone" / "a.exr"], INTERVAL + 5)
    assert (fake.saves, keeping.kept) == (1, 0)
    said = capsys.readouterr().err
    assert "gone/a.exr: No such file" in said
    assert "continues" in said
    (tmp_path / "gone").mkdir()
    renderer: Any = fake
    fake.now += 2 * INTERVAL
    keeping.after(renderer)
    assert keeping.kept == fake.samples
    assert f"--resume {tmp_path}/gone/a.exr" in keeping.advice


def test_the_command_that_goes_on_can_be_pasted(tmp_path: Path) -> None:
    keeping = looked(Fake(), [tmp_path / "my render.exr"], INTERVAL + 5)
    (command,) = re.findall(r"`glrt (.*)`", keeping.advice)
    wanted = str(tmp_path / "my render.exr")
    assert shlex.split(command) == ["render", "--resume", wanted, "-o", wanted]


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for temporary files of the test's own."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def test_a_picture_whose_folder_is_gone_is_saved_elsewhere(tmp_path: Path, temporary: Path) -> None:
    with pytest.raises(RenderError, match=r"gone/a\.png.*The picture is in .*\.exr\.$"):
        Autosave([str(tmp_path / "gone" / "a.png")]).keep(picture())
    (saved,) = temporary.iterdir()
    assert Image.load(saved).samples == picture().samples


def test_what_can_be_written_is_written_and_an_exr_is_enough(
    tmp_path: Path, temporary: Path
) -> None:
    outputs = [tmp_path / "gone" / "a.png", tmp_path / "a.exr", tmp_path / "a.npy"]
    with pytest.raises(RenderError, match=r"gone/a\.png.*exr file is saved"):
        Autosave([str(output) for output in outputs]).keep(picture())
    assert outputs[1].exists()
    assert outputs[2].exists()
    assert not list(temporary.iterdir())


def test_without_any_room_only_the_reason_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "none"))
    with pytest.raises(RenderError, match=r"another place\.$"):
        Autosave([str(tmp_path / "gone" / "a.exr")]).keep(picture())
