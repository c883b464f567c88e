"""The picture shown while the camera moves; see glrt/rendering/history/temporal.py."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import moderngl

from glrt.core.errors import RenderError
from glrt.plan.plan import Weights
from glrt.rendering.history.lattice import FACTORS
from glrt.rendering.history.temporal import END, Mode, Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.false_colors import Number, Told
from glrt.settings import Cost, Settings, settings_for
from glrt.view.edits.edited_state import State

OWN_NUMBERS: dict[Number, Mode] = {"weight": "wrls", "mask": "ataa"}
TRANSPORT = "method", "bounces", "roulette", "sampler", "march_step"  # each has its own history
UPSAMPLED = "reconstructed at full size: one pixel in {0} x {0} is sampled"
HISTORY = "with light of earlier views, until there are {} samples"
MOST_SEED = 0xFFFFFFFF
GOLDEN = 0x9E3779B1  # from one seed to the next, far from seeds that users choose


class MovingPicture:
    """Temporal history of a session's picture; there is none if the driver has no room for it."""

    def __init__(self, gl: moderngl.Context, mode: Mode = "reset") -> None:
        """Compile and allocate nothing before it is needed."""
        self._gl = gl
        self.way = Way(mode)
        self._temporal = Temporal(gl, self.way)
        self._begun = 0

    def begin(self) -> None:
        """Count one more picture that begins during consecutive edits."""
        self._begun += 1

    def reseeded(self, state: State) -> State:
        """Return the state with a seed that no earlier view had: equal noise would not cancel.

        Once edits stop, the picture restarts with its own seed, and has the bits of mode `reset`.
        """
        seed = self._other_seed(state.settings.seed)
        return replace(state, settings=settings_for(state.settings, seed=seed))

    def alike(self, wanted: State, given: Settings, seed: int) -> State:
        """Return `wanted` in the size of `given`, and with its seed if that derives from `seed`."""
        sized = wanted.sized(*given.size)
        if given.seed not in (seed, self._other_seed(seed)):
            return sized
        return replace(sized, settings=settings_for(sized.settings, seed=given.seed))

    def _other_seed(self, seed: int) -> int:
        is_needed = self.way.mode != "reset"
        return (seed + self._begun * GOLDEN) & MOST_SEED if is_needed else seed

    def use(self, way: Way) -> None:
        """Change the way of using history, and drop the history so far."""
        if way != self.way:
            self._temporal.release()
            self._temporal, self.way = Temporal(self._gl, way), way

    def leave(self, renderer: Renderer, weights: Weights, wanted: Settings) -> str:
        """Keep what is shown as history before an edit; returns a refusal of the driver, or "".

        Light that other settings transport is dropped: it would be in the picture for END samples.
        """
        if any(getattr(renderer.settings, name) != getattr(wanted, name) for name in TRANSPORT):
            self.forget()
            return ""
        try:
            self._temporal.leave(renderer, weights)
        except RenderError as error:
            return self._left_out(error)
        return ""

    def prepare(self, renderer: Renderer, weights: Weights, at_once: bool = True) -> str:
        """Prepare history while nothing moves, so that no edit waits; returns a refusal, or ""."""
        try:
            self._temporal.prepare(renderer, weights, at_once)
        except RenderError as error:
            return self._left_out(error)
        return ""

    def arrive(self, renderer: Renderer, cost: Cost | None) -> str:
        """Bring history to the view after an edit of `cost`; returns a refusal, or ""."""
        if cost is Cost.RELIGHT:
            self._temporal.forget()
        if cost not in (Cost.RESTART, Cost.RECOMPILE):
            return ""
        try:
            self._temporal.arrive(renderer)
        except RenderError as error:
            return self._left_out(error)
        return ""

    def _left_out(self, error: RenderError) -> str:
        self._temporal.release()
        self._temporal = Temporal(self._gl, Way("reset"))
        return f"{error} History of earlier views is left out (temporal reset)."

    def can_upsample(self, renderer: Renderer) -> bool:
        """Whether coarse pictures of the renderer's view are reconstructed at full size."""
        return self._temporal.can_upsample(renderer)

    def upsample(self, renderer: Renderer, factor: int, sampled: Callable[[], None]) -> None:
        """Sample one pixel in factor^2 of the view, call `sampled`, and make the picture.

        Raises RenderError as `texture` does.
        """
        with self._left_out_if_refused():
            self._temporal.upsample(renderer, factor, sampled)

    def is_coarse(self, renderer: Renderer | None) -> bool:
        """Whether the view is shown by a picture that is reconstructed from some of its pixels."""
        return renderer is not None and self._temporal.coarse(renderer) is not None

    def goes_finer(self, renderer: Renderer) -> bool:
        """Whether there is such a picture, and the film does not yet follow as the next step."""
        return self.is_coarse(renderer) and self.progress[1] > FACTORS[0]

    @property
    def progress(self) -> tuple[int, int]:
        """Coarse pictures of the view, and the distance of sampled pixels that they have reached.

        (0, 0) without one.
        """
        found = self._temporal.upsampled
        return (found.frames, found.step) if found else (0, 0)

    @property
    def factor(self) -> int:
        """Distance of the pixels that the last coarse picture sampled; the usual one without."""
        found = self._temporal.upsampled
        return found.last_factor if found else FACTORS[-1]

    def forget(self) -> None:
        """Drop the history; the picture is shown without it from now on."""
        self._temporal.forget()

    def is_shown(self, renderer: Renderer | None, wanted: int) -> bool:
        """Whether history is shown: not once the film has END samples, or all `wanted` ones."""
        self._temporal.end = float(min(END, wanted))
        return renderer is not None and self._temporal.is_shown(renderer)

    def notice(self, renderer: Renderer, settings: Settings) -> str:
        """Light in the picture that is not of its film, as a line of text; "" for none."""
        if self.is_coarse(renderer):
            return UPSAMPLED.format(self.progress[1])
        return HISTORY.format(self.end) if self.is_shown(renderer, settings.samples) else ""

    def reports(self, renderer: Renderer | None, wanted: int, number: Number) -> bool:
        """Whether a number of the history, such as the weight of new samples, can be shown."""
        is_one = number == "history" or self.way.mode == OWN_NUMBERS[number]
        return is_one and self.is_shown(renderer, wanted)

    def told(self, renderer: Renderer, weights: Weights, number: Number) -> Told | None:
        """Return a number of the history, valid until the next call; raises as `texture`."""
        with self._left_out_if_refused():
            return self._temporal.told(renderer, number, weights)

    @property
    def end(self) -> int:
        """Number of samples from which on the film is shown without history."""
        return int(self._temporal.end)

    def texture(self, renderer: Renderer, weights: Weights) -> moderngl.Texture | None:
        """Return film and history combined, valid until the next call; None: show the film alone.

        Raises RenderError if the driver has no room: from then on there is no history.
        """
        with self._left_out_if_refused():
            return self._temporal.show(renderer, weights)

    @contextmanager
    def _left_out_if_refused(self) -> Iterator[None]:
        try:
            yield
        except RenderError as error:
            raise RenderError(self._left_out(error)) from error

    def release(self) -> None:
        """Release all OpenGL objects."""
        self._temporal.release()
