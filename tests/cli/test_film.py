"""`glrt film`: the frames of a series and the files made of them; nothing is rendered twice."""

import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image as Pillow
from PIL import ImageSequence

from glrt.image.image import Image
from tests.support.images import same_bits
from tests.support.moving_ball import MOVING_BALL
from tests.support.processes import glrt, start

SMALL = ("--width", "24", "--height", "16", "--samples", "16")


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A ball that crosses the picture in four frames."""
    path = tmp_path / "ball.toml"
    path.write_text(MOVING_BALL)
    return path


def film(*arguments: str | Path) -> list[dict[str, object]]:
    """Figures of the frames and of the film."""
    done = glrt("film", *arguments, "--json")
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_frames_are_the_pictures_that_render_makes(scene: Path, tmp_path: Path) -> None:
    *frames, whole = film(scene, "-o", tmp_path / "f" / "%03d.exr", *SMALL)
    assert [Path(str(frame["file"])).name for frame in frames] == [f"00{n}.exr" for n in range(4)]
    assert (whole["frames"], whole["rendered"], whole["fps"]) == (4, 4, 3)
    still = tmp_path / "still.exr"
    done = glrt("render", scene, "--frame", "2", "-o", still, *SMALL)
    assert done.returncode == 0, done.stderr
    found, expected = Image.load(tmp_path / "f" / "002.exr"), Image.load(still)
    assert same_bits(found.radiance, expected.radiance)
    assert found.recipe
    assert expected.recipe
    assert found.recipe.scene == expected.recipe.scene
    again = tmp_path / "again.exr"
    assert glrt("render", tmp_path / "f" / "002.exr", "-o", again).returncode == 0
    assert same_bits(Image.load(again).radiance, expected.radiance)


def test_frames_that_stand_are_kept_and_others_are_rendered(scene: Path, tmp_path: Path) -> None:
    output = tmp_path / "####.png"
    film(scene, "-o", output, *SMALL, "--frames", "1-2")
    (tmp_path / "0002.png").write_bytes((tmp_path / "0002.png").read_bytes()[:99])
    before = (tmp_path / "0001.png").stat().st_mtime_ns
    frames = film(scene, "-o", output, *SMALL)[:-1]
    assert [frame["kept"] for frame in frames] == [False, True, False, False]
    assert (tmp_path / "0001.png").stat().st_mtime_ns == before
    others = film(scene, "-o", output, *SMALL, "--seed", "1")[:-1]
    assert not any(frame["kept"] for frame in others)
    brighter = film(scene, "-o", output, *SMALL, "--seed", "1", "--exposure", "1")[:-1]
    assert not any(frame["kept"] for frame in brighter)


def test_exposure_changes_a_film_without_a_sample(scene: Path, tmp_path: Path) -> None:
    options = (scene, "-o", tmp_path / "film.webp", *SMALL, "--keep-frames")
    film(*options)
    bright = grey(tmp_path / "film.webp")
    figures = film(*options, "--exposure", "-2")
    assert figures[-1]["rendered"] == 0
    assert grey(tmp_path / "film.webp") < 0.7 * bright


def grey(path: Path) -> float:
    """Mean grey of the first frame, in codes of 255."""
    with Pillow.open(path) as picture:
        return float(np.asarray(picture.convert("L")).mean())


@pytest.mark.parametrize("suffix", ["webp", "gif"])
def test_a_film_holds_its_frames_times_and_recipe(scene: Path, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"film.{suffix}"
    film(scene, "-o", path, *SMALL)
    assert not Path(f"{path}.frames").exists()
    film(scene, "-o", tmp_path / "%d.png", *SMALL)
    with Pillow.open(path) as found:
        times = []
        for number, frame in enumerate(ImageSequence.Iterator(found)):
            picture = np.asarray(frame.convert("RGB"), float)
            times.append(found.info["duration"])
            still = np.asarray(Pillow.open(tmp_path / f"{number}.png"), float)
            assert np.abs(picture - still).mean() < 6  # codes of 255: both formats lose some
        text = found.info.get("xmp") or found.info["comment"]
    assert len(times) == 4
    assert sum(times) == (1333 if suffix == "webp" else 1330)
    recipe = json.loads(text)
    assert recipe["scene"]["animation"]["fps"] == 3
    assert (recipe["frames"], recipe["settings"]["samples"]) == ([0, 3], 16)


def test_an_mp4_shows_its_frames_in_their_colours(scene: Path, tmp_path: Path) -> None:
    odd = ("--width", "25", "--height", "17", "--samples", "16")
    film(scene, "-o", tmp_path / "film.mp4", *odd)
    film(scene, "-o", tmp_path / "%d.png", *odd)
    with av.open(str(tmp_path / "film.mp4")) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
        assert container.streams.video[0].average_rate == 3
        assert json.loads(container.metadata["comment"])["fps"] == 3
    assert len(frames) == 4
    for number, frame in enumerate(frames):
        still = np.asarray(Pillow.open(tmp_path / f"{number}.png"), float)
        assert frame.shape == (18, 26, 3)
        assert np.abs(frame[:17, :25] - still).mean() < 6


def test_a_sheet_has_a_row_for_each_step_of_the_first_sweep(tmp_path: Path) -> None:
    rows, columns = "materials.white.color=0,0,0:0.8,0.8,0.8:2", "render.bounces=0:2:3"
    path = tmp_path / "sheet.png"
    film("cornell", "-o", path, *SMALL, "--sweep", rows, "--sweep", columns)
    sheet = np.asarray(Pillow.open(path), float)
    assert sheet.shape == (8 + 2 * (16 + 2 * 18 + 8), 8 + 3 * (24 + 8), 3)
    cells = [
        [sheet[y : y + 16, x : x + 24].mean() for x in (8, 40, 72)] for y in (8, 8 + 16 + 36 + 8)
    ]
    assert cells[0][0] == cells[1][0]  # no bounce: the lamp alone
    assert cells[0][0] < cells[0][1] < cells[1][1] < cells[1][2]
    assert sheet[8 + 16 : 8 + 16 + 36, 8:32].max() > 100  # a label


KILLED = """
import os, sys
from glrt.cli.main import main
from glrt.core import files
rename, count, number = files._rename, [0], int(sys.argv.pop())
def renamed(old, new):
    count[0] += 1
    if count[0] > 2:
        os.kill(os.getpid(), number)
    rename(old, new)
