"""Rows of the panel: labels at the left, widgets in a column of their own, costs at the right."""

from collections.abc import Callable
from typing import TypeVar

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.widgets.cost_badges import tags_start

Drawn = TypeVar("Drawn")

LEAST = 4.0  # em, the height of a letter: least width of a widget with its label next to it
WORDS = 7.0  # em: the same for one that shows a word or a name
THREE = 10.0  # em: the same for three numbers
_LABELS = 0.4  # share of the panel's width that labels take
_EDGE = 4.0  # pixels around a widget: the frame of one that has the focus of the keys


class Row:
    """A row with a label, which is drawn at once, and a widget, which `draw` draws."""

    def __init__(self, label: str, least: float = LEAST) -> None:
        """Draw the label; the widget goes below it if it had less than `least` em next to it.

        A square, with `least` 0, goes behind a long label.
        """
        style, left = imgui.get_style(), imgui.get_cursor_pos_x()
        end, edge = tags_start() - style.item_inner_spacing.x, style.window_padding.x
        start = edge + _LABELS * (end - edge)
        label_end = left + imgui.calc_text_size(label).x + style.item_inner_spacing.x
        self._is_square = least == 0
        if self._is_square and label_end + imgui.get_frame_height() < end:
            start = max(start, label_end)
        self._is_below = label_end > start or end - start < hello_imgui.em_size(least)
        self._start = left if self._is_below else start
        self._width = max(end - self._start, 1.0)
        imgui.align_text_to_frame_padding()
        imgui.text(label)

    def draw(self, widget: Callable[[], Drawn]) -> Drawn:
        """Draw the widget, as wide as its column; its own label, which is its id, is cut off."""
        if not self._is_below:
            imgui.same_line(self._start)
        edge = min(_EDGE, imgui.get_style().item_inner_spacing.x - 1)
        low = imgui.get_cursor_screen_pos()
        height = imgui.get_frame_height()
        high = low + ImVec2(height if self._is_square else self._width, height)
        imgui.push_clip_rect(low - ImVec2(edge, edge), high + ImVec2(edge, edge), True)
        imgui.set_next_item_width(self._width)
        drawn = widget()
        imgui.pop_clip_rect()
        return drawn
