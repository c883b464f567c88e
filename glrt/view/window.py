"""Main window: its parts, the loop over frames, and shutdown."""

import time
from functools import partial

import moderngl
from imgui_bundle import hello_imgui, imgui, immapp

from glrt.core.errors import ContextError, GlrtError
from glrt.gpu.context import Pipeline
from glrt.gpu.glsl import shader_files
from glrt.image.sources import STRICT, FileRules
from glrt.rendering.history.temporal import Way
from glrt.rendering.screen.aov_view import AovView
from glrt.rendering.screen.false_colors import FalseColors
from glrt.rendering.screen.probe_balls import ProbeBalls
from glrt.rendering.screen.surface_view import SurfaceView
from glrt.rendering.stopping import Interruption
from glrt.scene.scene import Scene
from glrt.settings import Denoise, Settings, settings_for
from glrt.view.app import App
from glrt.view.bars.framed import draw_picture
from glrt.view.boxes.export_box import draw_export
from glrt.view.edit_compiler import begin_for
from glrt.view.event_wait import EventWait
from glrt.view.file_watch import Watch
from glrt.view.kernel_notes import driver_of
from glrt.view.messages import Messages
from glrt.view.native import Native
from glrt.view.opengl import INSTEAD, window_options, window_version, wrap_window
from glrt.view.opening import Later
from glrt.view.palette.box import Palette
from glrt.view.panels.confirmations import draw_question
from glrt.view.panels.key_table import draw_key_overlay
from glrt.view.panels.layout import Shares, window_part
from glrt.view.panels.plots import draw_figures
from glrt.view.panels.shortcuts import COMMANDS, draw_keys
from glrt.view.panels.tour import draw_tour
from glrt.view.recovery.headers import recovery_folder
from glrt.view.recovery.keeper import Recovery
from glrt.view.recovery.lost_display import handle_lost_display
from glrt.view.recovery.question import draw_recovery
from glrt.view.start.screen import StartScreen
from glrt.view.start.thumbnails import Thumbnails
from glrt.view.state.awaited_kernel import AwaitedKernel
from glrt.view.state.denoised_picture import DenoisedPicture
from glrt.view.state.frame_budget import FrameBudget
from glrt.view.state.idle_kernel import IdleKernel
from glrt.view.state.preferences import load_preferences, preferences_file
from glrt.view.state.session import Session
from glrt.view.style import WindowStyle
from glrt.view.tabs.panel import Panel
from glrt.view.viewport.picture import Picture
from glrt.view.viewport.picture_view import PictureView
from glrt.view.widgets.finder import FINDER

SIZE = (1240, 800)
PANEL, FIGURES = 0.3, 0.22  # shares of the window's width, and of its height
PARTS = ("Controls", "Figures", "Picture")
MOST = 0.45  # largest share of either, for large text
RATES = {True: 10, False: 30}  # frames a second without a GPU, and with one
GONE = "no window can be opened, though the display was there a moment ago"
KEEP_EVERY = 2.0  # seconds between checks whether preferences must be written


