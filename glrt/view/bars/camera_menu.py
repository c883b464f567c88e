"""Menu of views: sides of the scene, views that were kept, and cameras of its files."""

from imgui_bundle import ImVec2, imgui

from glrt.core.text import escaped
from glrt.view.app import App
from glrt.view.state.keys import MOST_VIEWS, label
from glrt.view.viewport.sides import SIDES

_NAME = "views of the camera"


def open_camera_menu() -> None:
    """Open the menu in the next frame."""
    imgui.open_popup(_NAME)


def draw_camera_menu(app: App) -> None:
    """Draw the menu below the item drawn last, if it is open."""
    place = ImVec2(imgui.get_item_rect_min().x, imgui.get_item_rect_max().y)
    imgui.set_next_window_pos(place, imgui.Cond_.appearing.value)
    if not imgui.begin_popup(_NAME):
        return
    first = app.preferences.bindings["home"]
    if imgui.menu_item("first view", label(first[0]) if first else "", False)[0]:
        app.home()
    imgui.separator_text("sides of the scene")
    for side in SIDES:
        if imgui.menu_item(side, "", False)[0]:
            app.see_from(side)
    _kept(app)
    cameras = app.cameras_of_files
    if cameras:
        imgui.separator_text("cameras of files")
    for number, (name, camera) in enumerate(cameras.items()):
        if imgui.menu_item(f"{escaped(name)}##{number}", "", camera == app.camera)[0]:
            app.see_by(camera)
    imgui.end_popup()


def _kept(app: App) -> None:
    """Draw the views that were kept, and what keeps one more."""
    imgui.separator_text("kept views")
    for number in sorted(app.views):
        if imgui.menu_item(f"view {number}", label(f"alt+{number}"), False)[0]:
            app.recall_view(number)
    free = next((n for n in range(1, MOST_VIEWS + 1) if n not in app.views), None)
    told = label(f"ctrl+{free}") if free else "Ctrl+1 to Ctrl+9"
    if imgui.menu_item("keep this view", told, False, free is not None)[0] and free:
        app.keep_view(free)
