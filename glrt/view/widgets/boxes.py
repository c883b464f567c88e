"""Boxes over the window: opaque, with an edge, never docked, and kept in no saved layout."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from imgui_bundle import imgui

_EDGE = 1.0  # pixels
_ALWAYS = (
    imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
)


class Box(NamedTuple):
    """A box that is being drawn."""

    is_shown: bool  # whether any of its content can be seen
    is_open: bool  # False once its cross was clicked


@contextmanager
def box(name: str, flags: int = 0, has_title: bool = False) -> Iterator[Box]:
    """Draw a box: what the block draws lies in it. A title has a cross, which closes the box.

    `flags` are those of Dear ImGui for a window, in addition to those of every box.
    """
    if not has_title:
        flags |= imgui.WindowFlags_.no_title_bar.value
    imgui.set_next_window_bg_alpha(1.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, _EDGE)
    is_shown, is_open = imgui.begin(name, True if has_title else None, int(flags | _ALWAYS))
    try:
        yield Box(is_shown, is_open is not False)
    finally:
        imgui.end()
        imgui.pop_style_var()
