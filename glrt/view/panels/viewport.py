"""Draw the picture and what is shown over it, and handle the mouse there."""

import math
import time

from imgui_bundle import ImVec2, imgui

from glrt.core.memo import kept_for_the_same
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.view.app import App
from glrt.view.panels.axes import click_axes, draw_axes
from glrt.view.panels.gizmo import draw_gizmo, is_held
from glrt.view.panels.inspector import pixel_text
from glrt.view.panels.legend import HEIGHT, draw_legend
from glrt.view.panels.navigation import NOTICE
from glrt.view.panels.pair_images import (
    draw_image,
    draw_notice,
    draw_side_by_side,
    draw_wipe,
    draw_wipe_handle,
)
from glrt.view.panels.path_overlay import draw_outside, draw_paths, paths_text
from glrt.view.panels.shortcuts import modifiers
from glrt.view.state.keys import label
from glrt.view.state.live_probes import notice_of_lag
from glrt.view.state.zoom import Rectangle, common
from glrt.view.viewport.outline import outline
from glrt.view.widgets.scrub import SCRUB

_EVERY_BUTTON = int(
    imgui.ButtonFlags_.mouse_button_left
    | imgui.ButtonFlags_.mouse_button_right
    | imgui.ButtonFlags_.mouse_button_middle
)
_FRAMED = 4.0  # screen pixels: from this size on, the pixel under the mouse gets a frame
_FADED = 0.2  # opacity of the outline during a drag
_OUTLINE = (0.0, 0.0, 0.0, 0.6), (1.0, 0.62, 0.1, 1.0)


def draw_viewport(app: App, room: ImVec2) -> None:
    """Draw the picture in a rectangle of `room` pixels, and what is shown over it."""
    settings, here = app.session.settings, imgui.get_cursor_screen_pos()
    has_kept = bool(app.pair.picture) and app.show.drawn == "picture"
    if has_kept and app.pair.is_beside:
        room = ImVec2(room.x / 2, room.y)
        here = here + ImVec2(room.x, 0)
    left, top, width, height = app.zoom.placed((room.x, room.y), (settings.width, settings.height))
    corner = here + ImVec2(left, top)
    app.rectangle = (corner.x, corner.y, width, height)
    seen = common(app.rectangle, (here.x, here.y, max(room.x, 1.0), max(room.y, 1.0)))
    if app.picture.name:
        draw_image(app, app.rectangle, seen, app.picture)
    is_wiped = has_kept and not app.pair.is_beside
    if has_kept and app.pair.is_beside:
        draw_side_by_side(app, seen, room.x)
    elif is_wiped:
        draw_wipe(app, seen)
    _outline(app, seen)
    draw_paths(app, seen)
    draw_gizmo(app, corner.x, corner.y, width, height)
    draw_outside(app, seen)
    draw_axes(app, seen)
    if not is_held(app):  # a button below the handles would take the mouse from them
        if is_wiped:
            draw_wipe_handle(app)
        is_on_axis = click_axes(app, seen)
        imgui.set_cursor_screen_pos(here)  # drags may begin next to the picture, too
        imgui.invisible_button("picture", ImVec2(max(room.x, 1), max(room.y, 1)), _EVERY_BUTTON)
        _mouse(app, here, room)
        if not is_on_axis:
            _clicks(app)
    if app.dropped:
        dropped, app.dropped = app.dropped, None
        app.lay_image(dropped, *_share_under_mouse(app))
    low = ImVec2(seen[0], seen[1] + seen[3])
    if app.show.drawn != "picture":
        draw_legend(app.show, app.session, app.progress.last, low, seen[2])
    if app.inspects:
        _pixel_values(app, seen)


def _share_under_mouse(app: App) -> tuple[float, float]:
    """Return the place of the mouse in the picture, from (0, 0) upper left to (1, 1)."""
    left, top, width, height = app.rectangle
    x, y = imgui.get_io().mouse_pos
    return (x - left) / width, (y - top) / height


