"""Denoise the picture while rendering goes on, by a separate process.

It is filtered whenever its samples have doubled, and when it is complete; in between, the last
result stays. A picture that exists already has no half of its samples to judge the rest by: it is
filtered once a fifth of its samples are new.
"""

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace

import moderngl
import numpy as np

from glrt.core.text import counted
from glrt.denoise.filters import least_samples, with_filter
from glrt.error.estimate import DARK
from glrt.image.image import Image
from glrt.rendering.first_half import Halver
from glrt.settings import Denoise, Settings, settings_for
from glrt.view.state.denoise_process import DenoiseProcess
from glrt.view.state.session import Session

FEWER = 1.25  # factor from the samples of the first half to those of the first picture
NO_END = 1 << 40  # samples: without an end, halves are kept at doublings only


class DenoisedPicture:
    """The last result of a denoiser for the picture that is being rendered."""

    def __init__(self, by: Denoise = "auto") -> None:
        """`by`: the denoiser; auto: oidn if it is installed. Start nothing before it is needed."""
        self._by: Denoise = by
        self._threads = ThreadPoolExecutor(1, "denoise")
        self._halver, self._process = Halver(), DenoiseProcess()
        self._of: object = None  # the picture that its halves belong to
        self._task: Future[Image] | None = None
        self._tried = self._next = 0  # samples of the last picture to be filtered, of the next
        self.found: Image | None = None

    @property
    def is_under_way(self) -> bool:
        """Whether a picture is being filtered."""
        return self._task is not None

    def lacks(self, session: Session) -> bool:
        """Whether a picture is being filtered, or `follow` is to begin with one."""
        return self.is_under_way or self._of != _identity(session) or any(self._due(session))

    def stop(self, session: Session) -> int | None:
        """Return the samples at which a half must be kept next; None if none must be kept."""
        renderer = session.renderer
        if not renderer or session.is_passing:
            return None
        settings, samples = self._filtered(renderer.settings), renderer.samples
        if self._halver.wants(settings, samples, NO_END):
            return samples  # wait for its guides
        return self._halver.next_stop(settings, samples, NO_END)

    def follow(self, session: Session) -> bool:
        """Take a finished result, keep a half, or begin to filter; call it once a frame.

        Returns whether it read the picture from the driver, which takes as long as a frame.
        """
        if self._of != (of := _identity(session)):
            self.rest()
            self._of = of
        if self._task and self._task.done():
            self.found, self._task = self._task.result(), None
        is_kept, is_filtered = self._due(session)
        if is_kept or is_filtered:
            self._take(session, is_kept, is_filtered)
        return is_kept or is_filtered

    def fits(self, session: Session) -> bool:
        """Whether there is a denoised picture to show; not for previews or live probes."""
        return bool(self.found and self.found.denoising) and not session.is_passing

    @contextmanager
    def texture(self, gl: moderngl.Context) -> Iterator[moderngl.Texture]:
        """Yield the result as an RGBA32F texture; `a`: relative error, about each pixel."""
        assert self.found
        shown = self.found.denoised()
        radiance, height, width = shown.radiance, *shown.radiance.shape[:2]
        squares = np.square(radiance) + DARK * radiance.mean(dtype=np.float64) ** 2
        parts = np.divide(
            np.square(shown.error_map), squares, np.zeros_like(squares), where=squares > 0
        )
        error = np.sqrt(parts.mean(axis=-1))
        texture = gl.texture(
            (width, height), 4, np.dstack([radiance, error]).astype(np.float32), dtype="f4"
        )
        try:
            yield texture
        finally:
            texture.release()

    def rest(self) -> None:
        """Stop filtering, and forget all results."""
        self._process.end()
        self._halver, self._process = Halver(), DenoiseProcess()
        self._task = self.found = None
        self._of, self._tried, self._next = None, 0, 0

    def release(self) -> None:
        """End the process and the thread that waits for it."""
        self.rest()
        self._threads.shutdown(cancel_futures=True)

    def told(self, session: Session) -> str:
        """Return a notice on the denoised picture that is shown, or why none is."""
        renderer = session.renderer
        if not renderer or session.is_passing:
            return ""
        name = self._filtered(renderer.settings).denoise
        work = f"denoising {counted(self._tried, 'sample')} by {name}" if self._task else ""
        if self.found and self.found.denoising:
            known = self.found.denoising
            error = f"error {100 * known.error:.2g} %, below {100 * known.error_high:.2g} %"
            shown = f"{counted(self.found.samples, 'sample')} by {name}: {error} in 95 of 100 cases"
            return f"{shown}; {work}" if work else shown
        if work:
            return work.capitalize()
        if self.found:
            return f"The denoiser {name} ended without a picture"
        if session.is_done:
            return "Denoising compares new samples with earlier ones, and none are to come: restart"
        wanted = max(self._next, least_samples(renderer.settings.block))
        return f"Denoised from {wanted} samples on"

    def _due(self, session: Session) -> tuple[bool, bool]:
        """Whether the samples so far are to be kept as a half, and whether to be filtered."""
        renderer = session.renderer
        if not renderer or session.is_passing or session.is_behind:
            return False, False
        settings, samples = self._filtered(renderer.settings), renderer.samples
        if renderer.lacks(samples):  # guides that began late have fewer samples
            return False, False
        is_kept = self._halver.wants(settings, samples, NO_END)
        is_enough = samples >= self._next > 0 or (session.is_done and samples > self._tried)
        has_half = self._halver.has_half(samples, settings.block)
        return is_kept, is_enough and self._task is None and has_half

    def _take(self, session: Session, is_kept: bool, is_filtered: bool) -> None:
        assert session.renderer
        image = session.renderer.image_for_halves(session.weights)
        assert image.recipe
        settings, samples = self._filtered(session.renderer.settings), image.samples
        image = replace(image, recipe=image.recipe.model_copy(update={"settings": settings}))
        if is_filtered:
            self._tried, self._next = samples, 2 * samples
            self._task = self._threads.submit(self._halver.finished, image, self._process.run)
        if is_kept:
            self._halver.keep(image)
            first = max(least_samples(settings.block), int(FEWER * samples))
            self._next = self._next or first

    def _filtered(self, settings: Settings) -> Settings:
        """Return the settings with the denoiser, and with samples enough for it."""
        most = max(settings.samples, least_samples(settings.block))
        return with_filter(settings_for(settings, denoise=self._by, samples=most))


def _identity(session: Session) -> object:
    """The picture that halves belong to: a restart, with weights of layers."""
    return session.restarts, session.weights if session.renderer else ()
