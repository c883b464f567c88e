"""The render on the screen: one of its views, with the kept picture to compare it with."""

from dataclasses import dataclass, field

import moderngl

from glrt.rendering.film import Film
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.aov_view import AovView
from glrt.rendering.screen.false_colors import FalseColors, Scale, Told
from glrt.rendering.screen.probe_balls import ProbeBalls, farthest
from glrt.rendering.screen.surface_view import NEEDED, SurfaceView
from glrt.view.state.costs import traced_bounces
from glrt.view.state.denoised_picture import DenoisedPicture
from glrt.view.state.reference_image import Kept, ReferenceImage
from glrt.view.state.session import Session
from glrt.view.viewport.difference import Differences
from glrt.view.viewport.picture import Picture
from glrt.view.viewport.views import (
    View,
    aov_of,
    gathered_for,
    is_filtered,
    is_of_probes,
    number_of,
    scale_of,
)

LONGER = 0.1  # seconds of a frame for the kept picture, where nothing else is left to do
SURFACE = "preview: first surface under simple light"
NO_PROBES = "The method {} has no probes: ddgi, gather and resampled do"
NO_HISTORY = "The view {} is there while light of earlier views is shown, by temporal {}"
OF_NUMBERS = {
    "history": "reproject, taa, ataa, wrls or upsample",
    "weight": "wrls alone",
    "mask": "ataa alone",
}


