"""Why a feature is compiled into a kernel or left out, in words.

A reason is a function of a case; some functions here return one.
"""

from collections.abc import Callable, Iterable

from glrt.core.text import counted
from glrt.plan.case import Case
from glrt.plan.facts import (
    ENDLESS,
    MESH,
    MOST_BAKED,
    MOST_NEAR,
    REST_FROM,
    SPHERES_FROM,
    TREE_FROM,
    SceneFacts,
)
from glrt.plan.methods import CLASSIC
from glrt.scene.shapes.kinds import KINDS
from glrt.scene.summary import few

Reason = Callable[[Case], str]


def made_of(kind: str, names: Callable[[Case], Iterable[str]]) -> Reason:
    """Return the reason of a feature that materials of a kind need."""
    return lambda case: listed(names(case), kind)


def textured(*keys: str) -> Reason:
    """Return the reason of a feature that textures of some material keys need."""

    def reason(case: Case) -> str:
        there = [key for key in keys if key in case.facts.mapped]
        return f"a texture gives {' and '.join(there)}" if there else "no texture"

    return reason


def emitting(what: str, names: Callable[[SceneFacts], list[str]]) -> Reason:
    """Return the reason of a feature that lamps need which have a cone or a dark back."""

    def reason(case: Case) -> str:
        found = names(case.facts)
        return f"{what}: {few(found)}" if found else f"no lamp with {what}"

    return reason


def metals(is_rough: bool) -> Callable[[Case], list[str]]:
    """Return the names of the smooth or of the rough metals."""
    return lambda case: [
        name
        for name, it in case.facts.materials.items()
        if it.type == "metal" and (getattr(it, "alpha", 0.0) > 0) == is_rough
    ]


def hidden_backs(case: Case) -> str:
    """Return the files of meshes with hidden backs."""
    names = case.scene.hidden_backs
    return f"backfaces of {few(names)}" if names else "no mesh hides its backs"


def media(case: Case) -> str:
    """Return the media that paths fly through."""
    names = case.facts.media.names
    return f"filled with {few(names)}" if names else "no medium fills space"


def ranks(case: Case) -> str:
    """Return whether volumes of a scene with media have priorities."""
    if not case.facts.media.is_ranked:
        return "no volume of a scene with media has a priority"
    return f"{len(case.facts.media.bounds)} volumes by priority"


def grids(case: Case) -> str:
    """Return the media whose density varies."""
    names = case.facts.media.grids
    return f"density varies in {few(names)}" if names else "no medium has a grid"


def transfers(case: Case) -> str:
    """Return the media with a transfer function."""
    names = case.facts.media.transfers
    return f"colour by density in {few(names)}" if names else "no medium has a transfer function"


def steps(case: Case) -> str:
    """Return the method, and the media that it crosses in steps."""
    if not case.traits.marches:
        return by_method(case)
    return f"{by_method(case)}, {grids(case)}"


def equiangular(case: Case) -> str:
    """Return the media and the lamps."""
    return f"{media(case)}, {lamps(case)}"


def by_method(case: Case) -> str:
    """Return the method."""
    return f"method {case.settings.method}"


def by_method_and_lamps(case: Case) -> str:
    """Return the method and the lamps."""
    return f"{by_method(case)}, {lamps(case)}"


def by_method_and_sky(case: Case) -> str:
    """Return the method and the image of the sky."""
    return f"{by_method(case)}, {environment(case)}"


def lamps(case: Case) -> str:
    """Return the lamps of each kind."""
    named = (
        counted(count, f"{kind} lamp")
        + ("" if kind in case.facts.sampled else " (by scattering alone)")
        for kind, count in case.facts.lamps.items()
        if count
    )
    return ", ".join(named) or "no lamp"


def in_clusters(case: Case) -> str:
    """Return the lamps, and from which number on they form clusters."""
    return f"{lamps(case)}; from {MOST_NEAR + 1} on"


def sphere_tree(case: Case) -> str:
    """Return the number of spheres, and from which number on a BVH pays."""
    found = case.facts
    reason = _of(counted(found.shapes["sphere"], "sphere"), SPHERES_FROM)
    return reason + (_in_windows(found) if found.has_sphere_tree else "")


def shape_tree(case: Case) -> str:
    """Return what the BVH holds, or from how many shapes on one pays."""
    found = case.facts
    if found.tree_kinds or found.triangles:
        parts = [counted(found.shapes[kind], kind) for kind in found.tree_kinds]
        parts += [counted(found.triangles, "triangle")] if found.triangles else []
        return f"over {', '.join(parts)}" + (_in_windows(found) if found.tree_kinds else "")
    rest = [kind for kind in KINDS if kind not in (*ENDLESS, MESH)]
    if found.has_sphere_tree:
        count = counted(found.count_of(kind for kind in rest if kind != "sphere"), "other shape")
        return _of(count, REST_FROM)
    return _of(counted(found.count_of(rest), "bounded shape"), TREE_FROM)


