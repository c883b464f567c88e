"""Open and save scenes, models, pictures and recipes in the window."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from imgui_bundle import imgui

from glrt.core.errors import GlrtError
from glrt.core.files import unused
from glrt.core.text import escaped
from glrt.image.recipe import Recipe
from glrt.image.sources import STRICT, FileRules, load_recipe, scene_file_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import MODELS
from glrt.scene.scenefile.toml_writer import scene_with, write_scene
from glrt.settings import RenderSettings
from glrt.view.edits.edited_state import State, plain
from glrt.view.edits.file_camera import seen_as_before, to_be_saved
from glrt.view.edits.keyframes import rested
from glrt.view.edits.sky_images import is_sky, with_sky_image
from glrt.view.edits.unsaved import is_edited, is_other
from glrt.view.file_dialogs import SCENE, SCENES, Dialogs
from glrt.view.file_places import folder_of, where
from glrt.view.file_watch import Watch, watch_for
from glrt.view.messages import Messages, Then, nothing
from glrt.view.opening import Aside, is_large
from glrt.view.picture_files import PictureFiles
from glrt.view.state.recent import load_recent, save_recent, with_opened
from glrt.view.state.session import Session

PICTURE_NAME = "picture.png"


@dataclass
class Files(PictureFiles):
    """Opens and saves scenes and pictures; replaces no file without asking."""

    session: Session
    messages: Messages
    source: str  # what was opened: a path, or the name of a scene that comes with glrt
    recent_file: Path
    show: Callable[[Scene], None]  # called with a scene that was opened
    add: Callable[[Path], None]  # adds a model to the scene
    rules: FileRules = STRICT  # of the user, for the files of the scene that is open
    open_path: str = ""
    picture_path: str = field(default_factory=lambda: unused(PICTURE_NAME))
    picture_name: str = PICTURE_NAME  # name that numbers are appended to
    scene_path: str = field(init=False)
    watch: Watch | None = field(init=False)  # of the scene file, if the scene came from one
    model: Path | None = field(init=False)  # the scene file whose comments a save keeps
    saved: Scene = field(init=False)  # scene as in its file, or as it was opened
    written: Scene = field(init=False)  # `saved` with its camera and settings
    recent: tuple[str, ...] = field(init=False)
    dialogs: Dialogs = field(default_factory=Dialogs)
    aside: Aside = field(default_factory=Aside)  # what is read while this scene stays

    def __post_init__(self) -> None:
        """Load the recent files, and remember where the scene came from."""
        self.recent = load_recent(self.recent_file)
        self._came_from(self.source)

    @property
    def is_changed(self) -> bool:
        """Whether the scene has unsaved edits; changed camera or settings do not count."""
        return self.is_lost or is_edited(self.saved, self._rested)

    @property
    def is_other(self) -> bool:
        """Whether a save would change the file: camera and settings count, too."""
        return self.is_lost or is_other(self.written, self._rested, self.session.settings)

    @property
    def _rested(self) -> Scene:
        """The scene as a save writes it, whatever frame of its animation is shown."""
        return rested(self.session.scene, self.saved)

    @property
    def is_lost(self) -> bool:
        """Whether the file of the scene no longer exists."""
        return self.watch is not None and self.watch.has_lost

    @property
    def title(self) -> str:
        """Title of the window: what is open, with a star if the scene differs from its file."""
        name = Path(self.source).name if self.source else "recipe"
        return f"{escaped(name)}{' *' if self.is_other else ''} - glrt"

    def open(self, source: str) -> None:
        """Open a scene, or that of a picture with its view; a thread reads large ones."""
        self.aside.end()
        with self.messages.reporting():
            if is_large(source):
                return self.aside.begin(source)
            scene, recipe = load_recipe(source)
            self._opened(source, scene, recipe or scene.render)
        return None

    def _opened(
        self, source: str, scene: Scene, settings: RenderSettings, rules: FileRules = STRICT
    ) -> None:
        self._take(scene, settings)
        self.rules = rules
        self._came_from(source)
        self.messages.report(f"Opened {source}")

    def ask_open(self, source: str) -> None:
        """Open a file; ask first if that would lose edits. An image of radiance is a background."""
        with self.messages.reporting():
            if is_sky(Path(source)):
                return self.use_as_background(source)
        return self._unless_lost(f"Open {Path(source).name}?", lambda: self.open(source))

    def drop(self, path: str) -> None:
        """Open a file dropped on the window; of a model, ask whether to add it to the scene."""
        if Path(path).suffix.lower() not in MODELS:
            return self.ask_open(path)
        self.messages.ask(
            f"Open {Path(path).name}?",
            "Add the model to this scene, or open it as a scene of its own?",
            add=partial(self.add, Path(path)),
            open=lambda: self.ask_open(path),
        )
        return None

    def use_as_background(self, path: str) -> None:
        """Make an image of all directions the background of the scene."""
        with self.messages.reporting():
            self.session.edit(with_sky_image(self.session.scene, Path(path)))
            name = escaped(Path(path).name)
            self.messages.report(
                f"{name} is the background; objects and lamps stay; undo takes it away"
            )

    def browse_open(self) -> None:
        """Show a dialog to choose a file to open."""
        title = "Open a scene, a model or a picture"
        self.dialogs.ask_open(title, SCENES, self.ask_open)

    def ask_paste(self) -> None:
        """Open the recipe in the clipboard; ask first if that would lose edits."""
        self._unless_lost("Paste the recipe?", self.paste_recipe)

    def paste_recipe(self) -> None:
        """Open the scene, view and settings of the recipe in the clipboard."""
        with self.messages.reporting():
            recipe = Recipe.from_json(imgui.get_clipboard_text(), "The clipboard")
            self._take(recipe.scene, recipe.taken)
            self._came_from("")
            self.messages.report("Opened the recipe in the clipboard")

    def copy_recipe(self) -> None:
        """Copy the recipe of the picture to the clipboard, as one line of JSON."""
        with self.messages.reporting():
            recipe = self.session.image().recipe
            assert recipe
            imgui.set_clipboard_text(recipe.to_json())
            self.messages.report("Copied the recipe of this picture")

    def _came_from(self, source: str) -> None:
        """Remember the source; a scene from a scene file is saved there, others to a new file."""
        self.source, self.watch = source, watch_for(source)
        self.model = scene_file_of(source) if source else None
        self.scene_path = source if self.watch else unused("scene.toml")
        self.picture_name = str(folder_of(source) / PICTURE_NAME)
        self.picture_path = unused(self.picture_name)
        self._mark_saved(self.session.scene)
        self._remember(source)

    def _mark_saved(self, scene: Scene) -> None:
        """Remember that a file holds the scene, and the settings as they are now."""
        self.saved = scene
        self.written = scene_with(self.saved, self.session.settings)

    def _remember(self, source: str) -> None:
        recent = with_opened(self.recent, source) if source else self.recent
        if recent != self.recent:
            self.recent = recent
            self.messages.complain(save_recent(recent, self.recent_file))

    def _take(self, scene: Scene, settings: RenderSettings) -> None:
        self.session.problem = ""
        self.session.open(State(scene, plain(settings)))
        self.show(scene)

    def follow(self, now: float) -> None:
        """Take the scene that a thread has read; reload a file that another program has changed."""
        self.follow_picture()
        with self.messages.reporting():
            self.aside.follow(self._opened)
        if self.aside.note and self.session.renderer and not self.session.is_behind:
            self.aside.learn(self.session.taken)
        if not (self.watch and self.watch.has_changed(now)):
            return
        if self.is_lost:
            self.messages.complain(
                f"The file {self.source} is no longer there. The scene stays open; save it to "
                "write the file again."
            )
        else:
            self.reload()

    def reload(self) -> None:
        """Read the scene file again; the camera and the settings stay."""
        with self.messages.reporting():
            had_edits = is_edited(self.saved, self._rested)
            found, _ = load_recipe(self.source, self.rules._replace(variant=None))
            lost = "; undo brings your edits back" * had_edits
            self.session.problem = ""
            self.session.edit(seen_as_before(found, self.session.scene.camera))
            self.saved, self.written = found, scene_with(found, self.session.settings)
            self.messages.report(f"Read {self.source} again{lost}")

    def save_scene(self, path: str = "") -> bool:
        """Save the scene to a path, by default that of the text box; returns whether it worked."""
        self.scene_path = path or self.scene_path
        scene = to_be_saved(self._rested, self.session.opened.scene.camera)
        whole, file = scene_with(scene, self.session.settings), Path(self.scene_path)
        try:
            model = None if self.is_lost else self.model
            has_comments = write_scene(whole, file, model)
        except GlrtError as error:
            self.messages.complain(str(error))
            return False
        if self.is_lost:
            self.session.problem = ""
        self.source, self.watch, self.model = str(file), watch_for(str(file)), file
        self._mark_saved(self._rested)
        self._remember(self.source)
        lost = "" if has_comments or not model else f", without the comments of {model.name}"
        self.messages.report(f"Saved {where(file)}{lost}")
        return True

    def save_again(self, then: Then = nothing) -> None:
        """Save the scene to its own file, or ask for a name if it has none; then call `then`."""
        if self.watch:
            if self.save_scene(self.source):
                then()
        else:
            self.browse_scene(then)

    def browse_scene(self, then: Then = nothing) -> None:
        """Show a dialog to choose where the scene is saved; then call `then`."""

        def use(path: str, is_agreed: bool) -> None:
            self.ask_save_scene(path, is_agreed, then)

        self.dialogs.ask_save("Save the scene", self.scene_path, SCENE, ".toml", use)

    def ask_save_scene(self, path: str, is_agreed: bool = False, then: Then = nothing) -> None:
        """Save the scene under a name; ask before a file other than its own is replaced."""
        is_own = bool(self.watch) and Path(path).absolute() == Path(self.source).absolute()
        self.unless_there(path, is_own or is_agreed, lambda: self.save_scene(path) and then())

    def close(self, leave: Then) -> None:
        """Close the window by `leave`; ask first if that would lose edits."""
        self._unless_lost("Close the window?", leave)

    def _unless_lost(self, title: str, act: Then) -> None:
        if not self.is_changed:
            act()
            return
        name = Path(self.source).name if self.source else "The scene"
        self.messages.ask(
            title,
            f"{name} has changes that are not saved.",
            save=lambda: self.save_again(act),
            do_not_save=act,
        )
