"""The state that the parts of the window share, and the commands of buttons and keys."""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from imgui_bundle import imgui

from glrt.errors import GlrtError, UsageError
from glrt.files import printable, unused
from glrt.gpu.glsl import files_anew
from glrt.image.recipe import Recipe
from glrt.image.sources import load, load_recipe, scene_file_of
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes import Shape
from glrt.scene.toml_writer import scene_with, write_scene
from glrt.scene.values import LARGEST, SMALLEST, Vector
from glrt.settings import RenderSettings, settings_for
from glrt.view.file_dialogs import Dialogs
from glrt.view.file_watch import Watch, watch_for
from glrt.view.state.controls import replaced
from glrt.view.state.edited import State
from glrt.view.state.error_history import Progress
from glrt.view.state.frame_budget import FrameBudget
from glrt.view.state.keys import Action
from glrt.view.state.preferences import Preferences, save_preferences
from glrt.view.state.session import Session
from glrt.view.viewport import orbit
from glrt.view.viewport.pick import Picked, pick
from glrt.view.viewport.picture import Picture
from glrt.view.viewport.picture_view import PictureView

Rectangle = tuple[float, float, float, float]  # left, top, width, height
SHOWN = 5.0  # seconds that a message of what was done stays in sight


@dataclass
class App:
    """A session with its picture, and how the user wants to see it."""

    session: Session
    show: PictureView
    preferences: Preferences
    preferences_file: Path
    source: str  # what was opened: a path, or the name of a scene that comes with glrt
    pace: FrameBudget
    pivot: Vector
    shaders: Watch
    open_path: str = ""
    save_path: str = field(default_factory=lambda: unused("picture.png"))
    scene_path: str = field(init=False)
    selected: int | None = None  # number of an object
    rectangle: Rectangle = (0.0, 0.0, 1.0, 1.0)  # of the picture on the screen
    frame_seconds: float = 0.0
    progress: Progress = field(default_factory=Progress)
    watch: Watch | None = field(init=False)  # of the scene file, if the scene came from one
    message: str = ""  # what was done last
    told: float = 0.0  # when, by time.perf_counter
    shown_problem: str = ""  # what went wrong, as the panel told it last
    unsaved: bool = False  # preferences
    awaited: tuple[Action, int] | None = None  # the key that is to be chosen: which of an action
    is_deaf: bool = False  # to keys, until they are let go
    dialogs: Dialogs = field(default_factory=Dialogs)

    def __post_init__(self) -> None:
        """Know what was opened."""
        self._came_from(self.source)

    @property
    def camera(self) -> Camera:
        """The camera as edited."""
        return self.session.scene.camera

    @contextmanager
    def telling(self) -> Iterator[None]:
        """Tell the user of an error, and go on."""
        try:
            yield
        except GlrtError as error:
            self.complain(str(error))

    def edit_scene(self, gesture: str, make: Callable[[Scene], Scene]) -> None:
        """Replace the scene by what is made of it; a scene that does not fit is told."""
        with self.telling():
            self.session.edit(make(self.session.scene), gesture)

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
        with self.telling():
            scene, recipe = load_recipe(source)
            self._take(scene, recipe or scene.render)
            self._came_from(source)
            self.tell(f"Opened {source}")

    def paste_recipe(self) -> None:
        """The scene, view and settings that a recipe in the clipboard tells."""
        with self.telling():
            recipe = Recipe.from_json(imgui.get_clipboard_text(), "The clipboard")
            self._take(recipe.scene, recipe.taken)
            self._came_from("")
            self.tell("Opened the recipe in the clipboard")

    def copy_recipe(self) -> None:
        """Put the recipe of the picture into the clipboard, as one line of JSON."""
        with self.telling():
            recipe = self.session.image().recipe
            assert recipe
            imgui.set_clipboard_text(recipe.to_json())
            self.tell("Copied the recipe of this picture")

    def _came_from(self, source: str) -> None:
        """A scene that came from a file is saved there again, and another one elsewhere."""
        self.source, self.watch = source, watch_for(source)
        self.scene_path = source if self.watch else unused("scene.toml")

    def _take(self, scene: Scene, settings: RenderSettings) -> None:
        self.session.opened = State(scene, settings_for(settings, crop=None))
        self.session.problem = ""
        self.session.edit(scene, **dict(self.session.opened.settings))
        self.pivot, self.selected = scene.camera.look_at, None

    def follow_files(self, now: float) -> None:
        """Take in what another program has changed: the scene file, or the shaders."""
        if self.watch and self.watch.has_changed(now):
            self.reload()
        if self.shaders.has_changed(now):
            self.reload_shaders()

    def reload_shaders(self) -> None:
        """Compile the shader files as they are now; what the driver refuses is told."""
        with self.telling(), files_anew():
            self.picture.reload_shaders()
            self.session.reload_shaders()

    def reload(self) -> None:
        """The scene as its file has it now; the camera and the settings stay."""
        with self.telling():
            scene = replaced(load(self.source), camera=self.camera)
            self.session.problem = ""
            self.session.edit(scene)
            self.tell(f"Read {self.source} again")

    def save_scene(self, path: str = "") -> None:
        """Write the scene as it is to a path, by default to the one in its text box."""
        self.scene_path = path or self.scene_path
        whole, file = scene_with(self.session.scene, self.session.settings), Path(self.scene_path)
        with self.telling():
            model = scene_file_of(self.source) if self.source else None
            has_comments = write_scene(whole, file, model)
            self.source, self.watch = str(file), watch_for(str(file))
            lost = "" if has_comments or not model else f", without the comments of {model.name}"
            self.tell(f"Saved {file}{lost}")

    @property
    def selected_shape(self) -> Shape | None:
        """The selected object, unless it is gone."""
        objects = self.session.scene.objects
        index = self.selected
        return objects[index] if index is not None and index < len(objects) else None

    def pick(self, x: float, y: float) -> Picked | None:
        """What lies under a point of the picture, from (0, 0) upper left to (1, 1)."""
        settings = self.session.settings
        return pick(self.session.scene, settings.width / settings.height, x, y)

    def frame_selected(self) -> None:
        """Look at the selected object so that it fills the frame."""
        if shape := self.selected_shape:
            with self.telling():
                reach = shape.reach if math.isfinite(shape.reach) else 1.0
                self.place(orbit.framed(self.camera, shape.middle, reach))
                self.pivot = shape.middle

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
            self.complain("That point is too far away for a pivot.")

    def save(self, path: str = "") -> None:
        """Write the picture, with its recipe, to a path, by default to the one in its text box."""
        self.save_path = path or self.save_path
        if not self.session.samples:
            return self.complain("There is no picture yet.")
        with self.telling():
            self.session.image().save(self.save_path)
            self.tell(f"Saved {self.save_path}")
        return None

    def tell(self, message: str) -> None:
        """Show for a while what was done."""
        self.message, self.told = printable(message), time.perf_counter()

    def recent_message(self, now: float) -> str:
        """What was done a moment ago; "" for nothing."""
        return self.message if now - self.told < SHOWN else ""

    def complain(self, problem: str) -> None:
        """Show what went wrong, if anything did."""
        self.session.problem = printable(problem) or self.session.problem

    @property
    def picture(self) -> Picture:
        """What is on the screen."""
        return self.show.picture

    def advance(self) -> None:
        """A frame's work: edits, samples, and what is shown of them."""
        try:
            self.show.advance(self.session, self.pace.seconds, self.preferences.samples_per_frame)
            self.show.draw(self.session)
        except GlrtError as error:  # no room for a second film, or a shader that somebody edits
            self.show.view = "picture"
            self.complain(str(error))

    def restart(self) -> None:
        """Begin the picture anew, and its figures."""
        self.session.restart()
        self.progress = Progress()

    def keep(self) -> None:
        """Keep the picture as A, to compare it with what comes."""
        with self.telling():
            self.show.keep(self.session)

    def look(self, now: float) -> None:
        """Estimate the error where that is due."""
        with self.telling():
            look = self.progress.follow(self.session, now)
            self.show.mean = look.mean if look else self.show.mean

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
        """Step along the camera's axes, at the speed that is preferred."""
        step = seconds * self.preferences.walk_speed * self.reach
        self._move(orbit.moved, right * step, up * step, forward * step)

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
