"""Moves of the camera by mouse and keys."""

import math
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from glrt.core.errors import UsageError
from glrt.scene.camera import Camera
from glrt.scene.values import LARGEST, SMALLEST, Vector
from glrt.view.controls import replaced
from glrt.view.edits.file_camera import cameras_of
from glrt.view.files import Files
from glrt.view.kept_views import KeptViews, Views
from glrt.view.messages import Messages
from glrt.view.state.keys import label
from glrt.view.state.preferences import Preferences
from glrt.view.state.session import Session
from glrt.view.viewport import orbit
from glrt.view.viewport.sides import Ball, ball_of, seen_from


class CameraMoves:
    """Moves the camera of a session; `pivot` is the point that it turns about."""

    session: Session
    preferences: Preferences
    messages: Messages
    pivot: Vector
    files: Files
    kept_views: KeptViews

    @property
    def camera(self) -> Camera:
        """The edited camera of the session."""
        return self.session.scene.camera

    def place(self, camera: Camera) -> None:
        """Replace the camera; consecutive moves are one step of undo."""
        self.session.edit(self.session.scene.model_copy(update={"camera": camera}), "camera")

    def _move(self, motion: Callable[..., Camera], *how: Any) -> None:
        """Move the camera by a function of `orbit`; a move that it refuses has no effect."""
        with suppress(UsageError):
            self.place(motion(self.camera, *how))

    def home(self) -> None:
        """Return to the camera that the scene was opened with, and to its pivot."""
        self.pivot = self.session.opened.scene.camera.look_at
        self.place(self.session.opened.scene.camera)

    def see_from(self, side: str) -> None:
        """See all of the scene from one of its sides; the pivot is then its middle.

        A scene of infinite planes alone is seen from as far away as now.
        """
        nearby = Ball(self.pivot, self.reach * math.sin(math.radians(self.camera.fov) / 2))
        ball = ball_of(self.session.scene) or nearby
        width, height = self.session.settings.size
        with self.messages.reporting():
            self.place(seen_from(self.camera, ball, side, width / height))
            self.pivot = ball.center

    def see_by(self, camera: Camera) -> None:
        """See by another camera, such as one of a file; the pivot is where it looks."""
        self.place(camera)
        self.pivot = camera.look_at

    @property
    def views(self) -> Views:
        """The views of this scene that were kept, by their numbers from 1."""
        return self.kept_views.of(self.files.source)

    @property
    def cameras_of_files(self) -> dict[str, Camera]:
        """The cameras of the glTF files of the scene, by the names of their nodes."""
        return cameras_of(self.session.scene)

    def keep_view(self, number: int) -> None:
        """Keep the present view of the scene under a number, in place of another one."""
        self.messages.complain(self.kept_views.keep(self.files.source, number, self.camera))
        self.messages.report(f"View {number} is kept; {label(f'alt+{number}')} comes back to it")

    def recall_view(self, number: int) -> None:
        """Go back to a view that was kept."""
        if camera := self.views.get(number):
            self.see_by(camera)
        else:
            told = f"No view {number} is kept; {label(f'ctrl+{number}')} keeps the present one"
            self.messages.report(told)

    def focus_on(self, point: Vector) -> None:
        """Focus the camera on a point; a point behind the camera is ignored."""
        depth = orbit.depth_of(self.camera, point)
        if depth > 0:
            near = max(SMALLEST, min(depth, LARGEST))
            self.place(replaced(self.camera, focus_distance=near))

    def turn_about(self, point: Vector) -> None:
        """Make a point the pivot; a point with a coordinate above LARGEST is refused."""
        if all(abs(part) <= LARGEST for part in point):
            self.pivot = point
        else:
            self.messages.complain("That point is too far away for a pivot.")

    def turn(self, across: float, down: float, about_camera: bool) -> None:
        """Turn about the camera or pivot by a drag, in shares of the window's width and height."""
        yaw = -across * self.preferences.turn_speed
        pitch = -down * self.preferences.turn_speed * (-1 if self.preferences.invert else 1)
        if about_camera:
            self._move(orbit.looked, yaw, pitch)
        else:
            self._move(orbit.orbited, self.pivot, yaw, pitch)

    def shift(self, across: float, down: float) -> None:
        """Shift by a drag, so that points as far away as the pivot roughly follow the mouse."""
        self._move(orbit.moved, -across * self.reach, down * self.reach, 0)

    def walk(self, right: float, up: float, forward: float, seconds: float) -> None:
        """Move along the camera's axes for some seconds, at the preferred speed.

        The pivot moves along: otherwise steps towards it would get shorter, and steps away longer.
        """
        step, before = seconds * self.preferences.walk_speed * self.reach, self.camera
        self._move(orbit.moved, right * step, up * step, forward * step)
        self.pivot = orbit.carried(self.pivot, before, self.camera)

    def wheel(self, clicks: float) -> None:
        """Move towards the pivot by clicks of the wheel; in fly mode, straight ahead."""
        clicks *= self.preferences.wheel_speed
        if self.preferences.mode == "orbit":
            return self._move(orbit.dollied, self.pivot, clicks)
        return self._move(orbit.moved, 0, 0, 0.1 * clicks * self.reach)

    @property
    def reach(self) -> float:
        """Distance from the camera to the pivot, in which speeds are measured; at least 1e-6."""
        return max(orbit.distance_to(self.camera, self.pivot), 1e-6)
