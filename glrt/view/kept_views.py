"""Views of scenes that the user keeps, in a file next to the preferences."""

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from glrt.core.errors import RenderError
from glrt.core.files import write_text
from glrt.scene.camera import Camera
from glrt.view.state.keys import MOST_VIEWS

MOST_SCENES = 100  # whose views are kept, those of the last keeps
Views = dict[int, Camera]  # by their numbers from 1

_KEYS = {"position", "look_at", "up", "fov", "focus_distance", "defocus_angle", "shutter"}


class KeptViews:
    """The views by scene: a file by its absolute path, a scene that comes with glrt by its name."""

    def __init__(self, file: Path) -> None:
        """Read the file; what is wrong in it is left out."""
        self._file = file
        self._views = _read(file)

    def of(self, source: str) -> Views:
        """Return the views of a scene."""
        return dict(self._views.get(_name(source), {}))

    def keep(self, source: str, number: int, camera: Camera) -> str:
        """Keep a view under a number, in place of another one; returns a problem, "" for none.

        Views of a scene without a source last until the window ends.
        """
        name = _name(source)
        own = {**self._views.pop(name, {}), number: camera}
        self._views = dict([*self._views.items()][-MOST_SCENES + 1 :]) | {name: own}
        return self._write()

    def _write(self) -> str:
        table = {
            name: {str(number): _plain(camera) for number, camera in sorted(views.items())}
            for name, views in self._views.items()
            if name
        }
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            write_text(self._file, json.dumps(table, indent=2) + "\n")
        except (OSError, RenderError) as error:
            return f"The view lasts until the window ends, as it cannot be written: {error}"
        return ""


def _name(source: str) -> str:
    return str(Path(source).absolute()) if source and Path(source).is_file() else source


def _plain(camera: Camera) -> dict[str, Any]:
    return camera.model_dump(mode="json", include=_KEYS, exclude_none=True)


def _read(file: Path) -> dict[str, Views]:
    try:
        given = json.loads(file.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    tables = given.items() if isinstance(given, dict) else ()
    found = {name: _views(table) for name, table in tables if isinstance(table, dict)}
    return {name: views for name, views in found.items() if views}


def _views(table: dict[str, Any]) -> Views:
    views = Views()
    for number, values in table.items():
        try:
            camera = Camera.model_validate(values)
        except ValidationError:
            continue
        if number.isdecimal() and 1 <= int(number) <= MOST_VIEWS:
            views[int(number)] = camera
    return views
