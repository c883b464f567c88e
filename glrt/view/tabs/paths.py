"""Part `Paths`: how light is followed, and what the method needs for it."""

from dataclasses import replace
from functools import partial

from glrt.phong import Phong
from glrt.plan.methods import METHODS, traits_of
from glrt.plan.plan import MOST_LAYERS
from glrt.scene.probes import Probes
from glrt.scene.scene import Scene
from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.controls import controls_of, replaced, switch
from glrt.view.state.costs import bounces_control
from glrt.view.state.session import Session
from glrt.view.tabs.kept import edit, settings_rows
from glrt.view.widgets.explanations import EFFECT_TEXTS
from glrt.view.widgets.fields import edited, edited_fields

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
_LIVE = (
    "Keep the light of each bounce apart: then reducing the bounces loses no sample, and each can "
    "be shown alone. Turning it on or off restarts the picture; while it is on, a change of a lamp "
    "restarts it too."
)
LIVE = switch("bounces_live", _LIVE, Cost.RECOMPILE)
_SHOWN = "the light of all paths, or of those of one length alone"
SHOWN = replace(LIVE, name="shown", kind="choice", help=_SHOWN, cost=Cost.RELIGHT)


def draw_paths(app: App) -> None:
    """Draw bounces, method and sampler, and the controls that the method has."""
    session = app.session
    opened, bounces = session.opened.settings, bounces_control(session)
    edit(app, edited_fields((bounces,), dict(session.settings), opened=opened))
    if session.pipeline == "compute":
        is_live = edited(LIVE, session.by_length)
        session.by_length = session.by_length if is_live is None else is_live
    if session.layering == "lengths":
        _lengths(session)
    settings_rows(app, PATHS)
    if METHODS[session.settings.method].rasters:
        _effects(session)
    if METHODS[session.settings.method].has_constants:
        _constants(session)
    if traits_of(session.settings).has_probes:
        settings_rows(app, PROBES)
        _turns(app)
    if METHODS[session.settings.method].resamples:
        settings_rows(app, REUSE)
    if METHODS[session.settings.method].marches:
        settings_rows(app, MARCHES)
    if session.settings.caustics == "on":
        settings_rows(app, PARTICLES)


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
