"""Models on the command line: rendered, imported, rendered again from a picture."""

import json
from pathlib import Path

import pytest

from glrt.cli.main import main
from tests.support.gltf_files import Builder, square, textured_square

SMALL = ["--width", "16", "--height", "16", "--samples", "4", "--quiet"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A model in the working folder."""
    (tmp_path / "thing.glb").write_bytes(textured_square().glb())
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_an_imported_scene_has_the_picture_of_its_model(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", "thing.glb", "-o", "a.npy", *SMALL]) == 0
    assert main(["import", "thing.glb", "-o", "scene.toml"]) == 0
    assert capsys.readouterr().out == "Wrote scene.toml: 3 objects, 3 materials.\n"
    assert main(["render", "scene.toml", "-o", "b.npy", *SMALL]) == 0
    assert (folder / "a.npy").read_bytes() == (folder / "b.npy").read_bytes()
    text = (folder / "scene.toml").read_text()
    assert 'image = "thing.glb#0"' in text
    assert "rotation" not in text, "defaults are left out"


def test_a_picture_of_a_model_is_rendered_again(folder: Path) -> None:
    assert main(["render", "thing.glb", "-o", "a.exr", "-o", "a.npy", *SMALL]) == 0
    assert main(["render", "a.exr", "-o", "b.npy", "--quiet"]) == 0
    assert (folder / "a.npy").read_bytes() == (folder / "b.npy").read_bytes()
    assert main(["render", "--resume", "a.exr", "-o", "c.npy", "--variant", "x"]) == 2
    (folder / "thing.glb").write_bytes(textured_square(emissiveFactor=[1, 1, 1]).glb())
    assert main(["render", "a.exr", "-o", "c.npy", "--quiet"]) == 2
    assert not (folder / "c.npy").exists()


def test_assets_name_the_model(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    del folder
    words = [word for word in SMALL if word != "--quiet"]
    assert main(["render", "thing.glb", "-o", "a.png", *words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert list(told["assets"]) == ["thing.glb"]
    assert told["triangles"] == 2


def test_a_model_is_inspected(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    del folder
    assert main(["inspect", "thing.glb"]) == 0
    assert "1 image" in capsys.readouterr().out


def test_a_variant_is_imported(folder: Path) -> None:
    builder = textured_square()
    key = "KHR_materials_variants"
    red = builder.add("materials", {"name": "red"})
    builder.json["extensions"] = {key: {"variants": [{"name": "evening"}]}}
    mappings = {"mappings": [{"material": red, "variants": [0]}]}
    builder.json["meshes"][0]["primitives"][0]["extensions"] = {key: mappings}
    (folder / "thing.glb").write_bytes(builder.glb())
    assert main(["import", "thing.glb", "--variant", "evening", "-o", "scene.toml"]) == 0
    assert 'variant = "evening"' in (folder / "scene.toml").read_text()


REFUSED = {
    "no such variant": (["render", "thing.glb", "--variant", "a", "-o", "a.png"], "no variants"),
    "a variant of a scene": (["inspect", "cornell", "--variant", "a"], "cornell is no model"),
    "no model": (["import", "scene.toml", "-o", "a.toml"], "scene.toml is no model"),
    "no such model": (["import", "none.glb", "-o", "a.toml"], "there is no file 'none.glb'"),
    "no scene file": (["import", "thing.glb", "-o", "a.png"], "must end in .toml"),
    "over itself": (["render", "thing.glb", "-o", "thing.glb"], "thing.glb"),
    "damaged": (["render", "half.glb", "-o", "a.png"], "half.glb: 'half.glb' is damaged"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_done_is_refused(
    folder: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "half.glb").write_bytes(textured_square().glb()[:99])
    before = sorted(path.name for path in folder.iterdir())
    words, message = REFUSED[name]
    assert main(words) == 2
    told = capsys.readouterr().err
    assert message in told
    assert "Traceback" not in told
    assert sorted(path.name for path in folder.iterdir()) == before


@pytest.mark.slow
def test_a_bomb_is_not_opened(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A PNG whose header says 60,000 x 60,000 pixels."""
    builder = textured_square()
    place = builder.json["bufferViews"][0]["byteOffset"]
    size = (60_000).to_bytes(4, "big") * 2
    builder.binary = builder.binary[: place + 16] + size + builder.binary[place + 24 :]
    (folder / "thing.glb").write_bytes(builder.glb())
    words = [word for word in SMALL if word != "--quiet"]
    assert main(["render", "thing.glb", "-o", "a.npy", *words]) == 0
    assert "left out: color 'thing.glb#0', which cannot be read" in capsys.readouterr().err


@pytest.mark.slow
def test_many_nodes_of_one_mesh_are_counted_before_they_are_made(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """20,000 places of a mesh of 1,000 triangles."""
    builder = Builder()
    primitive = {**square(builder), "indices": builder.accessor([0, 1, 2] * 1000, "u1")}
    mesh = builder.shown(primitive)
    builder.json["nodes"] += [{"mesh": builder.json["nodes"][mesh]["mesh"]}] * 20_000
    (folder / "thing.glb").write_bytes(builder.glb())
    assert main(["render", "thing.glb", "-o", "a.png"]) == 2
    assert "more than 4,000,000 triangles" in capsys.readouterr().err