files._rename = renamed
sys.exit(main())
"""


def killed(number: int, *arguments: str | Path) -> "subprocess.CompletedProcess[str]":
    """`glrt film` that gets a signal while its third file is about to stand."""
    words = [sys.executable, "-c", KILLED, "film", *map(str, arguments), str(int(number))]
    return subprocess.run(words, capture_output=True, text=True, timeout=250)


def test_a_killed_film_goes_on_to_the_same_bits(scene: Path, tmp_path: Path) -> None:
    options = (scene, *SMALL, "--vary-seed")
    film(*options, "-o", tmp_path / "whole" / "%d.exr")
    done = killed(signal.SIGKILL, *options, "-o", tmp_path / "cut" / "%d.exr")
    assert done.returncode == -signal.SIGKILL
    frames = film(*options, "-o", tmp_path / "cut" / "%d.exr")[:-1]
    assert [frame["kept"] for frame in frames] == [True, True, False, False]
    for number in range(4):
        pair = [(tmp_path / f / f"{number}.exr").read_bytes() for f in ("whole", "cut")]
        assert pair[0] == pair[1]


def test_other_files_in_the_folder_of_the_frames_are_kept(scene: Path, tmp_path: Path) -> None:
    folder = tmp_path / "film.gif.frames"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    film(scene, "-o", tmp_path / "film.gif", *SMALL)
    assert [file.name for file in folder.iterdir()] == ["notes.txt"]


@pytest.mark.parametrize("suffix", ["exr", "png"])
def test_a_frame_that_was_cut_off_is_rendered_again(
    scene: Path, tmp_path: Path, suffix: str
) -> None:
    options = (scene, *SMALL, "--frames", "0-1", "-o", tmp_path / f"%d.{suffix}")
    film(*options)
    whole = (tmp_path / f"1.{suffix}").read_bytes()
    (tmp_path / f"1.{suffix}").write_bytes(whole[:-40])
    assert [frame["kept"] for frame in film(*options)[:-1]] == [True, False]
    assert (tmp_path / f"1.{suffix}").read_bytes() == whole


@pytest.mark.slow
def test_a_film_killed_at_ten_moments_has_the_same_bits(tmp_path: Path) -> None:
    options = ("cradle", *SMALL, "--frames", "0-7")
    film(*options, "-o", tmp_path / "whole" / "%d.exr")
    draw, kills = random.Random(1), 0
    while kills < 10:
        process = start("film", *options, "-o", tmp_path / "cut" / "%d.exr")
        time.sleep(draw.uniform(0.1, 1.5))
        process.kill()
        process.communicate(timeout=250)
        kills += 1
        for file in (tmp_path / "cut").glob("[0-9].exr"):
            assert file.read_bytes() == (tmp_path / "whole" / file.name).read_bytes()
    film(*options, "-o", tmp_path / "cut" / "%d.exr")
    for number in range(8):
        pair = [(tmp_path / f / f"{number}.exr").read_bytes() for f in ("whole", "cut")]
        assert pair[0] == pair[1]


def test_an_interrupted_film_says_how_to_go_on(scene: Path, tmp_path: Path) -> None:
    command = """
