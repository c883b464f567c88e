"""The main panel: every setting and every editable value of the scene, by subject."""

from dataclasses import replace
from functools import partial
from typing import Any, Literal

from imgui_bundle import imgui

from glrt.core.memo import kept_for_the_same
from glrt.phong import Phong
from glrt.plan.methods import METHODS, traits_of
from glrt.plan.plan import MOST_LAYERS
from glrt.scene.camera import Camera
from glrt.scene.probes import Probes
from glrt.scene.scene import Scene
from glrt.scene.warnings import cautions
from glrt.settings import Cost, Settings
from glrt.view.app import App
from glrt.view.controls import Control, controls_of, replaced, switch
from glrt.view.outliner.listing import SECTION, draw_outliner
from glrt.view.panels.background import draw_background
from glrt.view.panels.bar import bar_end, below_bar
from glrt.view.panels.compare import draw_compare, draw_view
from glrt.view.panels.files import draw_files
from glrt.view.panels.inspector import draw_inspector
from glrt.view.panels.key_table import draw_key_table
from glrt.view.panels.lights import draw_lights
from glrt.view.panels.objects import draw_object
from glrt.view.panels.pixel_paths import draw_pixel_paths
from glrt.view.panels.sun import draw_sun
from glrt.view.state.costs import bounces_control, reach_of_size
from glrt.view.state.explanations import EFFECT_TEXTS
from glrt.view.state.preferences import Preferences
from glrt.view.state.session import Session
from glrt.view.widgets.cost_badges import COLORS, legend, tag
from glrt.view.widgets.fields import button, edited, edited_fields, tip
from glrt.view.widgets.finder import FINDER
from glrt.view.widgets.steady_widget import ANCHOR

SETTINGS = {c.name: c for c in controls_of(Settings, leave_out=("crop", "denoise", "adaptive"))}
PATHS = ("method", "sampler", "roulette", "seed", "caustics")
PROBES = ("probes",)  # shown if the method has probes
PER_UPDATE = next(c for c in controls_of(Probes) if c.name == "per_update")  # with `probes`
REUSE = ("reuse", "unbiased")  # shown if the method resamples points
MARCHES = ("march_step",)  # shown if the method crosses media in steps
PARTICLES = ("particles", "aimed", "linked")  # shown if caustics are on
PHONG = {c.name: c for c in controls_of(Phong)}  # shown if the method takes these constants
OWN = {  # switches of constants, with the values that turning one on sets
    "ambient": {"ambient": 0.1},
    "diffuse": {"diffuse": 1.0},
    "highlights": {"specular": 0.5, "exponent": 32},
}
SHOWN_EFFECTS = [switch(name, text, Cost.RECOMPILE) for name, text in EFFECT_TEXTS.items()]
DISPLAY = ("exposure", "tonemap")
FRAME: tuple[Literal["width"], Literal["height"]] = ("width", "height")
CAMERA = {c.name: c for c in controls_of(Camera)}
PREFERENCES = controls_of(Preferences)
MOVING = ("mode", "temporal", "predictor")
FREE_SAMPLES = ("samples_per_frame", "target_error")

_OPEN = imgui.TreeNodeFlags_.default_open.value
_LIVE = (
    "Keep the light of each bounce apart: then reducing the bounces loses no sample, and each can "
    "be shown alone. Turning it on or off restarts the picture; while it is on, a change of a lamp "
    "restarts it too."
)
LIVE = switch("bounces_live", _LIVE, Cost.RECOMPILE)
_SHOWN = "the light of all paths, or of those of one length alone"
SHOWN = replace(LIVE, name="shown", kind="choice", help=_SHOWN, cost=Cost.RELIGHT)


def draw_panel(app: App) -> None:
    """Draw the content of the part of the window that holds the controls."""
    with below_bar(app):
        _rows(app)
    ANCHOR.keep()


