"""Scenes exported for Mitsuba and pbrt, and read again."""

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from glrt.scene.export.companions import Companions
from glrt.scene.export.mitsuba.file import to_mitsuba
from glrt.scene.export.pbrt.file import to_pbrt
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.pbrt_text import Line, read_pbrt

CAMERA = {"position": [1, 2, 6], "look_at": [0, 0.5, 0], "fov": 35.0}
WHITE = {"background": {"color": [1, 1, 1]}}


def companions_of(folder: Path) -> Companions:
    return Companions(folder / "scene.xml")


def as_xml(scene: Scene, folder: Path, **settings: Any) -> ElementTree.Element:
    """The root of the file, whose references lead somewhere and whose files are there."""
    beside = companions_of(folder)
    text, _ = to_mitsuba(scene, settings_for(scene.render, **settings), beside)
    beside.save()
    root = ElementTree.fromstring(text)
    marks = [it.get("id") for it in root.iter() if it.get("id") and it.tag != "ref"]
    assert len(marks) == len(set(marks))
    assert {it.get("id") for it in root.iter("ref")} <= set(marks)
    for it in root.iter("string"):
        assert it.get("name") != "filename" or (folder / str(it.get("value"))).is_file()
    return root


def as_pbrt(scene: Scene, folder: Path, **settings: Any) -> list[Line]:
    beside = companions_of(folder)
    text, _ = to_pbrt(scene, settings_for(scene.render, **settings), beside)
    beside.save()
    lines = read_pbrt(text)
    paths = [line.parameters.get("string filename") for line in lines if line.name != "Film"]
    assert all((folder / path).is_file() for path in paths if path)
    return lines


def value(element: ElementTree.Element, name: str) -> list[float]:
    """The numbers of a part of an element."""
    (part,) = (it for it in element if it.get("name") == name)
    return [float(it) for it in str(part.get("value")).replace(",", " ").split()]


def found(lines: list[Line], name: str, *texts: str) -> Line:
    (line,) = (it for it in lines if it.name == name and it.texts[: len(texts)] == texts)
    return line


def left_out(scene: Scene, folder: Path, write: Any = to_mitsuba) -> str:
    return ", ".join(write(scene, settings_for(scene.render), companions_of(folder))[1])


def read_pfm(path: Path) -> Any:
    kind, size, scale, rest = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    assert scale == b"-1.0"
    return np.frombuffer(rest, "<f4").reshape(height, width, 3 if kind == b"PF" else 1)[::-1]
