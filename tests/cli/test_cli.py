"""`glrt` as a user runs it: files, figures, exit codes, interruption."""

import json
import os
import pty
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import glrt as package
from glrt.cli.reports.render_report import unreached
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.image.image import Image, read_recipe
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import with_lights
from tests.support.processes import glrt, start_render
from tests.support.system_packages import needs

SMALL = ("--width", "24", "--height", "16", "--samples", "4")
KEYS = [
    *("scene", "width", "height", "samples", "bounces", "method", "caustics", "seed"),
    *("pipeline", "context", "renderer", "seconds", "samples_per_second"),
    *("error", "error_doubtful", "denoised_error", "denoised_error_high", "nonfinite"),
    *("peak_bytes", "triangles", "assets"),
]


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> "tuple[Path, dict[str, object]]":
    """A folder with one render of cornell in three formats, and its line of JSON."""
    folder = tmp_path_factory.mktemp("first")
    outputs = [word for suffix in ("exr", "png", "npy") for word in ("-o", folder / f"a.{suffix}")]
    asked = (*SMALL, "--sampler", "independent")  # four samples that know their error
    done = glrt("render", "cornell", *outputs, *asked, "--seed", "7", "--json")
    assert done.returncode == 0, done.stderr
    return folder, json.loads(done.stdout)


def test_three_files_hold_the_same_picture(first: "tuple[Path, dict[str, object]]") -> None:
    folder, _ = first
    image = Image.load(folder / "a.exr")
    assert image.radiance.shape == (16, 24, 3)
    assert np.array_equal(np.load(folder / "a.npy"), image.radiance)
    recipes = [read_recipe(folder / name) for name in ("a.exr", "a.png")]
    assert recipes[0] == recipes[1]
    assert (recipes[0].samples, recipes[0].settings.seed) == (4, 7)


def test_json_is_one_line_with_the_promised_figures(
    first: "tuple[Path, dict[str, object]]",
) -> None:
    figures = first[1]
    assert list(figures) == KEYS
    assert (figures["width"], figures["height"], figures["samples"]) == (24, 16, 4)
    assert figures["nonfinite"] == 0
    assert figures["pipeline"] == "compute"
    assert isinstance(figures["error"], float)
    assert figures["error"] == pytest.approx(Image.load(first[0] / "a.exr").error)
    seconds = figures["seconds"]
    assert isinstance(seconds, dict)
    assert list(seconds) == ["setup", "load", "build", "pack", "compile", "render"]
    assert figures["samples_per_second"] == pytest.approx(24 * 16 * 4 / seconds["render"], rel=0.01)
    assert 20e6 < float(str(figures["peak_bytes"])) < 4e9


