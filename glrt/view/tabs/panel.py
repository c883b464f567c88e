"""The main panel: the values of the scene and all settings, by subject, in tabs."""

from textwrap import shorten

from imgui_bundle import imgui

from glrt.core.memo import kept_for_the_same
from glrt.scene.warnings import cautions
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import replaced
from glrt.view.state.preferences import Tab
from glrt.view.tabs.bar import bar_end, below_bar
from glrt.view.tabs.sections import SECTIONS, TABS, Section, is_wanted, tab_of
from glrt.view.widgets.cost_badges import COLORS
from glrt.view.widgets.finder import FINDER
from glrt.view.widgets.steady_widget import ANCHOR
from glrt.view.widgets.tips import explain

_LETTERS = 90  # of a caution: two lines of a panel
_FRAMES = 3  # after a tab was chosen: its rows have their heights afterwards


class Panel:
    """The tab that was drawn last, and how far down each was scrolled."""

    def __init__(self) -> None:
        """Begin with no tab drawn."""
        self._drawn: Tab | None = None
        self._scrolled: dict[Tab, float] = {}
        self._frames = 0  # for which it scrolls there

    def draw(self, app: App) -> None:
        """Draw the tab that was chosen last, or that of a part that must come into view."""
        wanted = next((tab_of(part) for part in SECTIONS if is_wanted(app, part)), None)
        if wanted and wanted != app.preferences.tab:
            app.prefer(replaced(app.preferences, tab=wanted))
        self._turn_to(app.preferences.tab)
        if wanted:
            self._frames = 0
        with below_bar(app, tuple(TABS)):
            _rows(app, TABS[app.preferences.tab])
        ANCHOR.keep()

    def _turn_to(self, tab: Tab) -> None:
        """Scroll to where a tab was left, if another one was drawn before."""
        if self._drawn != tab:
            if self._drawn:
                self._scrolled[self._drawn] = imgui.get_scroll_y()
                self._frames = _FRAMES
                ANCHOR.forget()
            self._drawn = tab
        if self._frames:
            self._frames -= 1
            imgui.set_scroll_y(self._scrolled.get(tab, 0.0))


def _rows(app: App, sections: tuple[Section, ...]) -> None:
    """Draw the cautions and the parts of a tab, which scroll below the bar."""
    _cautions(app)
    for section in sections:
        _section(app, section)
    FINDER.enter("")


def _section(app: App, section: Section) -> None:
    """Draw a part, or its title alone if it is folded; a part that is wanted is unfolded."""
    title, folded = section.title, app.preferences.folded
    FINDER.enter(title)
    was_open = title not in folded or is_wanted(app, section)
    imgui.set_next_item_open(was_open)
    is_shown = imgui.collapsing_header(title)
    ANCHOR.note()
    FINDER.mark("")
    top = imgui.get_item_rect_min().y
    if is_shown == (title in folded):
        others = tuple(other for other in folded if other != title)
        kept = others if is_shown else (*others, title)
        app.prefer(replaced(app.preferences, folded=kept))
    if is_shown:
        section.draw(app)
    if is_shown and not was_open:
        _bring_to_sight(top)


def _bring_to_sight(top: float) -> None:
    """Scroll down to the end of a section that was unfolded, but not past its title."""
    corner, height = imgui.get_window_pos().y, imgui.get_window_height()
    hidden = imgui.get_cursor_screen_pos().y - corner - height
    room = top - corner - bar_end()
    if hidden > 0 and room > 0:
        imgui.set_scroll_y(imgui.get_scroll_y() + min(hidden, room))


def _cautions(app: App) -> None:
    """Draw cautions where a scene exceeds float32 or the model; `glrt render` prints them too.

    The panel has their beginnings, and tooltips the whole.
    """
    for caution in _found(app.session.scene, app.session.settings):
        imgui.push_style_color(imgui.Col_.text, COLORS[Cost.RESTART])
        imgui.text_wrapped(f"Caution: {shorten(caution, _LETTERS, placeholder=' ...')}")
        imgui.pop_style_color()
        explain(caution)


_found = kept_for_the_same(cautions)
