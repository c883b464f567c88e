"""How the user moves the camera, by mouse and keys."""

from collections.abc import Callable
from contextlib import suppress
from typing import Any

from glrt.core.errors import UsageError
from glrt.scene.camera import Camera
from glrt.scene.values import LARGEST, SMALLEST, Vector
from glrt.view.controls import replaced
from glrt.view.messages import Messages
from glrt.view.state.preferences import Preferences
from glrt.view.state.session import Session
from glrt.view.viewport import orbit


class CameraMoves:
    """The camera of a session, and the point that it turns about."""

    session: Session
    preferences: Preferences
    messages: Messages
    pivot: Vector

    @property
    def camera(self) -> Camera:
        """The camera as edited."""
        return self.session.scene.camera

    def place(self, camera: Camera) -> None:
        """Put the camera somewhere else; moves in a row are one step to undo."""
        self.session.edit(self.session.scene.model_copy(update={"camera": camera}), "camera")

    def _move(self, motion: Callable[..., Camera], *how: Any) -> None:
        """Move the camera as one of `orbit` does; where that ends, the camera stops."""
        with suppress(UsageError):
            self.place(motion(self.camera, *how))

    def home(self) -> None:
        """Back to the camera that the scene came with."""
        self.pivot = self.session.opened.scene.camera.look_at
        self.place(self.session.opened.scene.camera)

    def focus_on(self, point: Vector) -> None:
        """Make a point sharp; one behind the camera is left alone."""
        depth = orbit.depth_of(self.camera, point)
        if depth > 0:
            near = max(SMALLEST, min(depth, LARGEST))
            self.place(replaced(self.camera, focus_distance=near))

    def turn_about(self, point: Vector) -> None:
        """Make a point the pivot; no camera comes to one beyond all lengths."""
        if all(abs(part) <= LARGEST for part in point):
            self.pivot = point
        else:
            self.messages.complain("That point is too far away for a pivot.")

    def turn(self, across: float, down: float, about_camera: bool) -> None:
        """Turn by a drag, given as shares of the window's width and height."""
        yaw = -across * self.preferences.turn_speed
        pitch = -down * self.preferences.turn_speed * (-1 if self.preferences.invert else 1)
        if about_camera:
            self._move(orbit.looked, yaw, pitch)
        else:
            self._move(orbit.orbited, self.pivot, yaw, pitch)

    def shift(self, across: float, down: float) -> None:
        """Shift by a drag so that what is as far as the pivot follows the mouse, about."""
        self._move(orbit.moved, -across * self.reach, down * self.reach, 0)

    def walk(self, right: float, up: float, forward: float, seconds: float) -> None:
        """Step along the camera's axes, at the speed that is preferred.

        The pivot goes along: else steps towards it would get ever shorter, and those away longer.
        """
        step, before = seconds * self.preferences.walk_speed * self.reach, self.camera
        self._move(orbit.moved, right * step, up * step, forward * step)
        self.pivot = orbit.carried(self.pivot, before, self.camera)

    def wheel(self, clicks: float) -> None:
        """Towards the pivot; in fly mode straight on."""
        clicks *= self.preferences.wheel_speed
        if self.preferences.mode == "orbit":
            return self._move(orbit.dollied, self.pivot, clicks)
        return self._move(orbit.moved, 0, 0, 0.1 * clicks * self.reach)

    @property
    def reach(self) -> float:
        """The distance that speeds are measured in: to the pivot."""
        return max(orbit.distance_to(self.camera, self.pivot), 1e-6)
