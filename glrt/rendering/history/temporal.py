"""The screen while the camera moves: a film that begins again at each view, and history.

`Temporal` follows a renderer from view to view and holds what all modes share: the G-buffers of
this view and of the previous one. A mode is a `Resolver`: it makes the picture, and the history
from which the next view begins. No mode ever writes to the film.

    temporal.leave(renderer, weights)   # before an edit: what is shown becomes history
    renderer.update(...)                # the film is empty
    temporal.arrive(renderer)           # surfaces of the new view; history is brought to it
    renderer.advance(...)
    texture = temporal.show(renderer, weights)   # None: the film alone is to be shown
"""

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

import moderngl

from glrt.core.errors import RenderError
from glrt.plan.plan import Weights, are_trivial
from glrt.rendering.history.ataa import SAMPLES, Ataa
from glrt.rendering.history.gbuffer import SurfacePass, Surfaces
from glrt.rendering.history.history_filter import Fresh, Resolver
from glrt.rendering.history.lattice import FACTORS
from glrt.rendering.history.reproject import Reproject
from glrt.rendering.history.reprojection import shares_objects
from glrt.rendering.history.taa import Taa
from glrt.rendering.history.upsample import FACTOR, Upsample
from glrt.rendering.history.wrls import Predictor, Wrls
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.false_colors import Number, Told

Mode = Literal["reset", "reproject", "taa", "ataa", "wrls", "upsample"]

END = 64.0  # samples of a film from which on no history is shown


class Way(NamedTuple):
    """A temporal mode and its options."""

    mode: Mode = "reproject"
    predictor: Predictor = "published"  # option of wrls
    traced: int = SAMPLES  # option of ataa: additional samples of a pixel where history fails
    factor: int = FACTOR  # option of upsample: pixels between sampled ones, in width and height

    @property
    def name(self) -> str:
        """The mode with options that differ from the defaults, for tables and charts."""
        if self.mode == "wrls" and self.predictor != "published":
            return f"{self.mode} {self.predictor}"
        if self.mode == "ataa" and self.traced != SAMPLES:
            return f"{self.mode} {self.traced}"
        if self.mode == "upsample" and self.factor != FACTOR:
            return f"{self.mode} {self.factor}"
        return self.mode


USUAL_WAY = Way()
_ALL = [Way(mode, predictor) for mode in get_args(Mode) for predictor in get_args(Predictor)]
_ALL += [Way("upsample", factor=factor) for factor in FACTORS]
WAYS = {way.name: way for way in reversed(_ALL)}  # a name alone: the published predictor


def resolver_of(gl: moderngl.Context, way: Way) -> Resolver | None:
    """The resolver of a mode; None for `reset`, which shows the film alone."""
    match way.mode:
        case "reset":
            return None
        case "reproject":
            return Reproject(gl)
        case "taa":
            return Taa(gl)
        case "ataa":
            return Ataa(gl, way.traced)
        case "wrls":
            return Wrls(gl, way.predictor)
        case "upsample":
            return Upsample(gl, way.factor)