def smooth(case: Case) -> str:
    """Return whether a mesh interpolates normals."""
    return f"{'a' if case.facts.is_smooth else 'no'} mesh has smooth = true"


def colored(case: Case) -> str:
    """Return whether a mesh has colours of vertices."""
    return f"{'a' if case.facts.is_colored else 'no'} mesh has colours"


def lens(case: Case) -> str:
    """Return the angle of the lens."""
    return f"camera.defocus_angle is {case.scene.camera.defocus_angle:g}"


def coincident(case: Case) -> str:
    """Return how many flat lamps share a place with other surfaces."""
    pairs = len(case.facts.coincidence.pairs)
    if not pairs:
        return "no flat lamp or bound of a medium overlaps another surface in one plane"
    return f"{counted(pairs, 'pair')} of a lamp or bound and another object overlap in one plane"


def background(case: Case) -> str:
    """Return whether the sky is black."""
    return "its light is not black" if case.has_background else "black"


def horizon(case: Case) -> str:
    """Return whether the sky has a horizon."""
    is_given = case.scene.background.horizon is not None
    return f"background.horizon is {'given' if is_given else 'not given'}"


def environment(case: Case) -> str:
    """Return which image of the sky there is."""
    sky = case.scene.background
    if sky.sky:
        return "background.sky is given"
    return f"background.image is {sky.image.file}" if sky.image else "background.image is not given"


def sun(case: Case) -> str:
    """Return whether the scene has a sun."""
    return "given" if case.scene.sun else "sun is not given"


def resampling(case: Case) -> str:
    """Return the method, and what keeps it from resampling."""
    if case.traits.resamples and case.facts.lobes.holed:
        holes = listed(case.facts.lobes.holed, "alpha below 1")
        return f"{by_method(case)}, {holes}: then it is gather"
    return by_method(case)


def reuse(case: Case) -> str:
    """Return the method and the form of reuse."""
    settings = case.settings
    form = "" if settings.reuse == "none" or settings.unbiased else ", biased"
    return f"{by_method(case)}, reuse {settings.reuse}{form}"


def caustics(case: Case) -> str:
    """Return whether particles are wanted."""
    return f"caustics {case.settings.caustics}"


def links(case: Case) -> str:
    """Return through how many spheres particles are linked."""
    settings = case.settings
    linked = case.particles.links if case.sends_particles and settings.linked else 0
    if settings.linked and not linked and case.sends_particles:
        return "no sphere of smooth glass or metal that nothing lies in"
    text = f"linked {settings.linked:g}"
    return f"{text}, {counted(linked.bit_count(), 'sphere')}" if linked else text


def model(case: Case) -> str:
    """Return whether the method traces paths."""
    traces = case.settings.method not in CLASSIC
    return f"{by_method(case)}{' traces paths' if traces else ', which leaves light out'}"


def effects(case: Case) -> str:
    """Return the effects of rays of method hybrid."""
    if not case.traits.rasters:
        return by_method(case)
    return f"{by_method(case)}, effects {', '.join(case.settings.effects) or 'none'}"


def raster(case: Case) -> str:
    """Return the method, and why it traces rays to first surfaces instead."""
    if case.traits.rasters and not case.rasters:
        has_lens = case.scene.camera.defocus_angle > 0
        why = lens(case) if has_lens else coincident(case)
        return f"{by_method(case)}, {why}: first surfaces are traced"
    return by_method(case)


def turns(case: Case) -> str:
    """Return the share of the live probes that one picture updates."""
    probes = case.scene.probes
    return f"{by_method(case)}, probes.per_update {probes.per_update if probes else 1:g}"


def phong(case: Case) -> str:
    """Return the constants that the scene gives in place of those of materials."""
    given = case.settings.phong
    if not given or not given.is_given:
        return "render.phong gives no constant"
    values = ", ".join(f"{name} {value:g}" for name, value in given if value is not None)
    return f"{by_method(case)}, render.phong: {values}"


def roulette(case: Case) -> str:
    """Return whether roulette is on."""
    if not case.settings.roulette:
        return "turned off"
    return "turned on; for paths whose throughput is below 1/4"


def sampler(case: Case) -> str:
    """Return the sampler."""
    return f"sampler {case.settings.sampler}"


def adaptive(case: Case) -> str:
    """Return whether pixels get samples in proportion to their noise."""
    return f"adaptive {case.settings.adaptive}"


def _in_windows(found: SceneFacts) -> str:
    """Return that renders do without a BVH, if they have few shapes."""
    told = f"; in the window: glrt render tries up to {MOST_BAKED} shapes one by one"
    return told if sum(found.shapes.values()) <= MOST_BAKED else ""


def _of(count: str, least: int) -> str:
    return f"{count}; it pays from {least} on"


def listed(names: Iterable[str], kind: str) -> str:
    """Return the materials of a kind, or that there is none."""
    some = few(names)
    return f"{kind}: {some}" if some else f"no {kind}"
