"""The question whether edits of an earlier window are to be restored, in a box over the picture."""

import time

from imgui_bundle import ImVec2, hello_imgui, imgui

from glrt.view.recovery.keeper import Recovery
from glrt.view.widgets.boxes import box
from glrt.view.widgets.fields import button, tip

NAME = "Edits that were not saved###recovery"
_WIDTH = 20.0  # em
_APART = 1.0  # em: from the edges of the picture


def draw_recovery(recovery: Recovery) -> None:
    """Draw the question lower right in the picture; its cross leaves it to the next start."""
    if not recovery.offers:
        return
    picture = imgui.internal.find_window_by_name("Picture")
    if picture is None:  # before the first frame
        return
    apart = hello_imgui.em_size(_APART)
    place = picture.pos + picture.size - ImVec2(apart, apart)
    imgui.set_next_window_pos(place, imgui.Cond_.always.value, ImVec2(1.0, 1.0))
    width = min(hello_imgui.em_size(_WIDTH), picture.size.x - 2 * apart)
    imgui.set_next_window_size(ImVec2(width, 0.0))
    with box(NAME, imgui.WindowFlags_.no_focus_on_appearing.value, has_title=True) as drawn:
        if drawn.is_shown:
            _answers(recovery)
    if not drawn.is_open:
        recovery.put_off()


def _answers(recovery: Recovery) -> None:
    imgui.text_wrapped(recovery.offers[0].header.told(time.time()))
    is_restored = button("restore")
    tip("Bring these edits back; undo takes them away again")
    imgui.same_line()
    is_discarded = button("discard")
    tip("Remove these edits for good; x asks again at the next start")
    if is_restored:
        recovery.restore()
    elif is_discarded:
        recovery.discard()