def notices(app: App) -> list[str]:
    """Return what is said about the picture at present, a line each."""
    opens = app.files.aside.text
    lines = (
        f"{opens}; Escape cancels" if opens else "",
        app.exports.text(time.perf_counter()),
        app.show.notice(app.session),
        notice_of_lag(app.session.lag),
        paths_text(app),
        "old picture, until the new one has a sample" if _is_old(app) else "",
        _black_text(app),
        "paused" if app.session.paused else "",
        NOTICE if app.navigates else "",
        _zoom_text(app),
        app.messages.recent(time.perf_counter()),
    )
    return [line for line in lines if line]


def _black_text(app: App) -> str:
    """Return why the picture is black, and the key that leads back; "" if it is not black."""
    reason, keys = app.blackness.reason, app.preferences.bindings["home"]
    if app.show.drawn != "picture" or not reason:
        return ""
    is_elsewhere = app.camera != app.session.opened.scene.camera
    back = f". {label(keys[0])} goes back to the first view" if keys and is_elsewhere else ""
    return reason + back


def _zoom_text(app: App) -> str:
    """Return the zoom, and the key that ends it; "" if the whole picture is shown."""
    scale, keys = app.zoom.scale, app.preferences.bindings["fit"]
    if scale is None:
        return ""
    ratio = f"{scale:.3g}:1" if scale >= 1 else f"1:{1 / scale:.3g}"
    return f"zoom {ratio}" + (f"; {label(keys[0])} shows the whole picture" if keys else "")


def _is_old(app: App) -> bool:
    """Whether the picture on the screen lacks the last edit, and is no preview of it."""
    return app.show.is_old and not app.show.is_surface


def _pixel_values(app: App, seen: Rectangle) -> None:
    """Draw the values of the pixel under the mouse, in the other half of the picture."""
    share = _share_under_mouse(app)
    lines = pixel_text(app, *share)
    if not lines:
        return
    left, top, _, height = seen
    is_low = imgui.get_io().mouse_pos.y < top + height / 2
    room = (len(lines) + 1) * imgui.get_text_line_height() + imgui.get_font_size()
    room += HEIGHT * imgui.get_text_line_height() * (app.show.drawn != "picture")  # of the legend
    below = top + height - room if is_low else top + 3.0 * imgui.get_font_size()
    draw_notice("\n".join(lines), ImVec2(left, below))
    columns, rows = app.session.settings.size
    pixel = app.rectangle[2] / columns, app.rectangle[3] / rows
    if pixel[0] >= _FRAMED:
        x = app.rectangle[0] + math.floor(share[0] * columns) * pixel[0]
        y = app.rectangle[1] + math.floor(share[1] * rows) * pixel[1]
        color = imgui.get_color_u32(_OUTLINE[1])
        imgui.get_window_draw_list().add_rect((x, y), (x + pixel[0], y + pixel[1]), color)


def _outline(app: App, seen: Rectangle) -> None:
    """Draw the outlines of the selected objects, fainter while the mouse drags something."""
    if min(seen[2:]) < 1:
        return
    objects = app.session.scene.objects
    chosen = [objects[number] for number in sorted(app.chosen) if not objects[number].hidden]
    fade = _FADED if is_dragging() else 1.0
    for shape in chosen:
        if not isinstance(shape, Mesh):
            _edges_of(app, shape, fade)
    if meshes := [shape for shape in chosen if isinstance(shape, Mesh)]:
        line = app.silhouette.draw(meshes, app.camera, app.rectangle, seen)
        corner, end = seen[:2], (seen[0] + seen[2], seen[1] + seen[3])
        tint = imgui.get_color_u32((1.0, 1.0, 1.0, fade))
        painter = imgui.get_window_draw_list()
        painter.add_image(imgui.ImTextureRef(line.glo), corner, end, (0, 1), (1, 0), tint)