@dataclass
class PictureView:
    """A picture on the screen, which is drawn again when there is something new to show."""

    picture: Picture
    colors: FalseColors
    aovs: AovView
    surface: SurfaceView
    balls: ProbeBalls
    view: View = "picture"  # as requested; see `drawn`
    denoised: DenoisedPicture = field(default_factory=DenoisedPicture)
    most: float = 0.5  # relative difference that has the strongest colour
    bounces: int = 10  # the limit that the paths were traced to; the picture may show fewer
    wipe: float = 0.5  # share of the picture's width that shows the kept one
    kept: ReferenceImage | None = None
    holds: bool = False  # whether this frame renders picture A instead
    mean: float | None = None  # radiance at the last look
    drawn: View = "picture"  # on the screen now
    is_surface: bool = False  # whether a preview shows the first surface instead of the light
    difference: Differences = field(default_factory=Differences)  # from the kept picture
    is_old: bool = False  # whether the screen lacks the last edit, which has no sample yet
    _farthest: float = 1.0  # largest distance that probes hold, in scene units
    _content: object = None  # what the picture was drawn from
    _restarts: int = 0  # of the session, when it was drawn

    @property
    def scale(self) -> Scale:
        """False-colour scale of the view."""
        return scale_of(self.view, self.most, self.bounces, self._farthest)

    def advance(self, session: Session, seconds: float, count: int) -> None:
        """Render the samples of a frame.

        A kept picture that is compared is rendered again to as many samples, once those of the
        session are done; if it is not there as it was kept, it gets half of each frame instead.
        Raises RenderError if the driver has no room for that.
        """
        needed = gathered_for(self.view, session.pipeline)
        if session.refused and session.refused == needed:
            self.view, needed = "picture", ()
        session.aovs, session.refused = needed, ()
        is_denoised = is_filtered(self.view)
        is_read = is_denoised and self.denoised.follow(session)
        session.stop = self.denoised.stop(session) if is_denoised else None
        self.bounces = traced_bounces(session)
        renderer = session.renderer
        kept = self._compared(session)
        as_kept = kept.samples_as_kept if kept else 0
        if session.samples < as_kept:
            session.stop = as_kept  # the number of samples at which no other ones are needed
        follows = kept and (not as_kept or session.is_done)
        is_ahead = follows and renderer and kept and kept.samples(renderer) < session.samples
        session.waits = self.holds or bool(is_ahead) or is_read
        session.advance(seconds / 2 if follows else seconds, count)
        if not is_denoised:
            self.denoised.rest()
        if kept and follows and session.renderer:
            is_alone = session.is_done or session.waits
            kept.catch_up(session.renderer, max(seconds, LONGER) if is_alone else seconds / 2)
        elif self.kept and self.view != "difference":
            self.kept.rest()

    def is_done(self, session: Session) -> bool:
        """Whether nothing remains to be rendered."""
        kept, renderer = self._compared(session), session.renderer
        is_behind = kept and renderer and kept.samples(renderer) < session.samples
        is_filtered_now = is_filtered(self.view) and self.denoised.lacks(session)
        return session.is_done and not is_behind and not is_filtered_now

    def draw(self, session: Session) -> None:
        """Draw the newest samples; without any, the old picture stays on the screen."""
        self._draw_newest(session)
        is_before = session.is_behind or self._restarts != session.restarts
        self.is_old = bool(self.picture.name) and is_before

    def _draw_newest(self, session: Session) -> None:
        renderer, kept = session.renderer, self._compared(session)
        if not renderer or not session.is_shown:
            return
        other = (kept.light(renderer) or kept.as_kept) if kept else None
        if kept and other is None:
            return  # wait until it has as many samples
        has_equal = bool(kept and kept.samples(renderer) == renderer.samples)
        settings, view = session.settings, self._possible(session)
        progress = renderer.shown, session.restarts, session.weights, session.moving.progress
        content = (
            *progress,
            session.moving.is_shown(renderer, settings.samples),
            settings.exposure,
            settings.tonemap,
            view,
            self.scale,
            self.mean,
            kept,
            has_equal,
            self.denoised.found,
        )
        if content != self._content:
            self._draw(session, renderer, view, other)
            self._content, self.drawn, self._restarts = content, view, session.restarts

    def keep(self, session: Session) -> None:
        """Keep the picture, whatever the view, to compare it with later ones."""
        if not session.renderer or not session.samples:
            return
        picture = session.image().radiance, session.samples, session.renderer.settings.seed
        self.forget()
        session.moving.forget()  # what is kept is the film alone
        self._draw(session, session.renderer, "picture", None)
        self.picture.keep()
        self.kept = ReferenceImage(session.state, Kept(*picture), session.renderer.context)
        self._content = None

    def forget(self) -> None:
        """Release the kept picture."""
        self.picture.forget()
        if self.kept:
            self.kept.release()
        self.kept = None

    def notice(self, session: Session) -> str:
        """Return why another view is shown, or what the next frame waits for; "" for nothing."""
        renderer, kept = session.renderer, self.kept
        if session.busy or not renderer:
            return session.busy
        if self.is_surface:
            return SURFACE
        if self.view == "error" and not self._knows_error(session):
            return f"The error is known after {2 * renderer.film.extent.block} samples"
        if is_of_probes(self.view) and not renderer.probes.tracer:
            return NO_PROBES.format(session.settings.method)
        if gathered_for(self.view) and not is_filtered(self.view) and self.drawn != self.view:
            return f"The view {self.view} comes with its first sample"
        if (number := number_of(self.view)) and self.drawn != self.view:
            return NO_HISTORY.format(number, OF_NUMBERS[number])
        if self.drawn == "picture" and (told := session.moving.notice(renderer, session.settings)):
            return told
        if is_filtered(self.view):
            return self.denoised.told(session)
        if self.view != "difference":
            return ""
        if not kept:
            return "Keep a picture to show the difference from it"
        if not kept.fits(renderer) and not session.is_passing:
            return "The kept picture has another size"
        if kept.busy:
            return kept.busy
        return self.difference.told(session, kept, is_drawn=self.drawn == "difference")

    def release(self) -> None:
        """Release all OpenGL objects."""
        self.forget()
        self.denoised.release()
        self.picture.release()
        self.colors.release()
        self.aovs.release()
        self.surface.release()
        self.balls.release()

    def _compared(self, session: Session) -> ReferenceImage | None:
        """Return the kept picture if its difference is to be shown and can be; else None."""
        kept, renderer = self.kept, session.renderer
        if self.view != "difference" or not kept or not renderer or session.is_passing:
            return None
        return kept if kept.fits(renderer) else None

    def _possible(self, session: Session) -> View:
        """Return the requested view, or the picture where that view is not available."""
        if is_filtered(self.view):
            return self.view if self.denoised.fits(session) else "picture"
        if is_of_probes(self.view):
            renderer = session.renderer
            is_there = renderer and renderer.probes.tracer and renderer.aov_mean("depth")
            return self.view if is_there else "picture"
        if aov := aov_of(self.view):
            is_there = session.renderer and session.renderer.aov_mean(aov)
            return self.view if is_there else "picture"
        if number := number_of(self.view):
            wanted = session.settings.samples
            reports = session.moving.reports(session.renderer, wanted, number)
            return self.view if reports else "picture"
        if session.is_passing or (self.view == "error" and not self._knows_error(session)):
            return "picture"
        return "picture" if self.view == "difference" and not self._compared(session) else self.view

    def _knows_error(self, session: Session) -> bool:
        """Whether there are two observations, and a look at this picture or the one before it."""
        film = session.renderer and session.renderer.film
        return bool(film and self.mean is not None and film.samples >= 2 * film.extent.block)

    def _draw(
        self, session: Session, renderer: Renderer, view: View, other: moderngl.Texture | None
    ) -> None:
        film, weights = renderer.film, session.weights
        light = renderer.weighed(weights)
        self.is_surface = False
        if not session.is_preview:
            session.surface.end()
        if view == "picture":
            shown = session.moving.texture(renderer, weights) or light
            self.picture.draw(shown, session.settings, session.is_preview)
            return self._draw_surface(session, renderer) if session.is_reduced else None
        if is_filtered(view):
            return self._draw_filtered(session, film, view)
        if is_of_probes(view):
            return self._draw_probes(session, renderer, light)
        aov, number = aov_of(view), number_of(view)
        mean = renderer.aov_mean(aov) if aov else None
        told = session.moving.told(renderer, weights, number) if number else None

        def paint() -> None:
            if aov and mean:
                settings, camera = session.settings, renderer.scene.camera
                self.aovs.draw(aov, mean, camera, settings, self.bounces)
            elif view == "error":
                self.colors.draw_error(film, light, weights, self.mean or 0.0)
            elif view == "dropped":
                self.colors.draw_dropped(film, light)
            elif told:
                self.colors.draw_history(film, light, told, self.scale)
            elif other and self.kept:
                self.difference.measure(session, light, other, self.kept)
                self.colors.draw_difference(film, light, other, self.kept.mean, self.scale)

        return self.picture.paint(film.size, paint)

    def _draw_filtered(self, session: Session, film: Film, view: View) -> None:
        """Draw the denoised picture, or its error."""
        with self.denoised.texture(session.context.gl) as found:
            if view == "denoised":
                return self.picture.draw(found, session.settings)
            told, draw = Told(found, -1.0), self.colors.draw_history
            return self.picture.paint(film.size, lambda: draw(film, found, told, self.scale))

    def _draw_probes(self, session: Session, renderer: Renderer, light: moderngl.Texture) -> None:
        """Draw the picture with probes as balls, or their distances."""
        probes, depth = renderer.probes.tracer, renderer.aov_mean("depth")
        assert probes
        assert depth
        self._farthest = farthest(probes.grid)
        balls = self.balls.draw(light, depth.texture, probes, renderer.scene.camera)
        if self.view == "probes":
            return self.picture.draw(balls, session.settings, session.is_preview)
        told = renderer.film, light, balls, self.scale
        return self.picture.paint(light.size, lambda: self.colors.draw_distances(*told))

    def _draw_surface(self, session: Session, renderer: Renderer) -> None:
        """Draw the first surface instead of a preview that is too noisy, once it has its AOVs."""
        session.surface.judge(self.picture.codes())
        found = [mean.texture for mean in map(renderer.aov_mean, NEEDED) if mean]
        self.is_surface = session.surface.is_wanted and len(found) == len(NEEDED)
        if self.is_surface:
            (albedo, normal), camera, draw = found, renderer.scene.camera, self.surface.draw
            self.picture.paint(albedo.size, lambda: draw(albedo, normal, camera), is_preview=True)
