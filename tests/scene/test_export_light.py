"""An exported scene keeps its own light; a model without any stands in a studio, which is said."""

from pathlib import Path

import pytest

from glrt.cli.main import main
from glrt.image.sources import load
from glrt.scene.coincidence import coincidence_of
from glrt.scene.export.gltf import to_gltf
from glrt.scene.scene import Scene
from glrt.scene.studio import studio_note
from tests.support.builders import scene_of, sphere
from tests.support.exported import CAMERA

MATTE = {"type": "lambertian", "color": [0.5, 0.5, 0.5]}


def again(scene: Scene, folder: Path) -> Scene:
    """The scene after it was written and read."""
    (folder / "again.glb").write_bytes(to_gltf(scene, True)[0])
    return load(folder / "again.glb")


def under_sky() -> Scene:
    return scene_of(
        [sphere([0, 0, 0], 1, "m")], {"m": MATTE}, CAMERA, background={"color": [1] * 3}
    )


def test_an_exported_scene_keeps_its_own_light(tmp_path: Path) -> None:
    """Dim lamps among large planes, for which a model of others gets a studio."""
    found = again(load("cornell"), tmp_path)
    assert not studio_note(found)
    assert not coincidence_of(found).pairs
    sky = under_sky()
    assert "it has no light of its own" in studio_note(again(sky, tmp_path))
    assert "all light with it, so that glrt renders the file in a studio" in to_gltf(sky, True)[1]


def test_a_studio_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("glrt.cli.render._render", lambda *_: 0)
    sky = under_sky()
    content, _ = to_gltf(sky, True)
    (tmp_path / "a.glb").write_bytes(content)
    words = ["render", str(tmp_path / "a.glb"), "-o", str(tmp_path / "a.npy"), "--caustics", "off"]
    assert main(words) == 0
    assert "A studio was added to the model" in capsys.readouterr().err
    assert main([*words, "--quiet"]) == 0
    assert not capsys.readouterr().err
