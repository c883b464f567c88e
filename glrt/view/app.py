"""The state that the parts of the window share, and the commands of buttons and keys."""

import time
from collections.abc import Callable
from dataclasses import InitVar, dataclass, field
from functools import partial
from pathlib import Path
from typing import Literal

from glrt.core.errors import GlrtError
from glrt.gpu.glsl import files_reread
from glrt.image.sources import STRICT, FileRules
from glrt.process.load import LoadMeter
from glrt.rendering.history.temporal import Way
from glrt.scene.scene import Scene
from glrt.scene.values import Vector
from glrt.view.compared_picture import Pair
from glrt.view.edits.scene_edits import found_again
from glrt.view.edits.texture_images import is_texture
from glrt.view.export.exports import Exports
from glrt.view.file_watch import Watch
from glrt.view.files import Files
from glrt.view.kept_views import KeptViews
from glrt.view.messages import Messages, Question, nothing
from glrt.view.selection import Selection
from glrt.view.state.error_history import Progress
from glrt.view.state.frame_budget import FrameBudget
from glrt.view.state.keys import Action
from glrt.view.state.path_explorer import PathExplorer
from glrt.view.state.preferences import Preferences, save_preferences
from glrt.view.state.session import Session
from glrt.view.state.zoom import FIT, Rectangle, Zoom
from glrt.view.timeline import Timeline
from glrt.view.viewport.black import Blackness
from glrt.view.viewport.picture import Picture
from glrt.view.viewport.picture_view import PictureView
from glrt.view.viewport.silhouette import Silhouette

FIRST = "cornell"  # the scene that a start without a scene may continue with
MOST_STOPS = 8.0  # exposure values that keys reach, as the slider does


