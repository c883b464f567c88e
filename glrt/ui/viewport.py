"""The picture in its window, and the mouse and the keys that move the camera."""

from imgui_bundle import ImVec2, imgui

from glrt.ui.app import App
from glrt.ui.preferences import Action, Move

Rectangle = tuple[float, float, float, float]  # left, top, width, height

_AXES: dict[Move, tuple[int, int, int]] = {  # right, up, forward
    "forward": (0, 0, 1),
    "back": (0, 0, -1),
    "left": (-1, 0, 0),
    "right": (1, 0, 0),
    "up": (0, 1, 0),
    "down": (0, -1, 0),
}
_LONGEST_STEP = 0.1  # seconds: a slow frame must not throw the camera out of the room
_NOTICE = (0.0, 0.0, 0.0, 0.65)


def fitted(room: tuple[float, float], size: tuple[int, int]) -> Rectangle:
    """Where a picture of a size lies, as large as fits and in the middle of the room."""
    scale = min(room[0] / size[0], room[1] / size[1])
    width, height = max(1.0, scale * size[0]), max(1.0, scale * size[1])
    return ((room[0] - width) / 2, (room[1] - height) / 2, width, height)


def draw_viewport(app: App) -> None:
    """The content of the window that holds the picture."""
    settings = app.session.settings
    room = imgui.get_content_region_avail()
    left, top, width, height = fitted((room.x, room.y), (settings.width, settings.height))
    corner = imgui.get_cursor_screen_pos() + ImVec2(left, top)
    if app.picture.name:
        imgui.set_cursor_screen_pos(corner)
        texture = imgui.ImTextureRef(app.picture.name)
        imgui.image(texture, ImVec2(width, height), uv0=(0, 1), uv1=(1, 0))  # OpenGL's row 0 is low
    imgui.set_cursor_screen_pos(corner)
    buttons = imgui.ButtonFlags_
    every = buttons.mouse_button_left | buttons.mouse_button_right | buttons.mouse_button_middle
    imgui.invisible_button("picture", ImVec2(width, height), int(every))
    _mouse(app)
    if app.session.busy:
        _notice(app.session.busy, corner)


def draw_keys(app: App) -> None:
    """Act on the keys; not while a text is typed."""
    io = imgui.get_io()
    if io.want_text_input:
        return
    seconds = min(io.delta_time, _LONGEST_STEP)
    held = [axis for action, axis in _AXES.items() if _is_held(app, action)]
    if held:
        right, up, forward = (float(sum(parts)) for parts in zip(*held, strict=True))
        app.walk(right, up, forward, seconds)
    if _is_pressed(app, "home"):
        app.home()
    if _is_pressed(app, "pause"):
        app.session.paused = not app.session.paused
    if _is_pressed(app, "undo"):
        app.session.undo()
    if _is_pressed(app, "redo"):
        app.session.redo()
    if not held and not imgui.is_any_item_active() and not imgui.is_mouse_down(0):
        app.session.history.settle()


def _mouse(app: App) -> None:
    """Left drags by the mode, right the other way, middle shifts; the wheel dollies."""
    io = imgui.get_io()
    if imgui.is_item_hovered() and io.mouse_wheel:
        app.wheel(io.mouse_wheel)
    if not imgui.is_item_active() or (io.mouse_delta.x == 0 and io.mouse_delta.y == 0):
        return
    across, down = io.mouse_delta.x / io.display_size.x, io.mouse_delta.y / io.display_size.y
    if imgui.is_mouse_down(imgui.MouseButton_.middle):
        app.shift(across, down)
    else:
        is_right = imgui.is_mouse_down(imgui.MouseButton_.right)
        app.turn(across, down, about_camera=(app.preferences.mode == "fly") != is_right)


def _notice(text: str, corner: ImVec2) -> None:
    """A line of text over the picture."""
    margin = ImVec2(imgui.get_font_size() * 0.6, imgui.get_font_size() * 0.4)
    painter, at = imgui.get_window_draw_list(), corner + margin
    painter.add_rect_filled(
        at, at + imgui.calc_text_size(text) + margin + margin, imgui.get_color_u32(_NOTICE), 4.0
    )
    painter.add_text(at + margin, imgui.get_color_u32((1.0, 1.0, 1.0, 1.0)), text)


def _is_held(app: App, action: Action) -> bool:
    """Whether a key without modifiers is down."""
    if imgui.get_io().key_ctrl:
        return False
    return any(
        imgui.is_key_down(imgui.Key[name]) for name in app.preferences.bindings.get(action, ())
    )


def _is_pressed(app: App, action: Action) -> bool:
    return any(
        imgui.is_key_chord_pressed(_chord(n)) for n in app.preferences.bindings.get(action, ())
    )


def _chord(name: str) -> int:
    """ "ctrl+shift+z" as Dear ImGui has it."""
    *modifiers, key = name.split("+")
    chord = imgui.Key[key].value
    for modifier in modifiers:
        chord |= imgui.Key[f"mod_{modifier}"].value
    return int(chord)
