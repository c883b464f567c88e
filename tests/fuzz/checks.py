"""Checks of every scene file, however wrong: it is read whole, or refused with one paragraph."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.export.companions import Companions
from glrt.scene.export.mitsuba.file import to_mitsuba
from glrt.scene.export.pbrt.file import to_pbrt
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, read_scene, scene_to_dict
from glrt.settings import settings_for
from tests.fuzz.foreign import is_foreign
from tests.fuzz.grammar import Table
from tests.support.pbrt_text import read_pbrt

SOURCE = "chance.toml"


def parsed(table: Table) -> Scene | None:
    """The scene in the table; None if it was refused as it should be."""
    try:
        scene = parse_scene(table, SOURCE)
    except SceneError as error:
        check_refusal(str(error), SOURCE)
        return None
    assert parse_scene(scene_to_dict(scene), SOURCE) == scene, "a scene survives being written"
    return scene


def read(content: bytes, folder: Path) -> Scene | None:
    """The scene in a file with this content; None if it was refused as it should be."""
    path = folder / SOURCE
    path.write_bytes(content)
    try:
        return read_scene(path)
    except SceneError as error:
        check_refusal(str(error), str(path))
        return None


def check_refusal(message: str, source: str) -> None:
    """One short paragraph that names the file, without words of a library."""
    assert source in message
    assert message.isprintable(), "one paragraph, fit for a terminal"
    assert len(message) < 4000, "a paragraph, not a dump"
    assert not is_foreign(message), "in the words of glrt"


def check_render(scene: Scene, context: Context) -> None:
    """One sample of a small picture: each pixel a number, not below 0; no sample dropped."""
    renderer = Renderer(scene, context=context, samples=1, width=8, height=8, crop=None)
    try:
        radiance = renderer.render().image().radiance
        assert np.isfinite(radiance).all()
        assert (radiance >= 0).all()
        assert renderer.nonfinite() == 0
    finally:
        renderer.release()


def check_exports(scene: Scene, folder: Path) -> None:
    """The files of Mitsuba and pbrt are well-formed, and each number in them is finite."""
    settings, beside = settings_for(scene.render), Companions(folder / "scene.xml")
    text, _ = to_mitsuba(scene, settings, beside)
    for element in ElementTree.fromstring(text).iter():
        numbers = element.tag in ("float", "rgb", "point", "matrix")
        words = str(element.get("value")).replace(",", " ").split() if numbers else []
        assert np.isfinite([float(it) for it in words]).all()
    read_pbrt(to_pbrt(scene, settings, beside)[0])
