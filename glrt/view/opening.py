"""A scene that a thread reads, with its BVH and its kernel, while the window goes on."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Thread

from glrt.core.errors import GlrtError
from glrt.core.stages import listened
from glrt.core.text import escaped
from glrt.image.sources import STANDARD_INPUT, STRICT, FileRules, load_recipe
from glrt.packing.ready_tree import build_ahead
from glrt.packing.scene_tree import SceneTree
from glrt.scene.loading.scene_files import files_of
from glrt.scene.model_scene import is_model
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import PICTURES, find
from glrt.scene.scenefile.toml import read_scene
from glrt.settings import RenderSettings
from glrt.view.edits.edited_state import State, plain
from glrt.view.kernel_notes import Driver, Note
from glrt.view.scene_compiler import Part, compile_for, note_on

Found = tuple[Scene, RenderSettings]
Finish = Callable[[Scene, RenderSettings], Found]
Later = tuple[str, FileRules, Finish]

LARGE = 100_000  # bytes of models: with the BVH they take some 0.1 s to read
BEGINNING = "reading"


def is_large(source: str) -> bool:
    """Whether a source names models of LARGE bytes or more together.

    Raises SceneError if there is no such scene, or its file is wrong.
    """
    if source == STANDARD_INPUT:
        return False
    path = find(source)
    if path.suffix.lower() in PICTURES:
        return False
    if is_model(path):
        binary = path.parent.glob("*.bin") if path.suffix.lower() == ".gltf" else ()
        files = [path, *binary]
    else:
        files = [path.parent / name for name in files_of(read_scene(path))]
    return sum(map(_size, files)) >= LARGE


def _size(file: Path) -> int:
    try:
        return file.stat().st_size
    except OSError:  # its reader says what is wrong with it
        return 0


def as_read(scene: Scene, settings: RenderSettings) -> Found:
    """Return scene and settings as they were read."""
    return scene, settings


class _EndedError(Exception):
    """Nobody waits for the scene any more."""


class Opening:
    """Reads a scene and builds its BVH in a thread; `stage` and `share` say how far it is."""

    def __init__(
        self,
        source: str,
        rules: FileRules,
        finish: Finish = as_read,
        driver: Driver | None = None,
    ) -> None:
        """`finish` changes scene and settings once they are read, on the thread.

        With a driver, another process then compiles the kernel for it, unless a note says that the
        driver has it.
        """
        self.source, self.rules = source, rules
        self.stage, self.share = BEGINNING, 0.0
        self.note: Note | None = None  # on its kernel
        self._finish, self._driver = finish, driver
        self._found: Found | None = None
        self._problem: Exception | None = None
        self._is_ended = False
        self._thread = Thread(target=self._work, daemon=True)
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether the thread has ended."""
        return not self._thread.is_alive()

    @property
    def text(self) -> str:
        """The stage in words: "reading", "tree 43 %"."""
        return f"{self.stage} {100 * self.share:.0f} %" if self.share else self.stage

    def result(self) -> Found:
        """Return scene and settings once it is over; raises what reading them has raised."""
        self._thread.join()
        if self._problem:
            raise self._problem
        assert self._found
        return self._found

    def end(self) -> None:
        """End the work at its next report: its result is no longer needed."""
        self._is_ended = True

    def _work(self) -> None:
        try:
            with listened(self._hear):
                scene, recipe = load_recipe(self.source, self.rules)
                self._hear("tree", 0.0)
                tree = build_ahead(scene, "moved")
                found = self._finish(scene, recipe or scene.render)
                if self._driver:
                    self._compile(*found, tree, self._driver)
                self._found = found
        except _EndedError:
            pass
        except (GlrtError, ValueError, OSError, MemoryError) as error:
            self._problem = error

    def _compile(
        self, scene: Scene, given: RenderSettings, tree: SceneTree | None, driver: Driver
    ) -> None:
        settings = plain(given)
        layering = "none" if driver.pipeline == "fragment" else State(scene, settings).layering
        heard = partial(self._hear, "compiling", 0.0)
        heard()
        part: Part = scene, settings, layering, driver
        try:
            self.note = note_on(part, tree)
        except GlrtError:  # the window says what is wrong, as it does after an edit
            return
        if not self.note.is_there and compile_for(part, heard):
            self.note.compiled()

    def _hear(self, stage: str, share: float) -> None:
        if self._is_ended:
            raise _EndedError
        self.stage, self.share = stage, share


class Aside:
    """The scene that a thread reads at present, if there is one."""

    def __init__(self) -> None:
        """Begin without one; `refuse` gets the problem of a scene in place of an exception."""
        self.opening: Opening | None = None
        self.refuse: Callable[[GlrtError], object] | None = None
        self.driver: Callable[[], Driver] | None = None  # to compile for, in another process
        self.note: Note | None = None  # on the kernel of the scene that was taken last

    def begin(self, source: str, rules: FileRules = STRICT, finish: Finish = as_read) -> None:
        """Let a thread read a scene, in place of the one that it reads."""
        self.end()
        self.opening = Opening(source, rules, finish, self.driver and self.driver())

    def end(self) -> None:
        """Give up the scene that a thread reads."""
        if self.opening:
            self.opening.end()
        self.opening = self.refuse = None

    def learn(self, seconds: float) -> None:
        """Note whether the driver had the kernel of the scene that was taken, by its seconds."""
        if self.note:
            self.note.learn(seconds)
        self.note = None

    @property
    def text(self) -> str:
        """Name and stage of the scene in words; "" if there is none."""
        return (
            f"{escaped(Path(self.opening.source).name)}: {self.opening.text}"
            if self.opening
            else ""
        )

    def follow(self, take: Callable[[str, Scene, RenderSettings, FileRules], None]) -> None:
        """Pass the scene to `take` once it is ready; GlrtError for a wrong one."""
        ready = self.opening
        if not ready or not ready.is_over:
            return
        refuse = self.refuse
        self.opening = self.refuse = None
        self.note = ready.note
        try:
            found = ready.result()
        except GlrtError as error:
            if not refuse:
                raise
            refuse(error)
        else:
            take(ready.source, *found, ready.rules)
