"""Draw the paths of a pixel over the picture, and in a view from outside."""

from collections.abc import Iterable

import numpy as np
from imgui_bundle import ImVec2, imgui

from glrt.core.memo import kept_for_the_same
from glrt.rendering.paths.values import Path
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.view.app import App
from glrt.view.state.zoom import Rectangle
from glrt.view.viewport.outline import Segments, outline, projected
from glrt.view.viewport.path_lines import Ball, Kind, Line, lines_of, outside, surroundings

Color = tuple[float, float, float, float]
COLORS: dict[Kind, Color] = {
    "path": (1.0, 1.0, 1.0, 1.0),
    "escape": (0.45, 0.75, 1.0, 1.0),
    "sampled": (1.0, 0.85, 0.2, 1.0),
    "hidden": (0.95, 0.35, 0.35, 0.8),
    "linked": (1.0, 0.55, 0.95, 1.0),
}
_FAINT: Color = (1.0, 1.0, 1.0, 0.25)
_GROUND, _THING = (0.08, 0.08, 0.1, 0.9), (0.65, 0.65, 0.7, 0.8)
_CAMERA: Color = (0.4, 0.9, 0.5, 1.0)
SHARE = 0.42  # side of the view from outside, in shorter sides of the visible picture
MOST_OBJECTS = 200  # drawn in that view
_DEGREES = 0.5  # by which a pixel of a drag turns that view


def draw_paths(app: App, seen: Rectangle) -> None:
    """Draw the paths over the picture, the shown one brighter than the others."""
    paths, left_top = app.paths, app.rectangle[:2]
    if not paths.found or not paths.shown:
        return
    settings, painter = app.session.settings, imgui.get_window_draw_list()
    view = _View(app.camera, settings.width / settings.height, left_top, app.rectangle[2:])
    painter.push_clip_rect(seen[:2], (seen[0] + seen[2], seen[1] + seen[3]), True)
    eye, particles = paths.found.recipe.scene.camera.position, paths.found.particles
    for path in (*paths.found.paths, *(particles.paths if particles else ())):
        if path is not paths.shown:
            lines = lines_of(path, app.reach, eye)
            view.draw([line for line in lines if line.kind == "path"], _FAINT)
    view.draw(lines_of(paths.shown, app.reach, eye))
    view.dots(paths.shown)
    painter.pop_clip_rect()


def paths_text(app: App) -> str:
    """Return a notice on what a click does, or how paths are removed; "" if there is none."""
    paths = app.paths
    if paths.busy or not (paths.is_choosing or paths.found):
        return paths.busy
    if not paths.found:
        return "click a pixel to see its paths; Escape ends this"
    x, y = paths.found.pixel
    escape = "Escape: clicks select objects again" if paths.is_choosing else "Escape removes them"
    return f"paths of pixel {x}, {y}; {escape}"


def place_of_outside(app: App, seen: Rectangle) -> Rectangle | None:
    """Return the rectangle of the view from outside, in a corner far from the pixel, or None."""
    found = app.paths.found
    if not app.paths.shown or not found:
        return None
    side, settings = SHARE * min(seen[2:]), found.recipe.settings
    is_toured = app.preferences.tour and app.tour_step is not None  # its box is upper right
    is_high = found.pixel[1] >= settings.height / 2 and not is_toured  # notices are upper left
    is_left = not is_high and found.pixel[0] >= settings.width / 2
    left = seen[0] if is_left else seen[0] + seen[2] - side
    return left, seen[1] if is_high else seen[1] + seen[3] - side, side, side