@dataclass
class App(Selection):
    """State of the window: a session, its picture, files, messages and preferences."""

    session: Session
    show: PictureView
    preferences: Preferences
    preferences_file: Path
    messages: Messages
    files: Files = field(init=False)
    exports: Exports = field(init=False)
    source: InitVar[str]  # what was opened: a path, or the name of a scene that comes with glrt
    pace: FrameBudget
    pivot: Vector
    shaders: Watch
    rules: InitVar[FileRules] = STRICT  # for the files of what was opened
    selected: int | None = None  # number of the selected object
    is_to_be_seen: bool = False  # whether the panel is to scroll to the selected object
    pair: Pair = field(init=False)
    asked: Question | None = None  # the question on the screen
    leave: Callable[[], object] = nothing  # closes the window
    fill_screen: Callable[[], object] = nothing  # enters the full screen, or leaves it
    rectangle: Rectangle = (0.0, 0.0, 1.0, 1.0)  # of the picture on the screen, in pixels
    zoom: Zoom = FIT
    kept_views: KeptViews = field(init=False)
    dropped: Path | None = None  # image that waits for the frame that knows where the mouse is
    inspects: bool = False  # whether the values of the pixel under the mouse are shown
    handles: Literal["move", "turn"] = "move"  # what those of the selected object do
    is_picture_alone: bool = False  # whether the panels are hidden
    shows_keys: bool = False  # whether all keys are shown over the window
    shows_palette: bool = False  # whether words find controls and commands
    shows_start: bool = False  # whether scenes to open are shown in place of the picture
    paths: PathExplorer = field(init=False)
    timeline: Timeline = field(init=False)
    silhouette: Silhouette = field(init=False)  # of the selected meshes
    tour_step: int | None = 0  # step on the screen; None: closed until the next start
    tour_beside: tuple[float, float] = (0.0, 0.0)  # window size when the tour was placed
    outside: tuple[float, float] = (35.0, 25.0)  # degrees, of the view of paths from outside
    frame_seconds: float = 0.0
    sampling_seconds: float = 0.0  # of the last frame: for edits and samples
    load: LoadMeter = field(init=False)
    progress: Progress = field(default_factory=partial(Progress, in_thread=True))
    blackness: Blackness = field(default_factory=Blackness)
    unsaved: bool = False  # whether preferences must be written
    awaited: tuple[Action, int] | None = None  # action and index of the key that is being chosen
    is_deaf: bool = False  # whether keys are ignored until they are released
    navigates: bool = False  # whether keys move in the panel
    has_list_keys: bool = False  # whether arrow keys move in the list of what the scene holds
    was_busy: bool = False  # whether a widget had the keys a frame ago

    def __post_init__(self, source: str, rules: FileRules) -> None:
        """Create the parts that depend on the session and on the opened source."""
        self.load = LoadMeter(self.session.context.renderer)
        self.paths = PathExplorer(self.session.context)
        self.timeline = Timeline(self.session)
        self.silhouette = Silhouette(self.session.context.gl)
        self.pair = Pair(self.session, self.show, self.restart)
        recent = self.preferences_file.with_name("recent.json")
        self.kept_views = KeptViews(recent.with_name("views.json"))
        self.files = Files(
            self.session, self.messages, source, recent, self.show_scene, self.add_model, rules
        )
        self.files.is_compared = lambda: self.pair.picture is not None
        self.exports = Exports(self.files)

    def prefer(self, preferences: Preferences) -> None:
        """Replace the preferences; `keep_preferences` writes them."""
        self.preferences = preferences
        self.unsaved = True

    def keep_preferences(self) -> None:
        """Write the preferences to their file if they changed; a failure is reported."""
        if self.unsaved:
            self.unsaved = False
            self.messages.complain(save_preferences(self.preferences, self.preferences_file))

    def show_scene(self, scene: Scene) -> None:
        """Reset the pivot and the selection for a scene that was opened."""
        self.pivot, self.selected = scene.camera.look_at, None
        self.timeline.begin()
        if self.shows_start and not self.session.renderer:
            self.session.history.forget()  # the scene before was never seen
        self.shows_start = False

    def drop(self, path: str) -> None:
        """Take a file that was dropped on the window; an image goes to what is under the mouse."""
        if not self.shows_start and is_texture(Path(path)):
            self.dropped = Path(path)
        else:
            self.files.drop(path)

    def follow_files(self, now: float) -> None:
        """Reload the scene file or the shaders if another program has changed them.

        Report what other processes have finished.
        """
        self.files.follow(now)
        self.exports.follow()
        if self.shaders.has_changed(now):
            self.reload_shaders()

    def reload_shaders(self) -> None:
        """Compile the shader files as they are now; errors are reported, not raised."""
        with self.messages.reporting(), files_reread():
            self.picture.reload_shaders()
            self.session.reload_shaders()

    def zoom_to(self, scale: float | None) -> None:
        """Zoom to a number of screen pixels per picture pixel; None shows the whole picture."""
        self.zoom = self.zoom.to(scale) if scale else FIT

    def inspect(self) -> None:
        """Show or hide the values of the pixel under the mouse."""
        self.inspects = not self.inspects

    def expose(self, stops: float) -> None:
        """Show the picture brighter, or darker below 0, within the range of the slider."""
        exposure = self.session.settings.exposure + stops
        if abs(exposure) <= MOST_STOPS:
            self.session.edit(None, "exposure", exposure=exposure)

    def toggle_handles(self) -> None:
        """Let the handles of the selected object turn it, or move it again."""
        self.handles = "turn" if self.handles == "move" else "move"

    def toggle_panels(self) -> None:
        """Hide the panels so that the picture has the whole window, or show them again."""
        self.is_picture_alone = not self.is_picture_alone

    def toggle_keys(self) -> None:
        """Show or hide all keys."""
        self.shows_keys = not self.shows_keys

    def toggle_palette(self) -> None:
        """Open or close the box that finds controls and commands."""
        self.shows_palette = not self.shows_palette

    def escape(self) -> None:
        """Close what lies over the window, give up a scene that is read, or leave the paths."""
        if self.shows_keys:
            self.shows_keys = False
        elif self.exports.is_open:
            self.exports.is_open = False
        elif self.files.aside.opening:
            self.files.aside.end()
        elif self.shows_start:
            self.toggle_start()
        else:
            self.end_paths()

    def toggle_start(self) -> None:
        """Show scenes to open in place of the picture, or the scene that is open, else FIRST."""
        if self.shows_start and not self.files.source:
            self.files.open(FIRST)
        else:
            self.shows_start = not self.shows_start

    def choose_paths(self) -> None:
        """Let clicks choose a pixel for its paths, or let them select objects again."""
        self.paths.is_choosing = not self.paths.is_choosing

    def end_paths(self) -> None:
        """Let clicks select objects again; if they already do, hide the paths."""
        if self.paths.is_choosing:
            self.paths.is_choosing = False
        else:
            self.paths.forget()

    def ask_paths(self, x: float, y: float) -> None:
        """Request the paths of the pixel at a place of the picture, from (0, 0) to (1, 1)."""
        session = self.session
        if 0 <= x < 1 and 0 <= y < 1:
            pixel = int(x * session.settings.width), int(y * session.settings.height)
            self.paths.ask(session.scene, session.settings, pixel, session.samples)

    def pause(self) -> None:
        """Pause or resume rendering."""
        self.session.paused = not self.session.paused

    def undo(self) -> None:
        """Undo the last gesture; the selection stays, or moves to an object that comes back."""
        self._step(self.session.undo, self.session.undoes or "There is nothing more to undo")

    def redo(self) -> None:
        """Redo the gesture that was undone last."""
        self._step(self.session.redo, self.session.redoes or "There is nothing more to redo")

    def _step(self, step: Callable[[], None], told: str) -> None:
        before = self.session.scene.objects
        step()
        self.timeline.show(self.timeline.frame)
        self.messages.report(told)
        self.selected = found_again(before, self.session.scene.objects, self.selected)

    @property
    def picture(self) -> Picture:
        """Picture that is on the screen."""
        return self.show.picture

    def advance(self) -> None:
        """Do the work of a frame: apply edits, render samples, and draw them."""
        if self.shows_start:
            return
        try:
            chosen = self.preferences
            self.session.moving.use(Way(chosen.temporal, chosen.predictor))
            start = time.perf_counter()
            self.timeline.follow(start)
            self.show.holds = self.pair.advance(self.pace.seconds, chosen.samples_per_frame)
            self.show.advance(self.session, self.pace.seconds, chosen.samples_per_frame)
            self.sampling_seconds = time.perf_counter() - start
            self.show.draw(self.session)
            if self.show.drawn == "picture":
                self.blackness.look(self.session, self.picture)
            self.paths.advance()
        except GlrtError as error:  # no room for a second film, or a shader with an error
            self.show.view = "picture"
            self.messages.complain(str(error))

    def release(self) -> None:
        """End other processes and threads, and release OpenGL: the window closes."""
        self.exports.end()
        self.files.finish_picture()
        self.pair.go_on(False)
        for part in (self.show, self.paths, self.silhouette):
            part.release()
        self.files.dialogs.close()
        self.session.release()

    def restart(self) -> None:
        """Restart the picture and its figures."""
        self.session.restart()
        self.progress = Progress(in_thread=True)

    def keep(self) -> None:
        """Keep the picture as A, to compare it with later ones."""
        was_rendered = self.pair.slot is not None
        self.pair.go_on(False)
        with self.messages.reporting():
            self.show.keep(self.session)
            if was_rendered:
                self.messages.report("A is this picture now, and is not rendered further")

    def look(self, now: float) -> None:
        """Estimate the errors of A and B where that is due."""
        with self.messages.reporting():
            self.pair.look(now)
            look = self.progress.follow(self.session, now)
            self.show.mean = look.mean if look else self.show.mean
