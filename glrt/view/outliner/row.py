"""One row of the list: its text, and for an object the eye that hides it and its lock."""

from typing import NamedTuple

from imgui_bundle import ImVec2, hello_imgui, imgui
from imgui_bundle import icons_fontawesome_4 as icons

from glrt.settings import Cost
from glrt.view.controls import MEANING
from glrt.view.outliner.contents import Entry
from glrt.view.widgets.tips import explain

_INDENT = 1.0  # em: of the members of a group
_ICON = 1.5  # em: width of the eye, and of the lock
_FAINT = 0.45  # opacity of what is hidden, and of an icon that says nothing special
_LOCK = "keeps edits away from the object, its handles and its deletion; free"


class Look(NamedTuple):
    """How a row is shown; `is_hidden` and `is_locked` are those of its object."""

    text: str
    tip: str
    is_chosen: bool
    is_folded: bool = False
    is_hidden: bool = False
    is_locked: bool = False


class Used(NamedTuple):
    """The parts of a row that were clicked."""

    row: bool = False
    eye: bool = False
    lock: bool = False


def draw_row(entry: Entry, look: Look) -> Used:
    """Draw a row over the width of the list; return what was clicked."""
    name = f"object {entry.number}" if entry.kind == "object" else f"{entry.kind} {entry.name}"
    corner, width = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
    imgui.set_next_item_allow_overlap()
    row = imgui.selectable(f"##{name}", look.is_chosen)[0]
    explain(look.tip)
    is_under_mouse = imgui.is_item_hovered(imgui.HoveredFlags_.allow_when_overlapped.value)
    end = corner.x + width
    if entry.kind != "object":
        _write(entry, look, corner, end)
        return Used(row=row)
    size = ImVec2(hello_imgui.em_size(_ICON), imgui.get_text_line_height())
    eye, lock = (ImVec2(end - n * size.x, corner.y) for n in (1, 2))
    _write(entry, look, corner, lock.x)
    icon = icons.ICON_FA_LOCK if look.is_locked else icons.ICON_FA_UNLOCK
    is_lock = _icon(f"lock of {name}", lock, size, icon if is_under_mouse or look.is_locked else "")
    explain(f"{'Unlocks' if look.is_locked else 'Locks'}: a lock {_LOCK}")
    icon = icons.ICON_FA_EYE_SLASH if look.is_hidden else icons.ICON_FA_EYE
    is_eye = _icon(f"eye of {name}", eye, size, icon)
    doing = "Shows" if look.is_hidden else "Hides"
    explain(f"{doing} the object\n{Cost.RECOMPILE.value}: {MEANING[Cost.RECOMPILE]}")
    return Used(row=row and not (is_eye or is_lock), eye=is_eye, lock=is_lock)


def _write(entry: Entry, look: Look, corner: ImVec2, end: float) -> None:
    """Write the text of a row, cut off at `end`, in pixels of the screen."""
    painter, start = imgui.get_window_draw_list(), ImVec2(corner.x, corner.y)
    is_member = entry.kind not in ("group", "camera")
    start.x += hello_imgui.em_size(2 * _INDENT if is_member else _INDENT)
    painter.push_clip_rect(corner, ImVec2(end, corner.y + imgui.get_text_line_height()), True)
    if entry.kind == "group":
        arrow = icons.ICON_FA_CARET_RIGHT if look.is_folded else icons.ICON_FA_CARET_DOWN
        painter.add_text(corner, _color(1.0), arrow)
    painter.add_text(start, _color(_FAINT if look.is_hidden else 1.0), look.text)
    if entry.kind in ("group", "object"):
        start.x += imgui.calc_text_size(look.text).x + hello_imgui.em_size(0.6)
        painter.add_text(start, _color(_FAINT), str(entry.number))
    painter.pop_clip_rect()


def _icon(name: str, corner: ImVec2, size: ImVec2, icon: str) -> bool:
    imgui.set_cursor_screen_pos(corner)
    is_clicked = imgui.invisible_button(name, size)
    is_special = imgui.is_item_hovered() or icon in (icons.ICON_FA_EYE_SLASH, icons.ICON_FA_LOCK)
    apart = (size.x - imgui.calc_text_size(icon).x) / 2
    painter = imgui.get_window_draw_list()
    painter.add_text(corner + ImVec2(apart, 0.0), _color(1.0 if is_special else _FAINT), icon)
    return is_clicked


def _color(opacity: float) -> int:
    return imgui.get_color_u32(imgui.Col_.text, opacity)
