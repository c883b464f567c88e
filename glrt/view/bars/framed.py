"""The picture between its bars."""

from imgui_bundle import ImVec2, imgui

from glrt.view.app import App
from glrt.view.bars.status import draw_status, height_of_status
from glrt.view.bars.timeline import draw_timeline, height_of_timeline
from glrt.view.bars.toolbar import draw_toolbar
from glrt.view.panels.viewport import draw_viewport, notices


def draw_picture(app: App) -> None:
    """Draw the content of the part of the window that holds the picture."""
    draw_toolbar(app)
    corner, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail()
    height = room.y - height_of_status() - height_of_timeline(app)
    draw_viewport(app, ImVec2(room.x, max(height, 1.0)))
    below = corner + ImVec2(0.0, height + imgui.get_style().item_spacing.y)
    imgui.set_cursor_screen_pos(below)
    draw_timeline(app)
    draw_status(app, notices(app))
