"""`glrt render --resume`: goes on from a picture, from one that was interrupted, or killed."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from glrt.cli.commands import parse
from glrt.cli.request import order
from glrt.image.image import Image
from tests.support.images import picture, same_bits
from tests.support.processes import glrt, start_render

SMALL = ("--width", "24", "--height", "16")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Holds 20 samples of cornell, and all 48."""
    place = tmp_path_factory.mktemp("resume")
    for name, samples in (("a", "20"), ("whole", "48")):
        done = glrt("render", "cornell", "-o", place / f"{name}.exr", *SMALL, "--samples", samples)
        assert done.returncode == 0, done.stderr
    return place


@pytest.mark.slow
def test_the_picture_itself_may_be_the_output(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "a.exr"
    own.write_bytes((folder / "a.exr").read_bytes())
    done = glrt("render", "--resume", own, "--samples", "48", "-o", own, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["samples"] == 48
    assert own.read_bytes() == (folder / "whole.exr").read_bytes()


@pytest.mark.parametrize("scene", ["cornell", "{folder}/a.exr", "{folder}/whole.exr"])
def test_the_scene_may_be_named(folder: Path, tmp_path: Path, scene: str) -> None:
    """A picture of it may be named, too; all settings come from the picture to go on from."""
    options = ("--resume", folder / "a.exr", "--samples", "48", "-o", tmp_path / "b.exr")
    done = glrt("render", scene.format(folder=folder), *options)
    assert done.returncode == 0, done.stderr
    assert "48 samples (28 of them new)" in done.stderr
    assert (tmp_path / "b.exr").read_bytes() == (folder / "whole.exr").read_bytes()


def test_a_picture_with_all_its_samples_is_written_as_it_is(folder: Path, tmp_path: Path) -> None:
    done = glrt("render", "--resume", folder / "a.exr", "-o", tmp_path / "b.exr")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "b.exr").read_bytes() == (folder / "a.exr").read_bytes()


@pytest.mark.slow
def test_error_is_judged_where_one_render_would_judge_it(folder: Path, tmp_path: Path) -> None:
    for options in (("cornell", *SMALL), ("--resume", str(folder / "a.exr"))):
        name = tmp_path / f"{len(options)}.exr"
        done = glrt("render", *options, "--error", "0.3", "-o", name)
        assert done.returncode == 0, done.stderr
    whole, on = (Image.load(tmp_path / f"{n}.exr") for n in (5, 2))
    assert on.samples == whole.samples
    assert same_bits(on.radiance, whole.radiance)


@pytest.mark.slow
def test_time_adds_a_sample_at_least(folder: Path, tmp_path: Path) -> None:
    """Then nobody knows how far to go on, so the command asks for it."""
    options = ("--resume", folder / "a.exr", "-o", tmp_path / "b.exr")
    assert glrt("render", *options, "--time", "0.01").returncode == 0
    assert 20 < Image.load(tmp_path / "b.exr").samples < 1 << 20
    done = glrt("render", "--resume", tmp_path / "b.exr", "-o", tmp_path / "b.exr")
    assert done.returncode == 2
    assert "without a limit of samples" in done.stderr


@pytest.mark.slow
def test_an_interrupted_render_goes_on_to_what_was_asked(tmp_path: Path) -> None:
    name = tmp_path / "a.exr"
    process = start_render("cornell", "-o", name, *SMALL, "--samples", "1000000")
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate(timeout=250)
    assert process.returncode == 130, stderr
    assert 0 < Image.load(name).samples < 1_000_000
    words = ["render", "--resume", str(name), "-o", str(name)]
    assert order(parse(words)).limits.samples == 1_000_000


REFUSED = {
    "other seed": ("--resume {a} --samples 48 --seed 1", "seed is 0 in the picture and 1 now"),
    "fewer samples": ("--resume {a} --samples 3", "it has 20 samples"),
    "other scene": ("sky --resume {a} --samples 48", "more differ"),
    "other light": ("--resume {a} --samples 48 --light lamp=2", "lights.lamp"),
    "other pipeline": ("--resume {a} --samples 48 --pipeline fragment", "pipeline is compute"),
    "chosen method": ("--resume {a} --method auto --error 0.1", "--method auto"),
    "no scene": ("--samples 3", "SCENE is missing"),
    "not there": ("--resume {a}.exr", "No such file"),
    "not an EXR": ("--resume {png}", "not an EXR"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_does_not_fit_exits_2_in_one_paragraph(
    name: str, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from glrt.cli.main import main

    line, said = REFUSED[name]
    picture().save(tmp_path / "a.png")
    words = line.format(a=folder / "a.exr", png=tmp_path / "a.png").split()
    assert main(["render", *words, "-o", str(tmp_path / "b.exr")]) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.err.count("\n") == 1
    assert not (tmp_path / "b.exr").exists()


# --- saves now and then ----------------------------------------------------------------------

# `glrt` that saves at every opportunity, not every minute.
EAGER = (
    "import sys; from glrt.cli import autosave; from glrt.cli.main import main; "
    "autosave.INTERVAL = 0; sys.exit(main({words}))"
)


@pytest.mark.slow
def test_a_render_that_is_killed_leaves_its_last_save_and_goes_on(tmp_path: Path) -> None:
    exr, png, npy = (tmp_path / f"a.{suffix}" for suffix in ("exr", "png", "npy"))
    # Without these, both choices depend on the samples asked for.
    scene = ["cornell", *SMALL, "--caustics", "off", "--sampler", "sobol"]
    words = ["render", *scene, "--samples", "100000", "--quiet"]
    for name in (exr, png, npy):
        words += ["-o", str(name)]
    process = subprocess.Popen([sys.executable, "-c", EAGER.format(words=words)])
    try:
        while not all(name.exists() for name in (exr, png, npy)):
            assert process.poll() is None
            time.sleep(0.01)
    finally:
        process.kill()
        process.wait()
    saved = Image.load(exr)
    assert saved.samples > 0
    assert np.load(npy).shape == saved.radiance.shape
    samples = str(saved.samples + 3)
    done = glrt("render", "--resume", exr, "--samples", samples, "-o", tmp_path / "on.exr")
    assert done.returncode == 0, done.stderr
    whole = glrt("render", *scene, "--samples", samples, "-o", tmp_path / "whole.exr")
    assert whole.returncode == 0
    on = (tmp_path / "on.exr").read_bytes()
    assert on == (tmp_path / "whole.exr").read_bytes()
