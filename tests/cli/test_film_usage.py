"""`glrt film` refuses wrong usage before it renders anything."""

import json
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest
from openjd.model import decode_job_template

from tests.support.moving_ball import MOVING_BALL
from tests.support.processes import glrt


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A ball that crosses the picture in four frames."""
    path = tmp_path / "ball.toml"
    path.write_text(MOVING_BALL)
    return path


def no_folder(path: Path) -> tuple[str, ...]:
    (path / "file").touch()
    return ("-o", str(path / "file" / "%d.exr"))


BAD: dict[str, tuple[Callable[[Path], tuple[str, ...]], str]] = {
    "suffix": (lambda path: ("-o", str(path / "a.avi")), "a film ends in .webp, .gif or .mp4"),
    "npy": (lambda path: ("-o", str(path / "%d.npy")), "frames have a place for their number"),
    "two places": (lambda path: ("-o", str(path / "%d%d.exr")), "a place for their number"),
    "folder": (no_folder, "Cannot make the folder"),
    "range": (lambda path: ("-o", str(path / "%d.exr"), "--frames", "2-9"), "frames 0 to 3"),
    "backwards": (lambda path: ("-o", "a.gif", "--frames", "3-2"), "must not be after the last"),
    "both": (
        lambda path: ("-o", "a.gif", "--turntable", "3", "--sweep", "camera.fov=1:2:3"),
        "--turntable and --sweep do not go together",
    ),
    "thrice": (lambda path: ("-o", "a.gif", *["--sweep", "camera.fov=1:2:3"] * 3), "given twice"),
    "auto": (lambda path: ("-o", "a.gif", "--method", "auto"), "measures a single picture"),
    "fps": (lambda path: ("-o", "a.gif", "--fps", "0"), "--fps must be above 0"),
    "turns": (lambda path: ("-o", "a.gif", "--turntable", "0"), "is not a number of frames"),
    "sweep": (lambda path: ("-o", "a.gif", "--sweep", "camera.fov=1"), "is not KEY=FROM:TO:N"),
    "a job without a file": (
        lambda path: ("-o", "%d.exr", "--export", "sh"),
        "--export needs a scene file: tasks have no standard input",
    ),
    "a job of a film": (
        lambda path: ("-o", "a.gif", "--export", "sh"),
        "--export needs -o with a place for the number",
    ),
    "sheet": (
        lambda path: ("-o", "a.png", "--turntable", "9999", "--width", "999"),
        "render smaller or fewer frames",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_wrong_usage_is_refused_before_anything_is_rendered(
    scene: Path, tmp_path: Path, case: str
) -> None:
    make, words = BAD[case]
    source = "-" if case == "a job without a file" else scene
    done = glrt("film", source, *make(tmp_path), cwd=tmp_path)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.glob("*.exr")) + list(tmp_path.glob("*.frames"))


def test_a_scene_without_animation_needs_another_series(tmp_path: Path) -> None:
    done = glrt("film", "cornell", "-o", tmp_path / "a.webp")
    assert done.returncode == 2
    assert "cornell has no [animation], so it has one frame: give --turntable" in done.stderr


def test_inspect_names_what_moves(scene: Path) -> None:
    done = glrt("inspect", scene)
    assert "animation  4 frames at 3 a second: objects.ball.center" in done.stdout


def test_an_mp4_without_its_library_says_what_to_install(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "av.py").write_text("raise ModuleNotFoundError(name='av')")
    done = glrt("film", scene, "-o", tmp_path / "a.mp4", PYTHONPATH=str(tmp_path))
    assert done.returncode == 2
    assert "-m pip install" in done.stderr


def test_the_frame_of_a_still_is_refused(tmp_path: Path) -> None:
    done = glrt("render", "cornell", "--frame", "1", "-o", tmp_path / "a.exr")
    assert done.returncode == 2
    assert "there is no frame 1: the scene has frame 0 alone" in done.stderr


def test_jobs_render_each_frame_once(scene: Path, tmp_path: Path) -> None:
    words = ("film", scene, "-o", tmp_path / "out dir" / "%d.exr", "--width", "8", "--height", "8")
    more = ("--samples", "2", "--frames=0-2", "--chunk", "2")
    done = glrt(*words, *more, "--export", "openjd")
    assert done.returncode == 0, done.stderr
    table = json.loads(done.stdout)
    step = table["steps"][0]
    given = step["parameterSpace"]["taskParameterDefinitions"][0]
    assert (table["specificationVersion"], given["range"]) == (
        "jobtemplate-2023-09",
        ["0-1", "2-2"],
    )
    run = step["script"]["actions"]["onRun"]
    assert run["args"] == [*map(str, words), *more[:2], "--frames", "{{Task.Param.Frames}}"]
    commands = glrt(*words, *more, "--export", "cuecmd").stdout
    script = glrt(*words, *more, "--export", "sh").stdout
    assert script == "#!/bin/sh\nset -e\n" + commands
    assert not (tmp_path / "out dir").exists()
    for line in commands.splitlines():
        name, *task = shlex.split(line)
        assert name == "glrt"
        assert glrt(*task).returncode == 0
    assert sorted(path.name for path in (tmp_path / "out dir").iterdir()) == [
        "0.exr",
        "1.exr",
        "2.exr",
    ]


def test_a_job_template_is_valid(scene: Path, tmp_path: Path) -> None:
    """Against the model of the specification."""
    done = glrt("film", scene, "-o", tmp_path / "%d.exr", "--export", "openjd")
    decode_job_template(template=json.loads(done.stdout))
