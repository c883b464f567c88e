"""All controls of the panel with their values, and all commands with their keys."""

from functools import partial
from typing import Any

from imgui_bundle import imgui

from glrt.scene.scenefile.catalog import scene_names
from glrt.view.app import App
from glrt.view.edits.new_objects import ADDED
from glrt.view.palette.matching import Entry
from glrt.view.panels.shortcuts import COMMANDS
from glrt.view.state import keys
from glrt.view.tabs.sections import SECTIONS
from glrt.view.viewport.sides import SIDES
from glrt.view.widgets.finder import FINDER, Row

_KINDS = ("preference", "background", "sky")  # of rows, whose labels are clear without them


def all_entries(app: App) -> list[Entry]:
    """Return commands first, then the menus, then the rows of the panel."""
    return [*_commands(app), *_menus(app), *_rows(app)]


def value_text(value: Any) -> str:
    """Return the value of a control as it is shown: "on", "0.02", "1, 0.5, 0"."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, tuple):
        return ", ".join(map(value_text, value))
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _commands(app: App) -> list[Entry]:
    bound = app.preferences.bindings
    return [
        Entry(
            keys.MEANING[action],
            "command",
            " or ".join(map(keys.label, bound[action])),
            act=partial(act, app),
        )
        for action, act in COMMANDS.items()
        if action != "palette"
    ]


def _menus(app: App) -> list[Entry]:
    added = [Entry(f"add {kind}", "Object", act=partial(app.add, kind)) for kind in ADDED]
    opened = [
        Entry(f"open scene {name}", "Files", act=partial(app.files.ask_open, name))
        for name in scene_names()
    ]
    return [*added, *opened, *_cameras(app)]


def _cameras(app: App) -> list[Entry]:
    """Return the sides of the scene, the views that were kept, and the cameras of files."""
    sides = [
        Entry(f"see the {side} of the scene", "Camera", act=partial(app.see_from, side))
        for side in SIDES
    ]
    kept = [
        Entry(
            f"go back to view {n}",
            "Camera",
            keys.label(f"alt+{n}"),
            act=partial(app.recall_view, n),
        )
        for n in sorted(app.views)
    ]
    files = [
        Entry(f"see by camera {name}", "Camera", act=partial(app.see_by, camera))
        for name, camera in app.cameras_of_files.items()
    ]
    return [*sides, *kept, *files]


def _rows(app: App) -> list[Entry]:
    """Return the rows of all parts, folded or not, with one entry for each label of a part."""
    found = {(row.section, row.label): row for row in _listed(app)}
    return [_entry(app, row) for row in found.values()]


def _listed(app: App) -> list[Row]:
    """Let each part list its rows; what it draws otherwise is skipped."""
    window = imgui.internal.get_current_window()
    news = app.is_to_be_seen, app.paths.is_new  # which the panel has not shown yet
    app.is_to_be_seen = app.paths.is_new = False
    window.skip_items = True
    FINDER.begin_list()
    try:
        for section in SECTIONS:
            FINDER.enter(section.title)
            section.draw(app)
    finally:
        rows = FINDER.end_list()
        window.skip_items = False
        app.is_to_be_seen, app.paths.is_new = news
    return rows


def _entry(app: App, row: Row) -> Entry:
    label, _, kind = row.label.partition("##")
    name = f"{label} of {kind}" if kind and kind not in _KINDS else label
    control = row.control
    shown = "button" if row.value is None and not control else value_text(row.value)
    return Entry(name, row.section, shown, control.help if control else "", partial(_go, app, row))


def _go(app: App, row: Row) -> None:
    app.is_picture_alone = False
    FINDER.show(row)