class Window:
    """A session in a window; `app` and `recovery` exist once the window is open."""

    app: App
    recovery: Recovery

    def __init__(
        self,
        source: str,
        scene: Scene,
        settings: Settings,
        pipeline: Pipeline = "auto",
        rules: FileRules = STRICT,
        later: Later | None = None,
    ) -> None:
        """Prepare the window, which `run` opens; ContextError without display or OpenGL 4.1.

        Without a source it begins with the start screen, and `scene` is not shown.
        `pipeline` is compute, which needs OpenGL 4.3, or fragment; by default the first that works.
        `rules` hold for the files of the scene, also when it is read again. `later` is a scene
        that a thread reads for the window, which stands before; `run` raises what it raises.
        """
        self._version = window_version(pipeline)
        self._opened, self._rules = (source, scene, settings), rules
        self._pipeline: Pipeline = pipeline
        self._later = later
        self._refusal: GlrtError | None = None
        self._style = WindowStyle()
        self._began = self._kept = time.perf_counter()
        self._interruption = Interruption()
        self._wait, self._told = EventWait(), tuple[object, ...]()
        self._shares = Shares()
        self._palette, self._panel = Palette(), Panel()
        self.add_ons = immapp.AddOnsParams(with_implot=True)
        self.params = self._params()

    def run(self) -> int:
        """Show the window until it is closed or a signal ends it; returns the exit code.

        Raises ContextError if the display has disappeared since the window was prepared.
        """
        with Interruption().watched() as self._interruption:
            try:
                immapp.run(self.params, self.add_ons)
            except RuntimeError as error:
                if hasattr(self, "app"):
                    raise
                raise ContextError(f"{GONE}: {error}. {INSTEAD}") from None
        if self._refusal:
            raise self._refusal
        return 128 + self._interruption.signal if self._interruption.signal else 0

    def _params(self) -> hello_imgui.RunnerParams:
        params = hello_imgui.RunnerParams()
        params.app_window_params.window_title = "glrt"
        params.app_window_params.window_geometry.size = SIZE
        params.app_window_params.restore_previous_geometry = True
        params.imgui_window_params.default_imgui_window_type = (
            hello_imgui.DefaultImGuiWindowType.provide_full_screen_dock_space
        )
        params.renderer_backend_options.open_gl_options = window_options(self._version)
        params.ini_folder_type = hello_imgui.IniFolderType.app_user_config_folder
        params.ini_filename = "glrt/view.ini"
        params.docking_params = self._docking()
        callbacks = params.callbacks
        callbacks.setup_imgui_config = _configure
        callbacks.post_init = self._open
        callbacks.pre_new_frame = self._render
        callbacks.show_gui = self._ask
        callbacks.confirm_exit = self._may_close
        callbacks.before_exit = self._close
        params.fps_idling.enable_idling = False  # it draws nine frames a second; see EventWait
        return params

    def _docking(self) -> hello_imgui.DockingParams:
        preferences, _ = load_preferences(preferences_file())
        panel, figures = (min(share * preferences.scale, MOST) for share in (PANEL, FIGURES))
        side = hello_imgui.DockingSplit("MainDockSpace", "Side", imgui.Dir.left, panel)
        below = hello_imgui.DockingSplit("MainDockSpace", "Below", imgui.Dir.down, figures)
        docking = hello_imgui.DockingParams()
        docking.docking_splits = [side, below]
        docking.main_dock_space_node_flags = imgui.DockNodeFlags_.none  # it draws no ground
        docking.dockable_windows = [
            window_part(PARTS[0], "Side", lambda: self._panel.draw(self.app)),
            window_part(PARTS[1], "Below", lambda: draw_figures(self.app)),
            window_part(PARTS[2], "MainDockSpace", self._draw_picture),
        ]
        return docking

    def _draw_picture(self) -> None:
        if self.app.shows_start:
            self._start.draw(self.app)
        else:
            draw_picture(self.app)

    def _open(self) -> None:
        """Create the state of the window, once its OpenGL context is current."""
        source, scene, settings = self._opened
        plain, context = settings_for(settings, denoise="none"), wrap_window()
        preferences, problem = load_preferences(preferences_file())
        self._rate = RATES[context.is_software]
        session = Session(scene, plain, context, pipeline=self._pipeline, rest=IdleKernel())
        self.app = App(
            session=session,
            messages=Messages(session),
            show=_shown(context.gl, settings.denoise),
            preferences=preferences,
            preferences_file=preferences_file(),
            source=source,
            pace=FrameBudget(self._rate),
            pivot=scene.camera.look_at,
            shaders=Watch(shader_files()),
            rules=self._rules,
            shows_start=not source,
        )
        self._start = StartScreen(partial(Thumbnails, context.gl))
        self.app.messages.complain(problem)
        self.app.leave = self._leave
        session.moving.use(Way(preferences.temporal, preferences.predictor))
        self.app.files.aside.driver = partial(driver_of, session)
        session.ahead = AwaitedKernel(partial(begin_for, self.app.files.aside.driver))
        if self._later:
            self.app.files.aside.begin(*self._later)
            self.app.files.aside.refuse = self._refuse
        self._native = Native(self.app.drop)
        self.app.fill_screen = self._native.toggle_full_screen
        self.recovery = Recovery(self.app.files, recovery_folder())
        handle_lost_display(self.recovery.last_words)

    def _render(self) -> None:
        """Do the work before a frame is drawn: keys, edits, samples and the picture."""
        self._began += self._wait.wait(self._is_quiet)
        app, now = self.app, time.perf_counter()
        app.frame_seconds = now - self._began
        app.pace.record(app.frame_seconds, app.sampling_seconds)
        app.load.look()
        self._began = now
        app.pace.frames_per_second = app.preferences.frame_rate or self._rate
        draw_keys(app)
        app.has_list_keys = False  # the list takes them again, if it is drawn
        for panel in self.params.docking_params.dockable_windows[:2]:
            panel.is_visible = not (app.is_picture_alone or app.shows_start)
        self._shares.keep(PARTS)
        self._style.choose(app.preferences.theme, app.preferences.scale)
        self._native.entitle("glrt" if app.shows_start else app.files.title)
        app.advance()
        app.look(now)
        self._poll(now)
        self._told = self._reports(now)
        if self._interruption.signal:
            self._leave()

    def _poll(self, now: float) -> None:
        """Handle what sends no event: changed files, dialogs, edits and preferences to be kept."""
        self.app.follow_files(now)
        self.recovery.follow()
        self.app.files.dialogs.poll(is_drawn=False)
        self._keep(now)

    def _is_quiet(self) -> bool:
        """Whether a new frame would show the same as the screen."""
        now = time.perf_counter()
        self._poll(now)
        is_done = self.app.show.is_done(self.app.session) and self.app.pair.is_done
        is_done = is_done and not (self.app.paths.is_waiting or self.app.progress.is_looking)
        is_done = (is_done and not self.app.timeline.is_playing) or self.app.shows_start
        return is_done and not self._interruption.signal and self._reports(now) == self._told

    def _reports(self, now: float) -> tuple[object, ...]:
        """Return the texts that appear or disappear without an event."""
        messages = self.app.messages
        told = self.app.session.problem, messages.recent(now), messages.question
        work = self.app.files.aside.text, self.app.exports.text(now), self.app.dropped
        return *told, *work, len(self.recovery.offers), FINDER.is_marking

    def _keep(self, now: float) -> None:
        """Write changed preferences soon, not only at the end: a window may be killed."""
        if now - self._kept > KEEP_EVERY:
            self._kept = now
            self.app.keep_preferences()

    def _ask(self) -> None:
        """Draw the popups above the panels: tour, questions and file dialog."""
        if not self.app.shows_start:
            draw_tour(self.app)
        draw_export(self.app)
        draw_key_overlay(self.app)
        self._palette.draw(self.app)
        draw_recovery(self.recovery)
        draw_question(self.app)
        self.app.files.dialogs.poll(is_drawn=True)

    def _may_close(self) -> bool:
        """Whether the window may close at once; else ask about an export, and unsaved edits."""
        is_agreed = not (self.app.files.is_changed or self.app.exports.job)
        if is_agreed:
            self._native.leave_full_screen()
        else:
            COMMANDS["quit"](self.app)
        return is_agreed

    def _refuse(self, error: GlrtError) -> None:
        """End the window: the scene that it was opened for is wrong."""
        self._refusal = error
        self._leave()

    def _leave(self) -> None:
        self._native.leave_full_screen()  # its size is kept for the next start
        self.params.app_shall_exit = True

    def _close(self) -> None:
        self.recovery.end(is_interrupted=self._interruption.signal is not None)
        self.app.keep_preferences()
        self._start.release()
        self.app.release()


def _shown(gl: moderngl.Context, denoise: Denoise) -> PictureView:
    show = PictureView(Picture(gl), FalseColors(gl), AovView(gl), SurfaceView(gl), ProbeBalls(gl))
    if denoise != "none":
        show.denoised, show.view = DenoisedPicture(denoise), "denoised"
    return show


def _configure() -> None:
    """Configure Dear ImGui: arrow keys move the camera, not the focus; no caret blinks."""
    hello_imgui.imgui_default_settings.setup_default_imgui_config()
    io = imgui.get_io()
    io.config_windows_move_from_title_bar_only = True
    io.config_input_text_cursor_blink = False
    io.config_flags &= ~imgui.ConfigFlags_.nav_enable_keyboard.value