@pytest.mark.parametrize("source", ["a.exr", "a.png"])
def test_render_from_a_recipe_gives_the_same_bits(
    first: "tuple[Path, dict[str, object]]", source: str, tmp_path: Path
) -> None:
    folder, _ = first
    done = glrt("render", folder / source, "-o", tmp_path / "again.exr", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    first_image, again = Image.load(folder / "a.exr"), Image.load(tmp_path / "again.exr")
    assert again.radiance.tobytes() == first_image.radiance.tobytes()
    assert again.stderr.tobytes() == first_image.stderr.tobytes()


def test_render_from_a_relit_picture_gives_the_same_bits(context: Context, tmp_path: Path) -> None:
    scene = with_lights(load("lamps"), {"rose": 0.0})
    renderer = Renderer(scene, context=context, layering="groups", width=24, height=16)
    renderer.render(32).update(with_lights(scene, {"rose": 0.7, "blue": 0.3}))
    relit = renderer.image()
    renderer.release()
    relit.save(tmp_path / "relit.exr")
    done = glrt("render", tmp_path / "relit.exr", "-o", tmp_path / "again.exr")
    assert done.returncode == 0, done.stderr
    again = Image.load(tmp_path / "again.exr")
    assert np.array_equal(again.radiance, relit.radiance)
    assert again.error is not None
    assert np.array_equal(again.stderr, relit.stderr)


def test_explicit_options_override_the_recipe(
    first: "tuple[Path, dict[str, object]]", tmp_path: Path
) -> None:
    picture = tmp_path / "other.png"
    options = ("--seed", "8", "--bounces", "2", "--light", "background=0", "--no-roulette")
    assert glrt("render", first[0] / "a.png", "-o", picture, *options).returncode == 0
    recipe = read_recipe(picture)
    assert (recipe.settings.seed, recipe.settings.bounces, recipe.samples) == (8, 2, 4)
    assert not recipe.settings.roulette
    assert recipe.scene.lights["background"] == 0


def test_crop_is_that_part_of_the_frame(
    first: "tuple[Path, dict[str, object]]", tmp_path: Path
) -> None:
    picture = tmp_path / "part.exr"
    done = glrt("render", first[0] / "a.exr", "-o", picture, "--crop", "5", "3", "9", "7")
    assert done.returncode == 0, done.stderr
    whole = Image.load(first[0] / "a.exr").radiance
    assert np.array_equal(Image.load(picture).radiance, whole[3:10, 5:14])


def test_command_says_where_the_picture_is(tmp_path: Path) -> None:
    picture = tmp_path / "a.png"
    done = glrt("render", "cornell", "-o", picture, *SMALL)
    assert done.stdout == ""
    assert done.stderr.startswith(f"Wrote {picture}: 24 x 16, 4 samples")
    assert done.stderr.count("\n") == 1, "no progress bar where there is no terminal"


def test_progress_is_shown_on_a_terminal(tmp_path: Path) -> None:
    try:
        terminal, end = pty.openpty()
    except OSError as error:
        needs(False, f"a terminal, which a chroot without /dev/pts cannot have ({error})")
    options = f"--width 64 --height 64 --samples 200 -o {tmp_path}/a.png".split()
    command = [sys.executable, "-m", "glrt", "render", "cornell", *options]
    with subprocess.Popen(command, stderr=end, stdin=end) as process:
        os.close(end)
        seen = b""
        while chunk := _read(terminal):
            seen += chunk
    os.close(terminal)
    assert process.returncode == 0
    assert b"of 200 samples" in seen
    assert b"to go" in seen


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other end is closed: that is how Linux says so
        return b""


def test_error_reached_ends_the_render(tmp_path: Path) -> None:
    picture = tmp_path / "a.exr"
    done = glrt("render", "sky", "-o", picture, *SMALL[:4], "--error", "0.2", "--json")
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["error"] <= 0.2
    assert figures["samples"] in {64 << k for k in range(10)}, "judged at 64 * 2^k samples"


def test_error_not_reached_exits_1_with_the_picture(tmp_path: Path) -> None:
    picture = tmp_path / "a.exr"
    done = glrt("render", "cornell", "-o", picture, *SMALL, "--error", "0.0001")
    assert done.returncode == 1
    assert "--error 0.0001 was not reached" in done.stderr
    assert Image.load(picture).samples == 4


@pytest.mark.parametrize(
    ("room", "estimate", "samples", "least", "said"),
    [
        (0.3, 0.4, 64, 32, "it is 0.4 after 64 samples."),
        (0.3, None, 1, 2, "after 1 sample the error is not known, which takes at least 2 samples."),
        (
            *(0.25, None, 27, 32),
            "after 27 samples the error is not known, which takes at least 32 samples (2 with "
            "--sampler independent). The",
        ),
        (
            0.25,
            0.28,
            64,
            2,
            "after subtracting the bias of the method, its noise must be at most 0.25; it is 0.28",
        ),
    ],
)
def test_an_error_not_reached_is_reported_as_it_was_asked_for(
    room: float, estimate: float | None, samples: int, least: int, said: str
) -> None:
    told = unreached(0.3, room, estimate, samples, least)
    assert told.startswith(f"--error 0.3 was not reached: {said}")


def test_time_ends_the_render(tmp_path: Path) -> None:
    picture = tmp_path / "a.exr"
    done = glrt("render", "cornell", "-o", picture, *SMALL[:4], "--time", "1")
    assert done.returncode == 0, done.stderr
    assert 0 < Image.load(picture).samples < 1 << 20, "far from the samples that it lifts to"


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interruption_saves_what_was_rendered(
    number: signal.Signals, code: int, tmp_path: Path
) -> None:
    picture = tmp_path / "a.exr"
    size = ("--width", "16", "--height", "16", "--samples", "1048576")
    process = start_render("cornell", "-o", picture, *size)
    process.send_signal(number)
    _, stderr = process.communicate(timeout=250)
    assert process.returncode == code, stderr
    assert "Traceback" not in stderr
    image = Image.load(picture)
    assert 0 < image.samples < 1048576
    assert f"interrupted after {image.samples} samples" in stderr
    assert list(tmp_path.iterdir()) == [picture]
    again = tmp_path / "again.exr"
    assert glrt("render", picture, "-o", again).returncode == 0, "as many samples as were taken"
    assert Image.load(again).radiance.tobytes() == image.radiance.tobytes()


def test_no_opengl_exits_3_with_advice(tmp_path: Path) -> None:
    options = ("--context", "window")
    done = glrt("render", "cornell", "-o", tmp_path / "a.png", *SMALL, *options, DISPLAY="")
    assert done.returncode == 3
    assert "DISPLAY" in done.stderr
    assert "libegl1" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_full_disk_exits_4_and_leaves_nothing(tmp_path: Path) -> None:
    command = f'ulimit -f 4; exec "{sys.executable}" -m glrt render cornell -o "{tmp_path}/a.exr"'
    size = " --width 200 --height 200 --samples 1"
    done = subprocess.run(["bash", "-c", command + size], capture_output=True, text=True)
    assert done.returncode == 4
    assert "a.exr" in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_scene_beyond_the_loop_limit_is_refused(tmp_path: Path, context: Context) -> None:
    """Where the driver has such a limit; else it is rendered."""
    tiles = "\n".join(
        f'[[objects]]\nshape = "plane"\npoint = [0, 0, -{9 + i}]\nnormal = [0, 0, 1]\n'
        'material = "m"'
        for i in range(400)
    )
    scene = tmp_path / "many.toml"
    scene.write_text(
        "[camera]\nposition = [0, 0, 0]\nlook_at = [0, 0, -1]\n[background]\ncolor = [1, 1, 1]\n"
        f'[materials.m]\ntype = "lambertian"\ncolor = [0.5, 0.5, 0.5]\n{tiles}\n'
    )
    picture = tmp_path / "a.png"
    done = glrt("render", scene, "-o", picture, *SMALL, "--bounces", "900", "--context", "egl")
    if usable_rounds(context) is None:
        assert done.returncode == 0, done.stderr
        return
    assert done.returncode == 2
    assert "loop limit" in done.stderr
    assert not picture.exists()


def test_inspect_names_features_in_and_out() -> None:
    done = glrt("inspect", "sky", "--all")
    assert done.returncode == 0
    rows = [re.split("  +", line) for line in done.stdout.splitlines()]
    lines = {row[1]: row[0] for row in rows if len(row) == 3}
    assert lines["planes"] == "in"
    assert lines["background"] == "in"
    assert lines["light sampling"] == "out"


def test_schema_is_json_schema_of_scenes() -> None:
    done = glrt("schema")
    assert done.returncode == 0
    assert set(json.loads(done.stdout)["properties"]) >= {"camera", "objects", "materials"}


def test_version_is_the_packages() -> None:
    assert glrt("--version").stdout == f"glrt {package.__version__}\n"


def test_closed_pipe_is_no_error() -> None:
    """The pause lets the reader go first; a user's Python keeps so short a text until it exits."""
    child = (
        "import sys, time, glrt.cli.main as c; time.sleep(0.3); "
        "sys.exit(c.main(['inspect', 'sky']))"
    )
    command = f'"{sys.executable}" -c "{child}" | true; exit ${{PIPESTATUS[0]}}'
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONUNBUFFERED"}
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment)
    assert (done.returncode, done.stderr) == (0, "")
