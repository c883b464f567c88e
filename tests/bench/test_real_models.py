"""Pictures of models that packages carry, with stand-ins for the packages."""

import base64
import io
import os
import tarfile
from pathlib import Path

import pytest

from bench import real_models
from glrt.core.errors import UsageError
from glrt.image.sources import load
from glrt.scene.shapes.mesh import Mesh
from tests.support.gltf_files import Builder
from tests.support.meshes import box

POINTS, FACES = box([-1, -1, -1], [1, 1, 1])


def packed(folder: Path, missing: str = "") -> None:
    """A program `npm` that packs cubes, as the packages do."""
    builder = Builder()
    order = builder.accessor(FACES.ravel(), "u1")
    builder.shown({"attributes": {"POSITION": builder.accessor(POINTS)}, "indices": order})
    cube = builder.glb()
    for owner in (real_models.POLYGONS, real_models.CONTROLLERS):
        with tarfile.open(folder / f"{owner.replace('/', '-')}.tgz", "w:gz") as archive:
            for name, (package, path) in real_models.MODELS.items():
                if package == owner and name != missing:
                    text = b"export default 'data:x;base64," + base64.b64encode(cube) + b"'"
                    content = text if path.endswith(".js") else cube
                    info = tarfile.TarInfo(f"package/{path}")
                    info.size = len(content)
                    archive.addfile(info, io.BytesIO(content))
    program = folder / "npm"
    script = f'#!/bin/sh\nname=$(echo "$3" | tr / -).tgz\ncp "{folder}/$name" .\necho "$name"\n'
    program.write_text(script)
    program.chmod(0o755)


@pytest.fixture
def npm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    packed(folder)
    return folder


def test_every_model_is_fetched_and_every_scene_can_be_loaded(npm: Path, tmp_path: Path) -> None:
    real_models.fetch(tmp_path)
    assert {file.name for file in tmp_path.glob("*.glb")} == set(real_models.MODELS)
    assert not list(tmp_path.glob("*.tgz"))
    named = set()
    for name in real_models.SCENES:
        scene = load(real_models.write(tmp_path, name))
        named |= {thing.file.file for thing in scene.objects if isinstance(thing, Mesh)}
    assert named == set(real_models.MODELS)


@pytest.mark.slow
def test_the_program_writes_a_page_of_pictures(npm: Path, tmp_path: Path) -> None:
    folder = tmp_path / "pictures"
    told = ["-o", str(folder), "--samples", "1", "--only", "glass_bunny"]
    assert real_models.main(told) == 0
    assert "glass_bunny.png" in (folder / "index.html").read_text()
    assert (folder / "glass_bunny.png").stat().st_size > 1000


def test_what_cannot_be_fetched_is_reported(
    npm: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packed(npm, missing="hp.glb")
    with pytest.raises(UsageError, match="has no file package/dist/profiles/hp-mixed"):
        real_models.fetch(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match="npm could not download @pmndrs"):
        real_models.fetch(tmp_path)