import os, signal, sys
from glrt.cli.main import main
from glrt.series import rendering
saved = rendering.Image.save
def save(image, *arguments):
    saved(image, *arguments)
    os.kill(os.getpid(), signal.SIGINT)
rendering.Image.save = save
sys.exit(main())
"""
    words = ["film", str(scene), "-o", str(tmp_path / "film.gif"), *SMALL]
    done = subprocess.run(
        [sys.executable, "-c", command, *words], capture_output=True, text=True, timeout=250
    )
    assert done.returncode == 130
    assert "interrupted; 1 of 4 frames are done: the same command continues" in done.stderr
    assert not (tmp_path / "film.gif").exists()
    assert (tmp_path / "film.gif.frames" / "0000.exr").exists()


def test_black_frames_are_named(tmp_path: Path) -> None:
    """The camera of this room turns out of it, behind its walls."""
    done = glrt("film", "cornell", "-o", tmp_path / "a.gif", "--turntable", "3", *SMALL)
    assert done.returncode == 0
    assert "caution: frames 1, 2: all is black" in done.stderr


def test_a_frame_that_misses_its_error_is_named(scene: Path, tmp_path: Path) -> None:
    output = tmp_path / "%d.exr"
    limits = ("--width", "24", "--height", "16", "--samples", "64", "--frames", "0-1")
    for _ in range(2):  # the frames of the first run count in the second
        done = glrt("film", scene, "-o", output, *limits, "--error", "1e-6")
        assert done.returncode == 1
        assert "--error 1e-06 was not reached by frames 0, 1" in done.stderr
    assert glrt("film", scene, "-o", output, *limits, "--error", "0.5").returncode == 0


def test_a_frame_that_fails_leaves_the_others(scene: Path, tmp_path: Path) -> None:
    wild = scene.with_name("wild.toml")
    track = 'target = "camera.fov", times = [0, 1, 2], values = [1, 1, 170]'
    curve = f'{{ {track}, interpolation = "cubic" }}]'
    wild.write_text(MOVING_BALL.replace("fps = 3", "fps = 2").replace("] }]", f"] }}, {curve}"))
    output = tmp_path / "%d.exr"
    done = glrt("film", wild, "-o", output, *SMALL)
    assert done.returncode == 4
    assert "frame 1 failed: frame 1: camera: fov must be greater than 0" in done.stderr
    assert "frame 1 failed; the others are kept" in done.stderr.splitlines()[-1]
    assert sorted(path.name for path in tmp_path.glob("*.exr")) == [
        "0.exr",
        "2.exr",
        "3.exr",
        "4.exr",
    ]
