"""Move between the picture and the widgets of the panel by keys."""

from imgui_bundle import imgui

from glrt.view.app import App

PANEL, PICTURE = "Controls", "Picture"
NOTICE = "arrow keys and Tab move in the panel; Escape goes back to the picture"
_ELSEWHERE = (PICTURE, "Figures")


def navigate(app: App, wanted: bool) -> None:
    """Let keys move in the panel, from its last used widget; or let them move the camera."""
    app.navigates = wanted
    io, flag = imgui.get_io(), imgui.ConfigFlags_.nav_enable_keyboard.value
    io.config_flags = io.config_flags | flag if wanted else io.config_flags & ~flag
    imgui.set_window_focus(PANEL if wanted else PICTURE)
    if wanted and not imgui.get_current_context().nav_id:
        imgui.internal.nav_init_window(imgui.internal.find_window_by_name(PANEL), True)
    imgui.set_nav_cursor_visible(wanted)


def leaves(app: App) -> bool:
    """Whether Escape is pressed in the panel, or the mouse has chosen another part.

    Dear ImGui handles the key first: an open list or an active widget has taken it.
    """
    was_busy, app.was_busy = app.was_busy, _is_busy()
    if not app.navigates:
        return False
    here = imgui.get_current_context().nav_window
    is_elsewhere = here is not None and here.name in _ELSEWHERE
    return is_elsewhere or (imgui.is_key_pressed(imgui.Key.escape, False) and not was_busy)


def _is_busy() -> bool:
    """Whether a list is open, or a widget is dragged or typed into."""
    is_open = imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup))
    return bool(is_open or imgui.is_any_item_active())