def _edges_of(app: App, shape: Shape, fade: float) -> None:
    left, top, width, height = app.rectangle
    settings = app.session.settings
    painter, here = imgui.get_window_draw_list(), (left, top)
    edges = _edges if shape is app.selected_shape else outline  # the last results are kept
    lines = edges(shape, app.camera, settings.width / settings.height)
    places = (lines * (width, height) + here).tolist()
    painter.push_clip_rect(here, (left + width, top + height), True)
    dark, bright = (imgui.get_color_u32((*color[:3], fade * color[3])) for color in _OUTLINE)
    for color, thickness in ((dark, 3.0), (bright, 1.5)):  # visible on any picture
        for start, end in places:
            painter.add_line(start, end, color, thickness)
    painter.pop_clip_rect()


def is_dragging() -> bool:
    """Whether the mouse drags something; a text that is typed is no drag."""
    is_active = imgui.is_any_item_active() and not imgui.get_io().want_text_input
    return bool(is_active or SCRUB.is_under_way)


_edges = kept_for_the_same(outline)


def _mouse(app: App, here: ImVec2, room: ImVec2) -> None:
    """Move the camera by drags and the wheel; with Ctrl, they change the zoom instead.

    A left drag turns by the mode, orbit or fly, and a right drag by the other one. A middle drag
    shifts, and the wheel dollies.
    """
    io = imgui.get_io()
    is_zoom = "ctrl" in modifiers()
    if imgui.is_item_hovered() and io.mouse_wheel and is_zoom:
        at = (io.mouse_pos.x - here.x, io.mouse_pos.y - here.y)
        size, factor = app.session.settings.size, 2 ** (0.5 * io.mouse_wheel)
        app.zoom = app.zoom.about((room.x, room.y), size, at, factor)
    elif imgui.is_item_hovered() and io.mouse_wheel:
        app.wheel(io.mouse_wheel)
    if imgui.is_item_activated():  # in a slow frame, the motion before the press counts too
        return
    if not imgui.is_item_active() or (io.mouse_delta.x == 0 and io.mouse_delta.y == 0):
        return
    if is_zoom:
        app.zoom = app.zoom.shifted(app.session.settings.size, io.mouse_delta.x, io.mouse_delta.y)
        return
    across, down = io.mouse_delta.x / io.display_size.x, io.mouse_delta.y / io.display_size.y
    if imgui.is_mouse_down(imgui.MouseButton_.middle):
        app.shift(across, down)
    else:
        is_right = imgui.is_mouse_down(imgui.MouseButton_.right)
        app.turn(across, down, about_camera=(app.preferences.mode == "fly") != is_right)


def _clicks(app: App) -> None:
    """Select by a click or ask for paths, focus by Alt and a click, and pivot by a double click.

    A click next to the picture selects nothing.
    """
    left, share = imgui.MouseButton_.left.value, _share_under_mouse(app)
    if not imgui.is_item_hovered() or imgui.is_mouse_dragging(left):
        return
    is_over = all(0 <= part <= 1 for part in share)
    if imgui.is_mouse_double_clicked(left):
        if is_over and (picked := app.pick(*share)):
            app.turn_about(picked.point)
    elif imgui.is_mouse_released(left) and not _was_dragged():
        if app.paths.is_choosing:
            if is_over:
                app.ask_paths(*share)
            return
        picked = app.pick(*share) if is_over else None
        if picked and imgui.get_io().key_alt:
            app.focus_on(picked.point)
        else:
            _select(app, picked.number if picked else None)


def _select(app: App, number: int | None) -> None:
    """Select an object or nothing; with Shift, one more object."""
    if not imgui.get_io().key_shift:
        app.select(number)
    elif number is not None:
        app.select_also(number)


def _was_dragged() -> bool:
    moved = imgui.get_io().mouse_drag_max_distance_sqr[0]
    return bool(moved > imgui.get_io().mouse_drag_threshold ** 2)