class Temporal:
    """Follows a renderer from view to view; the mode `reset` shows its film alone, at no cost."""

    def __init__(self, gl: moderngl.Context, way: Way = USUAL_WAY) -> None:
        """Nothing is compiled or allocated before it is needed."""
        self.end = END  # samples of the film from which on it is shown alone
        self._gl = gl
        self._surfaces = [Surfaces(gl), Surfaces(gl)]  # of this view, and of the previous one
        self._pass = SurfacePass(gl)
        self._resolver = resolver_of(gl, way)
        self._unprepared = [False, True]  # views that are to be rehearsed: with history first
        self._is_kept = False  # whether there is a history to begin from
        self._is_brought = False  # whether the view has one
        self._resolved_at: tuple[int, Weights | None] | None = None  # samples of the view

    @property
    def surfaces(self) -> Surfaces:
        """The G-buffer of this view."""
        return self._surfaces[0]

    def leave(self, renderer: Renderer, weights: Weights | None = None) -> None:
        """Make what is shown the history; call it before an edit restarts the film."""
        if self.coarse(renderer):
            self._is_kept = True
        if self._resolver and renderer.samples and not self.surfaces.scene:
            self._find(renderer)  # the first view of all
        if self._resolver and renderer.samples:
            if self._resolved_at != (renderer.samples, weights):
                self._resolved(self._resolver, renderer, weights)
            self._is_kept = True

    def prepare(
        self, renderer: Renderer, weights: Weights | None = None, at_once: bool = True
    ) -> None:
        """Find, compile and allocate what the next edit would wait for; nothing of it is shown.

        If not `at_once`, that takes three calls: the first finds the surfaces of the view.
        """
        if not self._resolver or not renderer.samples:
            return
        is_found = self.surfaces.scene is not None
        if not is_found:
            self._find(renderer)
        while self._unprepared and (is_found or at_once):
            self._rehearse(self._resolver, renderer, weights, self._unprepared.pop())
            is_found = False

    def _rehearse(
        self, resolver: Resolver, renderer: Renderer, weights: Weights | None, has_history: bool
    ) -> None:
        """Run all passes of a view; with history, that is the picture of the same view."""
        if has_history:
            self.leave(renderer, weights)
        with self._gl:
            resolver.arrive(self.surfaces, self.surfaces if has_history else None, True)
            resolver.show(self.surfaces, self._fresh(renderer, weights, END))
            if not has_history and self.upsampled and self.can_upsample(renderer):
                self.upsampled.trace(renderer, self.surfaces)
        self.forget()

    def arrive(self, renderer: Renderer) -> None:
        """Begin the view that a renderer shows now; its film has no sample yet.

        Without history to bring, its surfaces are found once they are needed.
        """
        if not self._resolver:
            return
        self._check(renderer)
        self._surfaces.reverse()
        self._resolved_at = None
        now, before = self._surfaces
        is_usable = self._is_kept and before.scene and shares_objects(renderer.scene, before.scene)
        if is_usable:
            self._find(renderer)
        else:
            now.leave()
        is_same_light = bool(before.scene and is_lit_alike(renderer, before))
        self._is_brought = bool(is_usable)
        if self._is_brought:
            self._unprepared.clear()
        with self._gl:
            self._resolver.arrive(now, before if is_usable else None, is_same_light)

    def show(self, renderer: Renderer, weights: Weights | None = None) -> moderngl.Texture | None:
        """The picture of film and history, valid until the next call; None: the film alone."""
        if not self._resolver or not self.is_shown(renderer):
            return None
        if coarse := self.coarse(renderer):
            return coarse
        return self._resolved(self._resolver, renderer, weights)

    def can_upsample(self, renderer: Renderer) -> bool:
        """Whether coarse pictures of what a renderer shows can be reconstructed.

        The picture must be the kernel's sum of paths: without particles, probes, and relit layers.
        """
        is_plain = is_whole(renderer, renderer.plan.weights) and not renderer.probes.tracer
        return isinstance(self._resolver, Upsample) and is_plain

    def upsample(
        self,
        renderer: Renderer,
        factor: int | None = None,
        sampled: Callable[[], None] = lambda: None,
    ) -> moderngl.Texture:
        """Sample one pixel in factor^2 of the view, and reconstruct the picture at full size.

        For a renderer without samples in this view, if `can_upsample`. The factor is of FACTORS
        (default: that of the way); `sampled` is called before the picture is made. RenderError for
        fragment shaders.
        """
        resolver = self._resolver
        assert isinstance(resolver, Upsample)
        if self.surfaces.scene is not renderer.scene:
            self._find(renderer)  # the first view of all
        with self._gl:
            found = resolver.trace(renderer, self.surfaces, factor, sampled)
        self._is_brought = True
        self._unprepared.clear()
        return found

    def coarse(self, renderer: Renderer) -> moderngl.Texture | None:
        """The reconstructed picture, while the film of the view has no sample; else None."""
        return self.upsampled.coarse if self.upsampled and not renderer.samples else None

    @property
    def upsampled(self) -> Upsample | None:
        """The progress of coarse pictures of this view; None in other modes."""
        return self._resolver if isinstance(self._resolver, Upsample) else None

    def is_shown(self, renderer: Renderer) -> bool:
        """Whether the picture contains history, so that it is not the film alone."""
        return self._is_brought and renderer.samples < self.end

    def told(
        self, renderer: Renderer, number: Number, weights: Weights | None = None
    ) -> Told | None:
        """A number of each pixel of what is shown, valid as `show` is; None if there is none.

        `history`: samples that a pixel stands for, including those of the film; by `wrls` the views
        that its model has seen. `weight`: by `wrls`, the weight of the film in the fit, 0 to 1.
        `mask`: by `ataa`, what a pixel shows where the mean over views fails (temporal/ataa.glsl).
        """
        shown, resolver = self.show(renderer, weights), self._resolver
        if number == "mask":
            mask = resolver.mask if shown and isinstance(resolver, Ataa) else None
            return Told(mask, 0.0) if mask else None
        if shown and isinstance(resolver, Wrls):
            return Told(shown, 1.0) if number == "history" else Told(resolver.predictions, 0.0)
        return Told(shown, renderer.samples) if shown and number == "history" else None

    @property
    def more_samples(self) -> float:
        """Samples per pixel that `ataa` traced for this view in addition to the film."""
        resolver, (width, height) = self._resolver, self.surfaces.size
        return resolver.more / (width * height) if isinstance(resolver, Ataa) and width else 0.0

    def forget(self) -> None:
        """Discard the history, so that the next view begins without it."""
        self._is_kept = self._is_brought = False
        self._resolved_at = None
        if self.upsampled:
            self.upsampled.forget()

    def release(self) -> None:
        """Release all OpenGL resources."""
        with self._gl:
            self._pass.release()
            for surfaces in self._surfaces:
                surfaces.release()
            if self._resolver:
                self._resolver.release()

    def _find(self, renderer: Renderer) -> None:
        self._check(renderer)
        self._pass.fill(renderer, self.surfaces)

    def _check(self, renderer: Renderer) -> None:
        if isinstance(self._resolver, Ataa) and renderer.pipeline == "fragment":
            raise RenderError(
                "temporal ataa lists the pixels that it traces: that takes compute shaders, and "
                "the pipeline is fragment. temporal taa does without."
            )
        if isinstance(self._resolver, Upsample) and renderer.pipeline == "fragment":
            raise RenderError(
                "temporal upsample lists the pixels that it traces: that takes compute shaders, "
                "and the pipeline is fragment. temporal reproject does without."
            )

    def _resolved(
        self, resolver: Resolver, renderer: Renderer, weights: Weights | None
    ) -> moderngl.Texture:
        with self._gl:
            fresh = self._fresh(renderer, weights, self.end if self._is_brought else 0.0)
            self._resolved_at = renderer.samples, weights
            return resolver.show(self.surfaces, fresh)

    def _fresh(self, renderer: Renderer, weights: Weights | None, end: float) -> Fresh:
        weights = weights or renderer.plan.weights
        source = renderer if is_whole(renderer, weights) else None
        light = renderer.weighed(weights)
        return Fresh(light, renderer.film.mean, renderer.samples, end, source)


def is_whole(renderer: Renderer, weights: Weights) -> bool:
    """Whether the picture is the kernel's sum of paths: weights of 1, and no particles."""
    return are_trivial(weights) and renderer.settings.caustics == "off"


def is_lit_alike(renderer: Renderer, before: Surfaces) -> bool:
    """Whether a view has the scene and light of another one, apart from camera and size."""
    if not before.scene or not before.settings:
        return False
    same_scene = before.scene.model_copy(update={"camera": renderer.scene.camera})
    settings = before.settings
    same = settings.bounces, settings.method, settings.caustics
    now = renderer.settings
    return same_scene == renderer.scene and same == (now.bounces, now.method, now.caustics)
