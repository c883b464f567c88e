"""A user's mistake gives exit code 2, one paragraph that names it, and leaves nothing behind."""

from pathlib import Path

import numpy as np
import pytest

from glrt.cli.main import main
from glrt.image.image import Image as Picture
from tests.support.bad_lamps import BAD_LAMPS
from tests.support.bad_scenes import BAD_SCENES, GOOD_SCENE, BadScene
from tests.support.processes import glrt


def one_paragraph(stderr: str) -> str:
    """The message of a failed command, after the checks that hold for all of them."""
    assert stderr.startswith("glrt: ")
    assert stderr.endswith("\n")
    assert stderr.count("\n") == 1, "one paragraph"
    for jargon in ("Traceback", "pydantic", "Input should", "errors.pydantic"):
        assert jargon not in stderr
    return stderr


@pytest.mark.parametrize("bad", [*BAD_SCENES, *BAD_LAMPS][::10], ids=lambda bad: bad.name)
def test_bad_scene_is_refused(
    bad: BadScene, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One in ten: what is said of each, tests/scene/test_toml.py asks of the reader of scenes."""
    scene, output = tmp_path / "bad.toml", tmp_path / "out.png"
    scene.write_bytes(bad.content.encode() if isinstance(bad.content, str) else bad.content)
    assert main(["render", str(scene), "-o", str(output)]) == 2
    message = one_paragraph(capsys.readouterr().err)
    assert "bad.toml" in message
    for word in bad.says:
        assert word in message
    assert sorted(tmp_path.iterdir()) == [scene]


# Arguments after `glrt`, {scene} a good scene and {tmp} a folder; words of the message.
COMMAND_LINES: dict[str, tuple[str, list[str]]] = {
    "nothing": ("", ["COMMAND", "--help"]),
    "unknown command": ("rendr {scene} -o {tmp}/a.png", ["rendr", "render"]),
    "no scene": ("render -o {tmp}/a.png", ["SCENE"]),
    "no output": ("render {scene}", ["-o"]),
    "unknown option": ("render {scene} -o {tmp}/a.png --sampels 3", ["--sampels", "--samples"]),
    "abbreviation": ("render {scene} -o {tmp}/a.png --sample 3", ["--sample", "--samples"]),
    "too many arguments": ("render {scene} more -o {tmp}/a.png", ["'more'"]),
    "missing scene": ("render nowhere/none.toml -o {tmp}/a.png", ["none.toml", "no such file"]),
    "misspelt name": ("render weekand -o {tmp}/a.png", ["weekand", "'weekend'"]),
    "scene is a folder": ("render {tmp} -o {tmp}/a.png", ["{tmp}"]),
    "unknown suffix": ("render {scene} -o {tmp}/a.jpg", ["a.jpg", ".exr, .png or .npy"]),
    "no suffix": ("render {scene} -o {tmp}/a", [".exr, .png or .npy"]),
    "one of two outputs bad": ("render {scene} -o {tmp}/a.png -o {tmp}/b.gif", ["b.gif"]),
    "output in no folder": ("render {scene} -o {tmp}/no/a.png", ["a.png", "no"]),
    "output is a folder": ("render {scene} -o {tmp}/folder.png", ["folder.png", "folder"]),
    "zero samples": ("render {scene} -o {tmp}/a.png --samples 0", ["samples", "1"]),
    "too many samples": ("render {scene} -o {tmp}/a.png --samples 2000000", ["samples", "1048576"]),
    "half a sample": ("render {scene} -o {tmp}/a.png --samples 0.5", ["--samples", "0.5"]),
    "endless samples": ("render {scene} -o {tmp}/a.png --samples " + "9" * 5000, ["--samples"]),
    "width 0": ("render {scene} -o {tmp}/a.png --width 0", ["width", "1"]),
    "width beyond the limit": ("render {scene} -o {tmp}/a.png --width 16385", ["width", "16384"]),
    "height of text": ("render {scene} -o {tmp}/a.png --height tall", ["--height", "tall"]),
    "negative bounces": ("render {scene} -o {tmp}/a.png --bounces -1", ["bounces", "0"]),
    "bounces beyond": ("render {scene} -o {tmp}/a.png --bounces 1001", ["bounces", "1000"]),
    "unknown method": ("render {scene} -o {tmp}/a.png --method bdpt", ["--method", "naive"]),
    "negative seed": ("render {scene} -o {tmp}/a.png --seed -1", ["seed", "0"]),
    "seed beyond 32 bits": ("render {scene} -o {tmp}/a.png --seed 4294967296", ["seed"]),
    "crop outside": ("render {scene} -o {tmp}/a.png --crop 500 0 20 20", ["crop", "512"]),
    "empty crop": ("render {scene} -o {tmp}/a.png --crop 0 0 0 5", ["crop"]),
    "negative crop": ("render {scene} -o {tmp}/a.png --crop -1 0 5 5", ["crop"]),
    "crop of three": ("render {scene} -o {tmp}/a.png --crop 0 0 5", ["--crop", "4"]),
    "unknown light": ("render {scene} -o {tmp}/a.png --light celing=2", ["celing", "ceiling"]),
    "light without value": ("render {scene} -o {tmp}/a.png --light ceiling", ["GROUP=X"]),
    "light without group": ("render {scene} -o {tmp}/a.png --light =1", ["GROUP=X"]),
    "negative light": ("render {scene} -o {tmp}/a.png --light ceiling=-1", ["ceiling", "-1"]),
    "infinite light": ("render {scene} -o {tmp}/a.png --light ceiling=inf", ["ceiling"]),
    "light that is no number": ("render {scene} -o {tmp}/a.png --light ceiling=nan", ["ceiling"]),
    "no time": ("render {scene} -o {tmp}/a.png --time 0", ["--time", "above 0"]),
    "time that is no number": ("render {scene} -o {tmp}/a.png --time nan", ["--time"]),
    "negative error": ("render {scene} -o {tmp}/a.png --error -0.1", ["--error", "above 0"]),
    "infinite exposure": ("render {scene} -o {tmp}/a.png --exposure inf", ["exposure"]),
    "unknown tone curve": ("render {scene} -o {tmp}/a.png --tonemap filmic", ["--tonemap", "agx"]),
    "unknown context": ("render {scene} -o {tmp}/a.png --context vulkan", ["--context", "osmesa"]),
    "unknown sampler": ("render {scene} -o {tmp}/a.png --sampler halton", ["--sampler", "sobol"]),
    "resume of nothing": ("render {scene} -o {tmp}/a.png --resume {tmp}/no.exr", ["no.exr"]),
    "resume of another's": ("render -o {tmp}/a.png --resume {tmp}/a.exr", ["a.exr", "recipe"]),
    "unknown pipeline": ("render {scene} -o {tmp}/a.png --pipeline mesh", ["'mesh'", "fragment"]),
    "picture without recipe": (
        "render {tmp}/foreign.png -o {tmp}/a.png",
        ["foreign.png", "recipe"],
    ),
    "compare one picture": ("compare {tmp}/a.exr", ["REFERENCE"]),
    "compare nowhere": ("compare {tmp}/a.exr {tmp}/none.exr --samples 4", ["none.exr"]),
    "compare a PNG": ("compare {tmp}/foreign.png {tmp}/a.exr", ["foreign.png", "EXR"]),
    "compare a damaged array": ("compare {tmp}/damaged.npy {tmp}/a.exr", ["damaged.npy"]),
    "compare a flat array": ("compare {tmp}/flat.npy {tmp}/a.exr", ["flat.npy", "height"]),
    "compare without samples": ("compare {tmp}/a.exr {tmp}/a.exr", ["a.exr", "--samples N"]),
    "compare without samples of one": (
        "compare {tmp}/a.exr {tmp}/b.exr --samples 4",
        ["b.exr", "--reference-samples N"],
    ),
    "compare no samples": ("compare {tmp}/a.exr {tmp}/a.exr --samples 0", ["--samples N"]),
    "compare other sizes": (
        "compare {tmp}/a.exr {tmp}/b.exr --samples 4 --reference-samples 4",
        ["4 x 3", "3 x 4"],
    ),
    "compare without any noise": (
        "compare {tmp}/plain.npy {tmp}/plain.npy --samples 4 --reference-samples 4",
        ["standard errors", ".exr"],
    ),
    "compare with alpha 0": (
        "compare {tmp}/a.exr {tmp}/a.exr --samples 4 --reference-samples 4 --alpha 0",
        ["alpha", "between"],
    ),
    "compare with bias nan": (
        "compare {tmp}/a.exr {tmp}/a.exr --samples 4 --reference-samples 4 --bias nan",
        ["bias", "between"],
    ),
    "compare to a JPEG": (
        "compare {tmp}/a.exr {tmp}/a.exr --samples 4 --reference-samples 4 --picture {tmp}/d.jpg",
        ["d.jpg", "--picture", ".png"],
    ),
    "compare to nowhere": (
        "compare {tmp}/a.exr {tmp}/a.exr --samples 4 --reference-samples 4 "
        "--picture {tmp}/no/d.png",
        ["d.png", "no folder"],
    ),
    "compare misspelt": ("compare {tmp}/a.exr {tmp}/b.exr --strickt", ["--strickt", "--strict"]),
    "inspect nothing": ("inspect", ["SCENE"]),
    "inspect a bad scene": ("inspect {tmp}/broken.toml", ["broken.toml", "camera"]),
    "doctor with argument": ("doctor please", ["please"]),
}


@pytest.fixture
def workplace(tmp_path: Path) -> Path:
    """A folder with a good scene, a broken one, a folder like a picture, foreign pictures."""
    from PIL import Image

    (tmp_path / "good.toml").write_text(GOOD_SCENE)
    (tmp_path / "broken.toml").write_text("title = 'no camera'\n")
    (tmp_path / "folder.png").mkdir()
    Image.new("RGB", (2, 2)).save(tmp_path / "foreign.png")
    pixels = np.ones((3, 4, 3), np.float32)
    Picture(pixels, 0.1 * pixels, 0).save(tmp_path / "a.exr")
    turned = np.ones((4, 3, 3), np.float32)
    Picture(turned, 0.1 * turned, 0).save(tmp_path / "b.exr")
    np.save(tmp_path / "plain.npy", pixels)
    np.save(tmp_path / "flat.npy", pixels[0])
    (tmp_path / "damaged.npy").write_bytes((tmp_path / "plain.npy").read_bytes()[:-1])
    return tmp_path


@pytest.mark.parametrize("name", COMMAND_LINES)
def test_bad_command_line_is_refused(
    name: str, workplace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line, words = COMMAND_LINES[name]
    places = {"scene": workplace / "good.toml", "tmp": workplace}
    before = sorted(workplace.iterdir())
    assert main([word.format(**places) for word in line.split()]) == 2
    captured = capsys.readouterr()
    message = one_paragraph(captured.err)
    assert not captured.out
    for word in words:
        assert word.format(**places) in message
    assert sorted(workplace.iterdir()) == before


@pytest.mark.parametrize("name", ["misspelt name", "unknown option", "output in no folder"])
def test_bad_command_line_ends_a_real_process_alike(name: str, workplace: Path) -> None:
    line, words = COMMAND_LINES[name]
    places = {"scene": workplace / "good.toml", "tmp": workplace}
    done = glrt(*[word.format(**places) for word in line.split()])
    assert done.returncode == 2
    message = one_paragraph(done.stderr)
    assert all(word.format(**places) in message for word in words)


def test_binary_file_as_scene_ends_a_real_process_with_one_paragraph(tmp_path: Path) -> None:
    scene = tmp_path / "noise.toml"
    scene.write_bytes(bytes(range(256)) * 4)
    done = glrt("render", scene, "-o", tmp_path / "a.png")
    assert done.returncode == 2
    assert "noise.toml" in one_paragraph(done.stderr)
    assert sorted(tmp_path.iterdir()) == [scene]


def test_closed_folder_is_refused_before_rendering(tmp_path: Path) -> None:
    """As root nothing is closed, so a file in the place of the folder stands for it."""
    (tmp_path / "good.toml").write_text(GOOD_SCENE)
    (tmp_path / "shut").write_text("a file")
    done = glrt("render", tmp_path / "good.toml", "-o", tmp_path / "shut" / "a.png")
    assert done.returncode == 2
    assert "shut" in one_paragraph(done.stderr)
