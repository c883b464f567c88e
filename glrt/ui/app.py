"""What the window's parts share, and the commands that buttons and keys give."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from glrt.errors import GlrtError
from glrt.library import load_recipe
from glrt.scene import Camera, Scene, Vector
from glrt.settings import settings_for
from glrt.ui import orbit
from glrt.ui.controls import replaced
from glrt.ui.pace import Pace
from glrt.ui.picture import Picture
from glrt.ui.preferences import Preferences, save_preferences
from glrt.ui.session import Session, State


@dataclass
class App:
    """A session with its picture, and how the user wants to see it."""

    session: Session
    picture: Picture
    preferences: Preferences
    preferences_file: Path
    source: str  # what was opened: a path, or the name of a scene that comes with glrt
    pace: Pace
    pivot: Vector
    open_path: str = ""
    save_path: str = "picture.png"
    message: str = ""  # what was done last
    shown: object = None  # what the picture was drawn from
    unsaved: bool = False  # preferences

    @property
    def camera(self) -> Camera:
        """The camera as edited."""
        return self.session.scene.camera

    def edit_scene(self, gesture: str, make: Callable[[Scene], Scene]) -> None:
        """Replace the scene by what is made of it; a scene that does not fit is told."""
        try:
            self.session.edit(make(self.session.scene), gesture)
        except GlrtError as error:
            self.complain(str(error))

    def place(self, camera: Camera) -> None:
        """Put the camera somewhere else; moves in a row are one step to undo."""
        self.edit_scene("camera", lambda scene: replaced(scene, camera=camera))

    def home(self) -> None:
        """Back to the camera that the scene came with."""
        self.pivot = self.session.opened.scene.camera.look_at
        self.place(self.session.opened.scene.camera)

    def prefer(self, preferences: Preferences) -> None:
        """Take other preferences, and keep them."""
        self.preferences = preferences
        self.unsaved = True

    def keep_preferences(self) -> None:
        """Write the preferences if they changed."""
        if self.unsaved:
            self.unsaved = False
            self.complain(save_preferences(self.preferences, self.preferences_file))

    def open(self, source: str) -> None:
        """Another scene, or the scene, view and settings of a picture."""
        try:
            scene, recipe = load_recipe(source)
            settings = settings_for(recipe or scene.render, crop=None)
        except GlrtError as error:
            return self.complain(str(error))
        self.source, self.pivot = source, scene.camera.look_at
        self.session.opened = State(scene, settings)
        self.session.edit(scene, **dict(settings))
        self.message = f"Opened {source}"
        return None

    def save(self) -> None:
        """Write the picture, with its recipe, to the path in the text box."""
        if not self.session.renderer or not self.session.samples:
            return self.complain("There is no picture yet.")
        try:
            self.session.image().save(self.save_path)
        except GlrtError as error:
            return self.complain(str(error))
        self.message = f"Saved {self.save_path}"
        return None

    def complain(self, problem: str) -> None:
        """Show what went wrong, if anything did."""
        self.session.problem = problem or self.session.problem

    def draw_picture(self) -> None:
        """Bring the newest samples to the screen; without a sample the old picture stays."""
        session = self.session
        if not session.renderer or not session.samples:
            return
        settings = session.settings
        progress = session.samples, session.restarts
        content = (*progress, settings.exposure, settings.tonemap, session.weights)
        if content != self.shown:
            film = session.renderer.weighed(session.weights)
            self.picture.draw(film, settings, session.is_preview)
            self.shown = content

    def turn(self, across: float, down: float, about_camera: bool) -> None:
        """Turn by a drag, given as shares of the window's width and height."""
        yaw = -across * self.preferences.turn_speed
        pitch = -down * self.preferences.turn_speed * (-1 if self.preferences.invert else 1)
        if about_camera:
            self.place(orbit.looked(self.camera, yaw, pitch))
        else:
            self.place(orbit.orbited(self.camera, self.pivot, yaw, pitch))

    def shift(self, across: float, down: float) -> None:
        """Shift by a drag so that what is as far as the pivot follows the mouse, about."""
        self.place(orbit.moved(self.camera, -across * self.reach, down * self.reach, 0))

    def walk(self, right: float, up: float, forward: float, seconds: float) -> None:
        """Step along the camera's axes, at the speed that is preferred."""
        step = seconds * self.preferences.walk_speed * self.reach
        self.place(orbit.moved(self.camera, right * step, up * step, forward * step))

    def wheel(self, clicks: float) -> None:
        """Towards the pivot; in fly mode straight on."""
        if self.preferences.mode == "orbit":
            return self.place(orbit.dollied(self.camera, self.pivot, clicks))
        return self.place(orbit.moved(self.camera, 0, 0, 0.1 * clicks * self.reach))

    @property
    def reach(self) -> float:
        """The distance that speeds are measured in: to the pivot."""
        return max(orbit.distance_to(self.camera, self.pivot), 1e-6)
