"""The list of what the scene holds, in the panel: a filter, rows for the mouse, and keys."""

from imgui_bundle import ImVec2, imgui

from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.outliner.contents import Entry, kept_entries, text_of
from glrt.view.outliner.row import Look, Used, draw_row
from glrt.view.widgets.cost_badges import tag
from glrt.view.widgets.finder import FINDER, Row
from glrt.view.widgets.steady_widget import ANCHOR

SECTION = "Contents"  # of the panel
_LEAST, _MOST = 3, 10  # rows in sight
_SHARE = 0.3  # of the panel's height: the most of it that the rows take
_WHOLE = 0.5  # of the panel's height: up to this, the list comes into view with the object
_PARTS = {"camera": "Camera", "background": "Background", "sun": "Sun"}  # of the panel
_HINT = "filter by name, shape, material"
_STEPS = {imgui.Key.up_arrow: -1, imgui.Key.down_arrow: 1}
_ENTER = (imgui.Key.enter, imgui.Key.keypad_enter)


class Outliner:
    """The words of the filter, the folded groups, and the row that keys start from."""

    def __init__(self) -> None:
        """Begin with all rows, and none of them chosen."""
        self.words = ""
        self.folded: frozenset[str] = frozenset()
        self.entries: list[Entry] = []
        self.chosen: tuple[str, str, int] | None = None  # key of the row
        self._place = -1  # of the chosen row; of the row before it, if it is gone
        self._selected: int | None = None  # object that was selected in the frame before
        self._is_awaited = self._scrolls = False
        self.is_first = False  # whether the panel begins with the list in this frame

    def find(self, app: App) -> None:
        """Bring the list into view, with the keys in its filter."""
        app.is_picture_alone, self._is_awaited = False, True
        FINDER.show(Row(SECTION, "filter"))

    def draw(self, app: App) -> None:
        """Draw filter and rows; a row that is clicked is selected, in the picture too."""
        if FINDER.lists("filter", value=self.words):
            return
        rows = len(self.entries) or _LEAST
        room = _SHARE * imgui.get_window_height()
        line = imgui.get_text_line_height_with_spacing()
        height = max(_LEAST * line, min(rows * line, _MOST * line, room)) + line / 2
        self._lead(app, height)
        is_typing = self._filter()
        self.entries = kept_entries(app.session.scene, self.words, self.folded)
        self._follow(app)
        imgui.begin_child("rows", ImVec2(0.0, height), imgui.ChildFlags_.borders.value)
        app.has_list_keys = imgui.is_window_focused()
        if (app.has_list_keys or is_typing) and not app.navigates:
            self._keys(app)
        self._rows(app, line)
        imgui.end_child()
        imgui.text_disabled("the eye hides")
        tag(Cost.RECOMPILE)

    def _lead(self, app: App, height: float) -> None:
        """Let the panel begin with the list when an object was selected, if there is room."""
        height += 3 * imgui.get_frame_height_with_spacing()
        self.is_first = app.is_to_be_seen and height < _WHOLE * imgui.get_window_height()
        if self.is_first:
            ANCHOR.go_here()

    def _filter(self) -> bool:
        """Draw the box for words; return whether keys go to it."""
        if self._is_awaited:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(-1.0)
        words = imgui.input_text_with_hint("##filter", _HINT, self.words)
        if words[0]:
            self._place, self._scrolls = -1, True
        self.words = words[1]
        FINDER.mark("filter")
        is_typing = bool(imgui.is_item_active())
        self._is_awaited &= not is_typing  # a part that has just appeared takes no keys yet
        return is_typing

    def _follow(self, app: App) -> None:
        """Choose the row of an object that was selected elsewhere, and unfold its group."""
        if app.selected != self._selected:
            self._selected = app.selected
            self.chosen = None if app.selected is None else ("object", "", app.selected)
            self._scrolls = True
            if self.chosen and self._number() is None and not self.words:
                self.folded = frozenset()
                self.entries = kept_entries(app.session.scene, self.words, self.folded)
        number = self._number()
        self._place = self._place if number is None else number

    def _number(self) -> int | None:
        """Return the place of the chosen row in the list; None if it is not there."""
        if 0 <= self._place < len(self.entries) and self.entries[self._place].key == self.chosen:
            return self._place
        return next((n for n, it in enumerate(self.entries) if it.key == self.chosen), None)

    def _keys(self, app: App) -> None:
        """Choose the row above or below by the arrow keys; fold and unfold, or go to a row."""
        pressed = imgui.is_key_pressed
        if not self.entries or imgui.is_popup_open("", imgui.PopupFlags_.any_popup.value):
            return
        number, step = self._number(), sum(s for key, s in _STEPS.items() if pressed(key))
        if step:
            start = self._place if number is not None or step < 0 else self._place - 1
            self._choose(app, max(0, min(start + step, len(self.entries) - 1)))
        elif number is not None and self.entries[number].kind == "group":
            group = self.entries[number].name
            for key, is_open in ((imgui.Key.left_arrow, False), (imgui.Key.right_arrow, True)):
                if pressed(key):
                    self._fold(group, not is_open)
        if number is not None and any(pressed(key, repeat=False) for key in _ENTER):
            self._go(app, self.entries[number])

    def _rows(self, app: App, line: float) -> None:
        """Draw the rows in sight; there may be thousands."""
        if not self.entries:
            imgui.text_disabled("nothing has all these words")
            return
        if self._scrolls:
            number = self._number() or 0
            top, room = imgui.get_scroll_y(), imgui.get_content_region_avail().y
            if not top <= number * line <= top + room - line:
                imgui.set_scroll_y(max(0.0, (number + 0.5) * line - room / 2))
        self._scrolls = False
        clipper = imgui.ListClipper()
        clipper.begin(len(self.entries), line)
        entries = self.entries
        while clipper.step():
            for number in range(clipper.display_start, clipper.display_end):
                used = draw_row(entries[number], self._look(app, entries[number]))
                if any(used):
                    self._use(app, number, used)

    def _look(self, app: App, entry: Entry) -> Look:
        scene = app.session.scene
        text, is_chosen = text_of(entry, scene.objects), entry.key == self.chosen
        is_chosen |= entry.kind == "object" and entry.number in app.chosen
        if entry.kind != "object":
            return Look(text, _meaning(entry), is_chosen, entry.name in self.folded)
        shape = scene.objects[entry.number]
        tip = f"{text}: object {entry.number}, {shape.shape} of {shape.material}"
        is_locked = entry.number in app.session.state.locked
        return Look(text, tip, is_chosen, is_hidden=shape.hidden, is_locked=is_locked)

    def _use(self, app: App, number: int, used: Used) -> None:
        """Do what a click on a part of a row asks for."""
        entry, state = self.entries[number], app.session.state
        ANCHOR.forget()  # else rows that change below would move the list under the mouse
        if used.eye:
            app.show_object(entry.number, app.session.scene.objects[entry.number].hidden)
        elif used.lock:
            app.session.lock(entry.number, entry.number not in state.locked)
        elif entry.kind == "object" and imgui.get_io().key_shift:
            app.select_also(entry.number)
        else:
            self._choose(app, number)
            self._go(app, entry)

    def _choose(self, app: App, number: int) -> None:
        """Choose a row, and select its object or nothing."""
        entry = self.entries[number]
        self.chosen, self._place, self._scrolls = entry.key, number, True
        app.selected = entry.number if entry.kind == "object" else None
        self._selected = app.selected

    def _go(self, app: App, entry: Entry) -> None:
        """Fold or unfold a group; bring the values of anything but an object into view."""
        objects = app.session.scene.objects
        if entry.kind == "group":
            self._fold(entry.name, entry.name not in self.folded)
        elif entry.kind == "medium":
            filled = next((n for n, it in enumerate(objects) if it.medium == entry.name), None)
            app.selected = self._selected = filled
            if filled is not None:
                FINDER.show(Row("Object", f"scattering##medium {entry.name}"))
        elif entry.kind in _PARTS:
            FINDER.show(Row(_PARTS[entry.kind], ""))

    def _fold(self, group: str, wanted: bool) -> None:
        self.folded = self.folded | {group} if wanted else self.folded - {group}


def _meaning(entry: Entry) -> str:
    """Return the tooltip of a row that is no object."""
    told = {
        "group": "Folds or unfolds this group",
        "medium": "Selects the object that it fills",
    }
    return told.get(entry.kind, f"Goes to the values of the {entry.name}")


OUTLINER = Outliner()  # of the panel: a window has only one


def draw_outliner(app: App) -> None:
    """Draw the part of the panel that lists what the scene holds."""
    OUTLINER.draw(app)
