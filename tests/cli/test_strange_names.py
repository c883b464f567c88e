"""Files whose names are no UTF-8, no printable text, or no text of the locale."""

import json
import os
import sys
from pathlib import Path

import pytest

from glrt.cli.main import main
from glrt.image.image import read_recipe
from glrt.image.sources import load
from glrt.scene.files.path_text import name_of, text_of
from glrt.scene.loading.scene_files import files_of
from glrt.scene.scene import Scene
from glrt.view.edits.new_objects import with_model
from glrt.view.state.recent import load_recent, save_recent, with_opened
from tests.support.gltf_files import COLORS, png, textured_square
from tests.support.processes import glrt

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")

SMALL = ["--width", "4", "--height", "4", "--samples", "2", "--caustics", "off", "--quiet"]
# A name as the system has it, and the text that scenes and recipes hold.
NAMES = {
    b"caf\xe9": r"caf\xe9",
    b"new\nline\x7f": r"new\x0aline\x7f",
    rb"a\b \xe9": r"a\x5cb \x5cxe9",
    "caf\xe9".encode(): "caf\xe9",
    b"\xff" * 250: r"\xff" * 250,
}
STRANGE = [name for name in NAMES if name != "caf\xe9".encode()]
ASCII = {"LC_ALL": "POSIX", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with a model under every name."""
    for name in NAMES:
        (tmp_path / os.fsdecode(name + b".glb")).write_bytes(textured_square().glb())
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", NAMES)
def test_a_name_and_its_text_lead_to_each_other(name: bytes) -> None:
    assert text_of(os.fsdecode(name)) == NAMES[name]
    assert os.fsencode(name_of(NAMES[name])) == name


@pytest.mark.parametrize("text", [r"\x00", r"\x2f", r"\x2e\x2e", r"\xZZ", r"\xE9", "plain \xe9"])
def test_no_text_makes_a_folder_or_an_end_of_a_name(text: str) -> None:
    assert name_of(text) == text


@pytest.mark.parametrize("name", STRANGE)
def test_a_model_is_rendered_again_from_its_picture_and_imported(name: bytes, folder: Path) -> None:
    model = os.fsdecode(name + b".glb")
    assert main(["render", model, "-o", "a.exr", "-o", "a.npy", *SMALL]) == 0
    assert list(read_recipe("a.exr").assets) == [NAMES[name] + ".glb"]
    assert main(["render", "a.exr", "-o", "b.npy", "--quiet"]) == 0
    assert Path("a.npy").read_bytes() == Path("b.npy").read_bytes()
    assert main(["import", model, "-o", "scene.toml"]) == 0
    assert load("scene.toml").objects == load(model).objects
    (folder / "elsewhere").mkdir()
    load("scene.toml").save(folder / "elsewhere" / "scene.toml")
    assert (folder / "elsewhere" / model).read_bytes() == Path(model).read_bytes()


@pytest.mark.parametrize("name", STRANGE)
def test_a_model_is_added_in_the_window(name: bytes, folder: Path) -> None:
    model = folder / os.fsdecode(name + b".glb")
    scene = with_model(load("cornell"), model, (0.0, 0.0, 0.0), 1.0)
    assert scene.objects[-1].name == NAMES[name]
    assert files_of(scene) == [NAMES[name] + ".glb"]
    assert Scene.model_validate(dict(scene)).objects == scene.objects


@pytest.mark.parametrize("name", STRANGE)
def test_the_window_remembers_what_was_opened(name: bytes, folder: Path) -> None:
    model, kept = os.fsdecode(name + b".glb"), folder / "recent.json"
    assert save_recent(with_opened((), model), kept) == ""
    (path,) = load_recent(kept)
    assert Path(path).is_file()


def test_a_model_finds_files_of_strange_names_next_to_it(folder: Path) -> None:
    builder = textured_square()
    builder.json["buffers"] = [{"uri": "b%E9%0A.bin", "byteLength": len(builder.binary)}]
    model = builder.gltf("b%E9%0A.bin")
    (folder / "thing.gltf").write_bytes(model)
    (folder / os.fsdecode(b"b\xe9\n.bin")).write_bytes(builder.binary)
    scene = load("thing.gltf")
    assert rb"b\xe9\x0a.bin".decode() in scene.meshes[0].file.companions


def test_an_image_in_a_folder_of_a_strange_name_is_found(folder: Path) -> None:
    (folder / "\x01").mkdir()
    (folder / "thing.obj").write_text(
        "mtllib \x01/thing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wood\n"
        "f 1/1 2/2 3/3\n"
    )
    (folder / "\x01" / "thing.mtl").write_text("newmtl wood\nKd 1 1 1\nmap_Kd wood.png\n")
    (folder / "\x01" / "wood.png").write_bytes(png(COLORS))
    assert r"\x01/wood.png" in files_of(load("thing.obj"))


BAD = os.fsdecode(b"no\n\xe9")
SHOWN = r"no\n\udce9"
REFUSED: dict[str, list[str]] = {
    "render": ["render", f"{BAD}.glb", "-o", "a.png"],
    "render a name": ["render", BAD, "-o", "a.png"],
    "render a scene": ["render", f"{BAD}.toml", "-o", "a.png"],
    "an output": ["render", "cornell", "-o", f"{BAD}/a.png"],
    "an output in EXR": ["render", "cornell", "-o", f"{BAD}.exr"],
    "resume": ["render", "--resume", f"{BAD}.exr", "-o", "a.exr"],
    "aov": ["render", "cornell", "--aov", BAD, "-o", "a.exr"],
    "light": ["render", "cornell", "--light", f"{BAD}=1", "-o", "a.exr"],
    "an option": ["render", "cornell", "-o", "a.exr", f"--{BAD}"],
    "files": ["render", "files.toml", "--assets-from", BAD, "-o", "a.exr"],
    "view": ["view", f"{BAD}.toml"],
    "import": ["import", f"{BAD}.glb", "-o", "a.toml"],
    "import to": ["import", "none.glb", "-o", f"{BAD}.toml"],
    "inspect": ["inspect", f"{BAD}.gltf"],
    "compare": ["compare", f"{BAD}.exr", "a.exr"],
    "compare arrays": ["compare", f"{BAD}.npy", "a.exr"],
    "merge": ["merge", f"{BAD}.exr", "-o", "a.exr"],
    "chart": ["chart", BAD, "-o", "charts"],
    "stress": ["stress", BAD, "-o", "charts"],
    "paths": ["paths", f"{BAD}.obj", "--pixel", "0", "0"],
    "replay": ["paths", "--replay", f"{BAD}.json"],
    "a command": [BAD],
}
ABOUT_ANOTHER = {"import to"}  # whose message names the model


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_is_named_on_one_printable_line(
    case: str, folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "files.toml").write_text(
        "[camera]\nposition = [0, 1, 3]\nlook_at = [0, 0, 0]\n\n[background]\nimage = 'a.hdr'\n"
    )
    assert main(REFUSED[case]) == 2
    said = capfd.readouterr().err
    assert said.endswith("\n")
    assert said[:-1].isprintable()
    assert SHOWN in said or case in ABOUT_ANOTHER


@pytest.mark.slow
def test_no_locale_is_in_the_way(folder: Path) -> None:
    """Bytes of the name are those of UTF-8, and the locale knows ASCII alone."""
    model, picture = "caf\xe9.glb", "\xe9.exr"
    done = glrt("render", model, "-o", picture, *SMALL, "--json", cwd=folder, **ASCII)
    assert (done.returncode, done.stderr) == (0, "")
    assert list(json.loads(done.stdout)["assets"]) == [model]
    assert read_recipe(picture).scene.title == model
    Path(model).unlink()
    gone = glrt("render", picture, "-o", "b.png", cwd=folder, **ASCII)
    assert gone.returncode == 2
    assert r"there is no file 'caf\xe9.glb'" in gone.stderr


def test_standard_output_takes_every_name(folder: Path) -> None:
    done = glrt("import", "caf\xe9.glb", "-o", "\xe9.toml", cwd=folder, PYTHONIOENCODING="ascii")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(r"Wrote \xe9.toml: ")
