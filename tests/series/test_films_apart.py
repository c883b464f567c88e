"""Two commands on one film are kept apart, and a series says what has no effect."""

import signal
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from glrt.cli import film as command
from glrt.cli.main import main
from glrt.core.errors import RenderError, UsageError
from glrt.image.sources import load
from glrt.scene.scenefile.toml import parse_scene
from glrt.series.film import Film
from glrt.series.lock import NAME, locked
from glrt.series.outputs import parse_output
from glrt.series.rendering import RenderOptions
from glrt.series.series import Series
from glrt.series.sweeps import parse_sweep
from glrt.settings import Settings
from tests.support.moving_ball import MOVING_BALL

SMALL = Settings(width=24, height=16, samples=16)
FILM = ["--width", "24", "--height", "16", "--samples", "16", "--turntable", "2"]
HOLDER = """
import sys, time
from dataclasses import replace
from pathlib import Path
from glrt.series.film import Film
from glrt.series.lock import locked
with locked(Path(sys.argv[1]), Path("film.webp")):
    print("held", flush=True)
    time.sleep(200)
"""


def test_a_second_command_on_a_film_says_who_renders_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "film.webp"
    folder = tmp_path / "film.webp.frames"
    with locked(folder, output):
        assert main(["film", "cornell", "-o", str(output), *FILM]) == RenderError.exit_code
        (line,) = capsys.readouterr().err.splitlines()
        assert f"{output} is being rendered by process " in line
        assert line.endswith("Wait until that has ended, or choose another name with -o.")
        assert [path.name for path in folder.iterdir()] == [NAME]
    assert not folder.exists()


def test_the_lock_of_a_killed_process_is_free(tmp_path: Path) -> None:
    folder = tmp_path / "frames"
    words = [sys.executable, "-c", HOLDER, str(folder)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout
        assert process.stdout.readline() == "held\n"
        with (
            pytest.raises(RenderError, match=f"process {process.pid} on "),
            locked(folder, tmp_path / "film.webp"),
        ):
            pass
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert (folder / NAME).exists()
    with locked(folder, tmp_path / "film.webp"):
        pass
    assert not folder.exists()


def test_frames_with_files_of_their_own_are_shared(tmp_path: Path) -> None:
    output = parse_output(str(tmp_path / "%d.exr"))
    film = Film(Series(load("cornell"), SMALL, turns=2), range(2), output, RenderOptions())
    with film.locked(), film.locked():
        pass
    whole = replace(film, output=parse_output(str(tmp_path / "a.webp")))
    with whole.locked(), pytest.raises(RenderError), whole.locked():
        pass


def test_a_shutter_is_no_sweep() -> None:
    sweep = parse_sweep("camera.shutter=0:1:3")
    with pytest.raises(UsageError, match="all frames would be equal"):
        Series(load("cornell"), SMALL, sweeps=(sweep,)).check()


def test_a_turntable_says_that_it_blurs_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "_rendered", lambda *_arguments: 0)
    text = MOVING_BALL.replace("[0, 0, 5],", "[0, 0, 5], shutter = 0.5,")
    scene = parse_scene(tomllib.loads(text), "x")
    assert not Series(scene, SMALL).idle_shutter
    turns = "a frame of a turntable shows a moment of the [animation]. Leave out --turntable"
    assert turns in Series(scene, SMALL, turns=2).idle_shutter
    sweep = parse_sweep("camera.fov=20:40:2")
    assert "Leave out --sweep" in Series(scene, SMALL, sweeps=(sweep,)).idle_shutter
    (tmp_path / "a.toml").write_text(text)
    film = ["film", str(tmp_path / "a.toml"), "-o", str(tmp_path / "a.webp"), *FILM, "--quiet"]
    assert main(film) == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert turns in line


def test_a_film_has_the_cautions_of_a_picture(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A shutter in a scene without animation."""
    monkeypatch.setattr(command, "_rendered", lambda *_arguments: 0)
    still = MOVING_BALL.partition("[animation]")[0]
    text = still.replace("[0, 0, 5],", "[0, 0, 5], shutter = 0.5,")
    (tmp_path / "a.toml").write_text(text)
    film = ["film", str(tmp_path / "a.toml"), "-o", str(tmp_path / "a.webp"), *FILM, "--quiet"]
    assert main(film) == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert "blurs nothing: the scene has no [animation] with tracks" in line


def test_options_of_a_film_that_do_nothing_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "_rendered", lambda *_arguments: 0)
    idle = ["--fps", "12", "--keep-frames", "--chunk", "2", "--caustics", "off"]
    swept = ["--sweep", "render.particles=1:2:2"]
    film = ["film", "cornell", *FILM[:-2], *swept, *idle]
    assert main([*film, "-o", str(tmp_path / "%d.exr")]) == 0
    told = capsys.readouterr().err.splitlines()
    assert [line.split(" has no effect here: ")[0] for line in told] == [
        f"glrt: caution: --{name}" for name in ("fps", "keep-frames", "chunk", "particles")
    ]
    assert main([*film, "-o", str(tmp_path / "a.webp")]) == 0
    assert len(capsys.readouterr().err.splitlines()) == 2