def _rows(app: App) -> None:
    """Draw the cautions and all sections, which scroll below the bar."""
    _cautions(app)
    for title, section, flags in SECTIONS:
        FINDER.enter(title)
        is_wanted = section is draw_object and app.is_to_be_seen
        is_wanted |= section is draw_pixel_paths and app.paths.is_new
        if is_wanted or FINDER.wants(title):
            imgui.set_next_item_open(True)
        is_shown = imgui.collapsing_header(title, flags)
        ANCHOR.note()
        FINDER.mark("")
        top = imgui.get_item_rect_min().y
        is_new = is_shown and imgui.is_item_toggled_open()
        if is_shown:
            section(app)
        if is_new:
            _bring_to_sight(top)
    FINDER.enter("")


def _bring_to_sight(top: float) -> None:
    """Scroll down to the end of a section that was unfolded, but not past its title."""
    corner, height = imgui.get_window_pos().y, imgui.get_window_height()
    hidden = imgui.get_cursor_screen_pos().y - corner - height
    room = top - corner - bar_end()
    if hidden > 0 and room > 0:
        imgui.set_scroll_y(imgui.get_scroll_y() + min(hidden, room))


def _cautions(app: App) -> None:
    """Draw cautions where a scene exceeds float32 or the model; `glrt render` prints them too."""
    for caution in _found(app.session.scene, app.session.settings):
        _colored(COLORS[Cost.RESTART], f"Caution: {caution}")


_found = kept_for_the_same(cautions)


def _colored(color: tuple[float, float, float, float], text: str) -> None:
    imgui.push_style_color(imgui.Col_.text, color)
    imgui.text_wrapped(text)
    imgui.pop_style_color()


def _with_camera(scene: Scene, **changes: Any) -> Scene:
    return replaced(scene, camera=replaced(scene.camera, **changes))


def _paths(app: App) -> None:
    session = app.session
    opened, bounces = session.opened.settings, bounces_control(session)
    _edit(app, edited_fields((bounces,), dict(session.settings), opened=opened))
    if session.pipeline == "compute":
        is_live = edited(LIVE, session.by_length)
        session.by_length = session.by_length if is_live is None else is_live
    if session.layering == "lengths":
        _lengths(session)
    _settings(app, PATHS)
    if METHODS[session.settings.method].rasters:
        _effects(session)
    if METHODS[session.settings.method].has_constants:
        _constants(session)
    if traits_of(session.settings).has_probes:
        _settings(app, PROBES)
        _turns(app)
    if METHODS[session.settings.method].resamples:
        _settings(app, REUSE)
    if METHODS[session.settings.method].marches:
        _settings(app, MARCHES)
    if session.settings.caustics == "on":
        _settings(app, PARTICLES)


def _effects(session: Session) -> None:
    """Draw a checkbox for each effect of rays of method hybrid."""
    effects = session.settings.effects
    for control in SHOWN_EFFECTS:
        is_on = edited(control, control.name in effects)
        if is_on is not None:
            rest = [effect for effect in effects if effect != control.name]
            session.edit(effects=(*rest, control.name) if is_on else tuple(rest))


def _turns(app: App) -> None:
    """Draw the share of live probes that a picture updates."""
    probes = app.session.scene.probes or Probes()
    is_all = probes.per_update == 1
    cost, reach = (Cost.RECOMPILE, None) if is_all else (Cost.RESTART, (0.99, Cost.RECOMPILE))
    share = edited(PER_UPDATE.costing(cost, reach), probes.per_update)
    if share is not None:
        app.edit_scene("per update", partial(_with_share, per_update=share))


def _with_share(scene: Scene, per_update: float) -> Scene:
    return replaced(scene, probes=replaced(scene.probes or Probes(), per_update=per_update))


def _constants(session: Session) -> None:
    """Draw the constants of Phong's model; each can be left to materials."""
    phong = session.settings.phong or Phong()
    for name, start in OWN.items():
        is_own = all(getattr(phong, key) is not None for key in start)
        turned = {key: None if is_own else value for key, value in start.items()}
        other = replaced(phong, **turned)
        cost = Cost.RESTART if other.is_given == phong.is_given else Cost.RECOMPILE
        text = f"{name} by constants for all surfaces, not by their materials"
        is_turned = edited(switch(f"own {name}", text, cost), is_own) is not None
        controls = tuple(PHONG[key] for key in start) if is_own else ()
        changes = turned if is_turned else edited_fields(controls, dict(phong), "phong")
        if changes:
            after = replaced(phong, **changes)
            session.edit(gesture=f"{list(changes)}", phong=after if after.is_given else None)


