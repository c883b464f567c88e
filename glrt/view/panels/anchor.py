"""The widget that was used last stays where it is on the screen, whatever rows come and go."""

from imgui_bundle import ImVec2, imgui


class Anchor:
    """A widget of the panel, by its id, and where it was: in pixels from the top of all rows."""

    def __init__(self) -> None:
        """Nothing was used yet."""
        self._widget = 0
        self._before: float | None = None
        self._now: float | None = None
        self._height = 0.0  # of the window

    def note(self) -> None:
        """Look at the item drawn last; it is held once it is used."""
        widget = imgui.get_item_id()
        if imgui.is_item_activated() and widget != self._widget:
            self._widget, self._before = widget, None
        if widget and widget == self._widget:
            self._now = _place()

    def forget(self) -> None:
        """Hold nothing: the panel is to go elsewhere."""
        self._widget, self._before, self._now = 0, None, None

    def keep(self) -> None:
        """At the end of the panel: scroll by as much as the widget moved.

        Where rows have gone the panel keeps its length until it is scrolled up, since a shorter one
        could not be scrolled as far.
        """
        scroll, height = imgui.get_scroll_y(), imgui.get_window_height()
        if self._now is not None and self._before is not None and self._now != self._before:
            scroll += self._now - self._before
            imgui.set_scroll_y(max(scroll, 0.0))
        if self._now is not None:
            self._before = self._now
        self._now = None
        end = scroll + height - imgui.get_style().window_padding.y
        missing = end - imgui.get_cursor_pos_y()
        if scroll > 0 and missing > 0 and height == self._height:
            imgui.dummy(ImVec2(0.0, missing))
        self._height = height


def _place() -> float:
    top: float = imgui.get_item_rect_min().y - imgui.get_window_pos().y + imgui.get_scroll_y()
    return top


ANCHOR = Anchor()  # of the panel: there is one in a window
