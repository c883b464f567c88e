"""Rows of the panel by name: a list of all, and one that is brought into view and marked."""

import time
from dataclasses import dataclass
from typing import Any

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.controls import Control
from glrt.view.widgets.steady_widget import ANCHOR

SHOWN = 2.0  # seconds for which a row is marked
_FRAMES = 3  # for which the panel scrolls to it: a part that unfolds has its length afterwards
_HEIGHT = 0.3  # of the panel, where the row comes to lie
_COLOR = (1.0, 0.65, 0.1, 1.0)


@dataclass(frozen=True)
class Row:
    """A control, or a button, whose `control` is None, with its label and its present value.

    The label "" is the title of the part itself.
    """

    section: str
    label: str
    control: Control | None = None
    value: Any = None


class Finder:
    """Lists rows instead of drawing them on request; marks the row that is wanted."""

    def __init__(self) -> None:
        """Begin without a list, and with no row to show."""
        self._section = ""
        self._rows: list[Row] | None = None
        self._wanted: Row | None = None
        self._frames = 0
        self._since = 0.0

    def begin_list(self) -> None:
        """List the rows that are drawn from now on."""
        self._rows = []

    def end_list(self) -> list[Row]:
        """Return the list, and let rows be drawn again."""
        rows, self._rows, self._section = self._rows or [], None, ""
        return rows

    def enter(self, section: str) -> None:
        """Begin a part of the panel."""
        self._section = section

    def lists(self, label: str, control: Control | None = None, value: Any = None) -> bool:
        """Whether rows are listed, not drawn; if so, list this one."""
        if self._rows is None:
            return False
        self._rows.append(Row(self._section, label, control, value))
        return True

    def show(self, row: Row) -> None:
        """Bring a row into view and mark it, as soon as it is drawn."""
        self._wanted, self._frames, self._since = row, _FRAMES, time.perf_counter()
        ANCHOR.forget()

    def wants(self, section: str) -> bool:
        """Whether a part of the panel must be unfolded for its row, which may be gone by now."""
        row = self._wanted
        return self._frames > 0 and self.is_marking and row is not None and row.section == section

    @property
    def is_marking(self) -> bool:
        """Whether a row is marked at present."""
        return self._wanted is not None and time.perf_counter() - self._since < SHOWN

    def mark(self, label: str, corner: ImVec2 | None = None) -> None:
        """Scroll to the item drawn last and mark it, if it is the one that is wanted.

        `corner` is that of the first item of its row, in pixels of the screen.
        """
        row = self._wanted
        if row is None or (row.section, row.label) != (self._section, label):
            return
        if self._frames:
            self._frames -= 1
            imgui.set_scroll_here_y(_HEIGHT)
        if not self.is_marking:
            self._wanted = None
            return
        apart = ImVec2(hello_imgui.em_size(0.2), hello_imgui.em_size(0.1))
        low, high = (corner or imgui.get_item_rect_min()) - apart, imgui.get_item_rect_max() + apart
        end = imgui.get_window_pos().x + imgui.get_window_width() - imgui.get_style().scrollbar_size
        high.x = min(high.x, end - apart.x)  # a widget below its label is wider than the panel
        color = imgui.get_color_u32(_COLOR)
        imgui.get_window_draw_list().add_rect(low, high, color, 3.0, 2.0)


FINDER = Finder()  # of the panel: a window has only one