def draw_outside(app: App, seen: Rectangle) -> None:
    """Draw the shown path from outside in a corner of the picture; a drag turns that view."""
    path, found, place = app.paths.shown, app.paths.found, place_of_outside(app, seen)
    if not path or not found or not place:
        return
    corner, side = place[:2], place[2]
    painter, end = imgui.get_window_draw_list(), (corner[0] + side, corner[1] + side)
    painter.add_rect_filled(corner, end, imgui.get_color_u32(_GROUND), 4.0)
    painter.push_clip_rect(corner, end, True)
    scene = found.recipe.scene
    ball = _surroundings(scene, path)
    view = _View(_camera(ball, *app.outside), 1.0, corner, (side, side))
    for lines in _things(scene, view.camera):
        view.lines(lines, _THING, 1.0)
    eye = np.array(scene.camera.position)
    view.draw([Line(eye, np.array(scene.camera.look_at), "path")], (*_CAMERA[:3], 0.4))
    view.draw(lines_of(path, ball.radius, scene.camera.position))
    view.dots(path)
    painter.add_text(
        imgui.get_font(),
        imgui.get_font_size(),
        ImVec2(*corner) + ImVec2(6, 4),
        imgui.get_color_u32(COLORS["path"]),
        "from outside; a drag turns it",
        wrap_width=max(side - 12, 1),
    )
    painter.pop_clip_rect()
    _turn(app, corner, side)


def _turn(app: App, corner: tuple[float, float], side: float) -> None:
    imgui.set_cursor_screen_pos(ImVec2(*corner))
    imgui.invisible_button("outside", ImVec2(max(side, 1), max(side, 1)))
    if imgui.is_item_active():
        moved, (yaw, pitch) = imgui.get_io().mouse_delta, app.outside
        pitch = min(max(pitch + _DEGREES * moved.y, -85.0), 85.0)
        app.outside = (yaw - _DEGREES * moved.x, pitch)


class _View:
    """Draws lines of the scene as a camera sees them, in a rectangle of the screen."""

    def __init__(
        self,
        camera: Camera,
        aspect: float,
        corner: tuple[float, ...],
        size: tuple[float, ...],
    ) -> None:
        self.camera, self._aspect = camera, aspect
        self._corner, self._size = np.array(corner), np.array(size)
        self._near = 1e-4 * camera.resolved_focus_distance

    def draw(self, lines: Iterable[Line], color: Color | None = None) -> None:
        """Draw lines in `color`, or each kind in its own colour."""
        for line in lines:
            ends = np.stack([line.start, line.end])[None]
            places = projected(ends, self.camera, self._aspect, self._near)
            self.lines(places, color or COLORS[line.kind], 1.0 if color else 2.0)

    def dots(self, path: Path) -> None:
        """Draw the vertices of a path except its first one, on the lens."""
        painter, color = imgui.get_window_draw_list(), imgui.get_color_u32(COLORS["path"])
        for vertex in path.vertices[1:]:
            point = np.array(vertex.position)
            places = projected(
                np.stack([point, point])[None], self.camera, self._aspect, self._near
            )
            for start, _ in self._on_screen(places):
                painter.add_circle_filled(start, 3.0, color)

    def lines(self, places: Segments, color: Color, thickness: float) -> None:
        """Draw segments in shares of the rectangle; thick ones get a dark edge for contrast."""
        painter = imgui.get_window_draw_list()
        dark = imgui.get_color_u32((0.0, 0.0, 0.0, 0.6 * color[3]))
        bright = imgui.get_color_u32(color)
        for start, end in self._on_screen(places):
            if thickness > 1:
                painter.add_line(start, end, dark, thickness + 2)
            painter.add_line(start, end, bright, thickness)

    def _on_screen(self, places: Segments) -> list[list[list[float]]]:
        near = np.clip(places, -50, 50)  # far outside of the rectangle, ends need not be exact
        found: list[list[list[float]]] = (near * self._size + self._corner).tolist()
        return found


_camera = kept_for_the_same(outside)


@kept_for_the_same
def _surroundings(scene: Scene, path: Path) -> Ball:
    return surroundings(scene, path)


@kept_for_the_same
def _things(scene: Scene, camera: Camera) -> list[Segments]:
    return [outline(shape, camera, 1.0) for shape in scene.visible[:MOST_OBJECTS]]