def _lengths(session: Session) -> None:
    """Draw the choice to show all light, or only that of paths of one length."""
    last = min(session.settings.bounces, MOST_LAYERS - 1)
    rest = f"bounces from {last}" if session.settings.bounces > last else f"bounce {last} alone"
    names = ["all light", *[f"bounce {n} alone" for n in range(last)], rest]
    chosen = 0 if session.alone is None else min(session.alone, last) + 1
    shown = edited(replace(SHOWN, choices=tuple(names)), names[chosen])
    if shown is not None:
        session.alone = names.index(shown) - 1 if shown != names[0] else None


def _samples(app: App) -> None:
    _settings(app, ("samples",))
    _preferences(app, [c for c in PREFERENCES if c.name in FREE_SAMPLES])
    if button("restart"):
        app.restart()
    tip("Discard all samples and begin again, with new figures of the picture")
    tag(Cost.RESTART)


def _numbers(camera: Camera) -> dict[str, Any]:
    """Return the fields of a camera, with the distance to which it is in focus."""
    return {**dict(camera), "focus_distance": camera.resolved_focus_distance}


def _camera(app: App) -> None:
    camera = app.camera
    values = _numbers(camera)
    blurs = ("shutter",) if app.session.scene.animation else ()
    names = ("fov", "focus_distance", "defocus_angle", *blurs, "position", "look_at")
    controls, opened = tuple(CAMERA[name] for name in names), app.session.opened.scene.camera
    changes = edited_fields(controls, values, opened=_numbers(opened))
    if changes:
        app.edit_scene(f"camera {list(changes)}", partial(_with_camera, **changes))
    if camera.focus_distance is not None and button("focus on look at"):
        app.edit_scene("", partial(_with_camera, focus_distance=None))
    if button("home"):
        app.home()
    _preferences(app, [c for c in PREFERENCES if c.name in MOVING])


def _display(app: App) -> None:
    _settings(app, DISPLAY)
    draw_view(app)


def _frame(app: App) -> None:
    session = app.session
    usual = Cost.RECOMPILE if session.lacks_room else Cost.RESTART
    sides = tuple(SETTINGS[side].costing(usual, reach_of_size(session, side)) for side in FRAME)
    opened = session.opened.settings
    _edit(app, edited_fields(sides, dict(session.settings), opened=opened))


def _window(app: App) -> None:
    shown = [c for c in PREFERENCES if c.name not in (*MOVING, *FREE_SAMPLES)]
    _preferences(app, shown)
    imgui.separator_text("what an edit costs")
    legend()


def _settings(app: App, names: tuple[str, ...]) -> None:
    controls, opened = tuple(SETTINGS[n] for n in names), app.session.opened.settings
    _edit(app, edited_fields(controls, dict(app.session.settings), opened=opened))


def _edit(app: App, changes: dict[str, Any]) -> None:
    if changes:
        app.session.edit(gesture=f"{list(changes)}", **changes)


def _preferences(app: App, controls: list[Control]) -> None:
    changes = edited_fields(tuple(controls), dict(app.preferences), "preference")
    if changes:
        with app.messages.reporting():
            app.prefer(replaced(app.preferences, **changes))


SECTIONS = (
    ("Light", draw_lights, _OPEN),
    ("Paths", _paths, _OPEN),
    ("Samples", _samples, _OPEN),
    ("Display", _display, _OPEN),
    ("Inspect", draw_inspector, 0),
    ("Paths of a pixel", draw_pixel_paths, 0),
    ("Camera", _camera, _OPEN),
    (SECTION, draw_outliner, _OPEN),
    ("Object", draw_object, _OPEN),
    ("Compare", draw_compare, _OPEN),
    ("Background", draw_background, 0),
    ("Sun", draw_sun, 0),
    ("Frame", _frame, 0),
    ("Files", draw_files, 0),
    ("Mouse and keys", draw_key_table, 0),
    ("Window", _window, 0),
)
