"""Keep the last used widget in place on the screen when rows appear or disappear above it."""

from imgui_bundle import ImVec2, imgui


class Anchor:
    """The last used widget of the panel, and its place: in pixels from the top of all rows."""

    def __init__(self) -> None:
        """Begin without a used widget."""
        self._widget = 0
        self._before: float | None = None
        self._now: float | None = None
        self._height = 0.0  # of the window
        self._lead = 0.0  # empty pixels above the rows, which could not be scrolled
        self._start = 0.0  # of the rows, below the bar, which does not scroll
        self._has_rows = False  # whether rows are drawn now: other parts have widgets, too

    def begin(self, start: float) -> None:
        """Begin the rows, `start` pixels below the upper edge of the panel."""
        self._start, self._has_rows = start, True
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + self._lead)

    def note(self, widget: int = 0) -> None:
        """Observe the item drawn last; hold it in place once it is used.

        A group of items has only the id of its item in use; `widget` replaces that id.
        """
        if not self._has_rows:
            return
        widget = widget or imgui.get_item_id()
        if imgui.is_item_activated() and widget != self._widget:
            self._widget, self._before = widget, None
        if widget and widget == self._widget:
            self._now = _place()

    def go_here(self) -> None:
        """Scroll so that the next item becomes the first visible row, and hold no widget."""
        imgui.set_scroll_y(max(imgui.get_cursor_pos_y() - self._start - self._lead, 0.0))
        self.forget()

    def forget(self) -> None:
        """Hold no widget in place."""
        self._widget, self._before, self._now, self._lead = 0, None, None, 0.0

    def keep(self) -> None:
        """Scroll by as much as the held widget moved; call it at the end of the panel.

        If rows disappeared, the panel keeps its length until it is scrolled up: a shorter one could
        not be scrolled as far. If there are too few rows above to scroll down, empty room is left
        there until it is out of sight, or the mouse has left the panel.
        """
        scroll, height = imgui.get_scroll_y(), imgui.get_window_height()
        wanted = scroll + self._moved(scroll)
        is_over = wanted >= self._lead or _is_mouse_away()
        room = -wanted if wanted < 0 else -self._lead if is_over else 0.0
        if wanted != scroll or room:
            scroll = max(wanted + room, 0.0)
            imgui.set_scroll_y(scroll)
        if self._now is not None:
            self._before = self._now + room
        self._lead += room
        self._now, self._has_rows = None, False
        end = scroll + height - imgui.get_style().window_padding.y
        missing = end - imgui.get_cursor_pos_y()
        if scroll > 0 and missing > 0 and height == self._height:
            imgui.dummy(ImVec2(0.0, missing))
        self._height = height

    def _moved(self, scroll: float) -> float:
        """Return how far down rows moved the widget, so limited that the bar does not cover it."""
        if self._now is None or self._before is None:
            return 0.0
        below = self._now - self._start - scroll  # distance to the bar, as the widget is drawn now
        moved = self._now - self._before
        return min(moved, below) if below >= 0 else moved


def _place() -> float:
    top: float = imgui.get_item_rect_min().y - imgui.get_window_pos().y + imgui.get_scroll_y()
    return top


def _is_mouse_away() -> bool:
    """Whether the mouse is neither over the panel nor over a list that it has opened."""
    flags = imgui.HoveredFlags_.root_and_child_windows
    flags |= imgui.HoveredFlags_.allow_when_blocked_by_popup
    flags |= imgui.HoveredFlags_.allow_when_blocked_by_active_item
    return not imgui.is_window_hovered(int(flags)) and not imgui.is_any_item_active()


ANCHOR = Anchor()  # of the panel: a window has only one
