"""The export of the window that is under way, and what is typed for the next one."""

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from glrt.core.errors import GlrtError, UsageError
from glrt.core.files import unused
from glrt.core.text import escaped
from glrt.scene.scenefile.toml_writer import scene_with
from glrt.settings import settings_for
from glrt.view.export.clipboard import Copy
from glrt.view.export.jobs import Job
from glrt.view.export.sources import write_source
from glrt.view.export.wishes import Order, Wish, check_place, order_of
from glrt.view.file_places import folder_of, where
from glrt.view.files import Files
from glrt.view.recovery.headers import base_of

TOLD = 60.0  # seconds for which a finished export is shown
_FILM = "film.webp"


class Exports:
    """At most one export at a time, which goes on while the scene is edited."""

    def __init__(self, files: Files) -> None:
        """Begin with the size of the view; nothing runs yet."""
        self.wish = Wish()
        self.is_open = False  # whether the box is shown
        self.job: Job | None = None
        self.told = ""  # what became of the last export
        self._told_at = 0.0
        self._files, self._source = files, ""
        self._copy: Copy | None = None

    def toggle(self) -> None:
        """Show the box, or hide it; for another scene it begins with the size of the view."""
        self.is_open = not self.is_open
        if self.is_open:
            self._told_at = 0.0
            self._begin_wish()

    def _begin_wish(self) -> None:
        settings, files = self._files.session.settings, self._files
        if not self.wish.path or self._source != files.source:
            self._source = files.source
            self.wish.width, self.wish.height = map(str, settings.size)
            self.wish.samples = str(settings.samples)
            has_motion = files.session.scene.animation is not None
            self.wish.motion = "animation" if has_motion else "turntable"
            self._name_files()

    def _name_files(self) -> None:
        """Propose names that are not taken, in the folder of the scene."""
        self.wish.picture = unused(self._files.picture_name)
        self.wish.film = unused(str(folder_of(self._files.source) / _FILM))

    @property
    def problem(self) -> str:
        """The reason why the wish cannot be met; "" if it can."""
        try:
            self.order()
        except UsageError as error:
            return str(error)
        return ""

    def order(self) -> Order:
        """Return the order of the wish; UsageError names what is wrong with it."""
        session = self._files.session
        order = order_of(self.wish, session.settings)
        is_moving = self.wish.kind == "film" and self.wish.motion == "animation"
        if is_moving and session.scene.animation is None:
            raise UsageError("The scene has no animation: choose the turntable.")
        return order

    def ask_begin(self) -> None:
        """Begin the export; ask before a file is replaced. A wrong place is reported."""
        self.told = ""
        try:
            order = self.order()
            check_place(order)
        except GlrtError as error:
            self._tell(str(error))
            return
        self._files.unless_there(str(order.path), False, partial(self.begin, order))

    def begin(self, order: Order) -> None:
        """Render the present view, as it is now, in another process."""
        files, session = self._files, self._files.session
        settings = settings_for(session.settings, crop=None, denoise="none")
        scene = scene_with(session.scene, settings)
        base = self._base()
        self.job = Job(
            order, lambda folder: write_source(folder, scene, settings, base, files.rules)
        )

    def _base(self) -> Path | None:
        """Return the folder of the files of the scene; None if it has none."""
        try:
            return self._files.rules.folder or base_of(self._files.source)
        except GlrtError:
            return None

    def unless_under_way(self, act: Callable[[], object]) -> None:
        """Close the window by `act`; ask first if that would end an export."""
        if not self.job:
            act()
            return
        name = self.job.order.path.name
        text = f"{name} is being exported, which ends with the window."
        self._files.messages.ask("Close the window?", text, close=act)

    def cancel(self) -> None:
        """Give up the export that is under way."""
        if self.job:
            self.job.cancel()

    def copy_picture(self) -> None:
        """Copy the picture with its recipe to the clipboard; a failure is reported."""
        files = self._files
        if not files.session.samples:
            return files.messages.complain("There is no picture yet.")
        with files.messages.reporting():
            self._copy = Copy(files.session.image())
        return None

    def follow(self) -> None:
        """Report what has ended since the last frame."""
        if self._copy and self._copy.is_over:
            copy, self._copy = self._copy, None
            width, height = copy.size
            messages = self._files.messages
            messages.complain(copy.problem)
            if not copy.problem:
                messages.report(f"Copied the picture, {width} x {height}")
        if self.job and self.job.is_over:
            job, self.job = self.job, None
            self._tell(_told(job))
            if not (job.problem or job.is_cancelled):
                self._name_files()

    def _tell(self, text: str) -> None:
        self.told, self._told_at = escaped(text), time.perf_counter()

    def text(self, now: float) -> str:
        """Return how far the export is, or what became of it lately; "" for nothing."""
        if self.job:
            return progress_text(self.job)
        is_recent = self._told_at and now - self._told_at < TOLD and not self.is_open
        return self.told if is_recent else ""

    def end(self) -> None:
        """End the process: the window closes."""
        if self.job:
            self.job.end()


def progress_text(job: Job) -> str:
    """Return how far a job is: "film.webp: 43 %, frame 20 of 48, 12 s left"."""
    name, figures = escaped(job.order.path.name), job.figures
    if job.is_cancelled:
        return f"{name}: ends"
    if not job.share:
        return f"{name}: starts"
    parts = [f"{100 * job.share:.0f} %"]
    if "frames" in figures:
        parts.append(f"frame {figures['done'] + 1} of {figures['frames']}")
    if job.left is not None:
        parts.append(f"{job.left:.0f} s left")
    return f"{name}: {', '.join(parts)}"


def _told(job: Job) -> str:
    """Return what became of a job that is over."""
    name = job.order.path.name
    if job.problem:
        return f"{name} was not exported: {job.problem}"
    if job.is_cancelled:
        is_film = job.order.kind == "film"
        kept = f"; complete frames stay in {name}.frames for the same export" if is_film else ""
        return f"{name}: cancelled{kept}"
    saved = f"Saved {where(job.order.path)}"
    return f"{saved}. {job.note}" if job.note else saved
