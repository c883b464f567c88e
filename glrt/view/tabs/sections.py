"""The tabs of the panel, and the parts of each."""

from collections.abc import Callable
from typing import NamedTuple

from glrt.view.app import App
from glrt.view.outliner.listing import SECTION, draw_outliner
from glrt.view.panels.background import draw_background
from glrt.view.panels.compare import draw_compare
from glrt.view.panels.files import draw_files
from glrt.view.panels.inspector import draw_inspector
from glrt.view.panels.key_table import draw_key_table
from glrt.view.panels.lights import draw_lights
from glrt.view.panels.objects import draw_object
from glrt.view.panels.pixel_paths import draw_pixel_paths
from glrt.view.panels.sun import draw_sun
from glrt.view.state.preferences import Tab
from glrt.view.tabs.camera import draw_camera
from glrt.view.tabs.options import draw_options
from glrt.view.tabs.paths import draw_paths
from glrt.view.tabs.render import draw_display, draw_frame, draw_samples
from glrt.view.widgets.finder import FINDER


class Section(NamedTuple):
    """A part of a tab: its title, and what draws its rows."""

    title: str
    draw: Callable[[App], None]


OBJECT, PIXEL_PATHS = Section("Object", draw_object), Section("Paths of a pixel", draw_pixel_paths)
TABS: dict[Tab, tuple[Section, ...]] = {
    "Scene": (
        Section(SECTION, draw_outliner),
        OBJECT,
        Section("Camera", draw_camera),
        Section("Files", draw_files),
    ),
    "Light": (
        Section("Lamps", draw_lights),
        Section("Background", draw_background),
        Section("Sun", draw_sun),
    ),
    "Render": (
        Section("Paths", draw_paths),
        Section("Samples", draw_samples),
        Section("Display", draw_display),
        Section("Frame", draw_frame),
    ),
    "Compare": (Section("A and B", draw_compare),),
    "Inspect": (Section("Pixels", draw_inspector), PIXEL_PATHS),
    "Window": (Section("Preferences", draw_options), Section("Mouse and keys", draw_key_table)),
}
SECTIONS = tuple(section for sections in TABS.values() for section in sections)


def is_wanted(app: App, section: Section) -> bool:
    """Whether a part must come into view: for a row that is looked for, or for what was chosen."""
    is_news = section is OBJECT and app.is_to_be_seen
    is_news |= section is PIXEL_PATHS and app.paths.is_new
    return is_news or FINDER.wants(section.title)


def tab_of(section: Section) -> Tab:
    """Return the tab that a part belongs to."""
    return next(tab for tab, sections in TABS.items() if section in sections)
