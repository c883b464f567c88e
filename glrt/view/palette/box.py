"""Box over the picture in which words find a control or a command."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.app import App
from glrt.view.palette.entries import all_entries
from glrt.view.palette.matching import Entry, matches
from glrt.view.panels.navigation import PICTURE
from glrt.view.widgets.boxes import box

NAME = "Find###palette"
_WIDTH, _ROWS = 34.0, 12.0  # em, and rows that are seen at once
_LEAST = 24.0  # em: a narrower picture is no place for the box
_SHARE = 0.92  # of the window: the largest size
_TOP = 0.08  # of the window: above the box
_STEPS = {imgui.Key.down_arrow: 1, imgui.Key.up_arrow: -1}


class Palette:
    """The words that were typed, and the entries that they find."""

    def __init__(self) -> None:
        """Begin closed."""
        self._entries: list[Entry] = []
        self.found: list[Entry] = []
        self._words, self.row = "", 0

    def draw(self, app: App) -> None:
        """Draw the box, if it is open: Enter or a click acts, Escape or a click outside closes."""
        if not app.shows_palette:
            return
        area = imgui.get_main_viewport()
        top, width = _place()
        imgui.set_next_window_pos(top, imgui.Cond_.always.value, ImVec2(0.5, 0.0))
        imgui.set_next_window_size(ImVec2(width, 0.0))
        with box(NAME, int(imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_nav)):
            chosen = self._content(app, area.size.y)
            is_left = imgui.is_mouse_clicked(0) and not imgui.is_window_hovered(_HOVERED)
        if chosen or is_left or imgui.is_key_pressed(imgui.Key.escape):
            app.shows_palette = False
            imgui.set_window_focus(PICTURE)
        if chosen:
            chosen.act()

    def _content(self, app: App, height: float) -> Entry | None:
        """Draw the box for words and the entries found; return the entry that is chosen."""
        if imgui.is_window_appearing():
            self._words, self.row, self._entries = "", 0, all_entries(app)
            self.found = matches("", self._entries)
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(-1.0)
        hint = "words of a control or a command; Escape closes"
        changed, self._words = imgui.input_text_with_hint("##words", hint, self._words)
        if changed:
            self.row, self.found = 0, matches(self._words, self._entries)
        step = sum(step for key, step in _STEPS.items() if imgui.is_key_pressed(key))
        self.row = max(0, min(self.row + step, len(self.found) - 1))
        clicked = self._list(height, has_moved=changed or step != 0)
        enters = (imgui.Key.enter, imgui.Key.keypad_enter)
        is_entered = any(imgui.is_key_pressed(key, repeat=False) for key in enters)
        return self.found[self.row] if is_entered and self.found else clicked

    def _list(self, height: float, has_moved: bool) -> Entry | None:
        """Draw the entries, each with its place and its keys or value; return one clicked."""
        if not self.found:
            imgui.text_disabled("nothing has all these words")
            return None
        line = imgui.get_text_line_height_with_spacing()
        room = min(_ROWS * line, (_SHARE - _TOP) * height - 3 * line)
        imgui.begin_child("entries", ImVec2(0.0, min(room, (len(self.found) + 0.5) * line)))
        clicked, apart = None, hello_imgui.em_size(0.5)  # from the scrollbar
        for number, entry in enumerate(self.found):
            end = imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - apart
            if imgui.selectable(f"##{number}", number == self.row)[0]:
                clicked = entry
            if number == self.row and has_moved:
                imgui.set_scroll_here_y(0.5)
            _row(entry, end)
        imgui.end_child()
        return clicked


def _place() -> tuple[ImVec2, float]:
    """Return the middle of the upper edge, in pixels of the screen, and the width of the box.

    It lies over the picture, or in the middle of the window if the picture is too narrow.
    """
    area = imgui.get_main_viewport()
    picture = imgui.internal.find_window_by_name(PICTURE)
    is_wide = picture and _SHARE * picture.size.x >= hello_imgui.em_size(_LEAST)
    part = picture if picture and is_wide else area
    width = min(hello_imgui.em_size(_WIDTH), _SHARE * part.size.x)
    return ImVec2(part.pos.x + part.size.x / 2, area.pos.y + _TOP * area.size.y), width


_HOVERED = int(imgui.HoveredFlags_.root_and_child_windows)


def _row(entry: Entry, end: float) -> None:
    """Draw a name, and right of it, up to the pixel `end`, its keys or value and its place."""
    imgui.same_line(0.0, 0.0)
    imgui.text_unformatted(entry.name)
    used = imgui.get_item_rect_max().x - imgui.get_window_pos().x
    room = end - used - imgui.get_style().item_spacing.x
    shown = f"{entry.shown}   {entry.place}" if entry.shown else entry.place
    for text in (shown, entry.shown, entry.place):
        width = imgui.calc_text_size(text).x
        if text and width < room:
            imgui.same_line(end - width)
            imgui.text_disabled(text)
            return
