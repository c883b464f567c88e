"""Explain in words why each kernel feature is compiled in or left out."""

from collections.abc import Iterable
from typing import NamedTuple

from glrt.core.text import counted, plural
from glrt.plan.facts import (
    ENDLESS,
    MESH,
    MOST_NEAR,
    REST_FROM,
    SPHERES_FROM,
    TREE_FROM,
    SceneFacts,
)
from glrt.plan.features import WITHOUT_OWN_FLAG, Needs
from glrt.plan.methods import CLASSIC, METHODS
from glrt.plan.plan import Plan
from glrt.scene.materials.kinds import TYPES, Material
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS, SAMPLED
from glrt.scene.summary import few
from glrt.settings import Settings

_TEXTURED = {  # by kernel constant: a name, and the material keys that need it
    "has_color_map": ("textured color", ("color",)),
    "has_emission_map": ("textured light", ("emission",)),
    "has_gloss_map": ("textured gloss", ("metallic", "roughness")),
    "has_normal_map": ("normal maps", ("normal",)),
    "has_coverage_map": ("textured alpha", ("alpha",)),
    "has_transmission_map": ("textured transmission", ("transmission",)),
}


class Feature(NamedTuple):
    """A feature of the kernel, whether it is compiled in, and why."""

    name: str
    present: bool
    reason: str


def explain(plan: Plan) -> list[Feature]:
    """List every kernel feature: whether it is compiled in, and what in the scene decides that."""
    scene, settings, found, needs = plan.scene, plan.settings, plan.facts, plan.needs
    used = found.materials

    def made_of(kind: str, **limits: bool) -> list[str]:
        return [name for name, m in used.items() if m.type == kind and _matches(m, limits)]

    def shapes(kind: str) -> str:
        return counted(found.shapes[kind], kind)

    lens, method = scene.camera.defocus_angle, settings.method
    mirrors, rough = made_of("metal", rough=False), made_of("metal", rough=True)
    lamps = _lamps(found)
    return [
        *(Feature(plural(kind), kind in needs.shapes, shapes(kind)) for kind in KINDS),
        Feature(
            "tree of spheres",
            needs.has_sphere_tree,
            _of(shapes("sphere"), SPHERES_FROM),
        ),
        Feature("tree of shapes", needs.has_tree or MESH in needs.shapes, _tree(found)),
        Feature("smooth normals", needs.has_smooth, _smooth(found)),
        Feature("vertex colours", needs.has_vertex_color, _colored(found)),
        *_textures(needs, found),
        Feature("mirrors", needs.has_mirror, _made_of(mirrors, "metal of roughness 0")),
        Feature("rough metal", needs.has_rough_metal, _made_of(rough, "metal with roughness")),
        Feature("conductors", needs.has_conductor, _made_of(found.conductors, "measured metal")),
        *(
            Feature(_SPOKEN.get(name, name), name in needs.materials, _made_of(made_of(name), name))
            for name in TYPES
            if name not in WITHOUT_OWN_FLAG
        ),
        Feature(
            "transmission", needs.has_transmission, _made_of(found.transmitting, "glass in part")
        ),
        Feature("coats", needs.has_coat, _made_of(found.coated, "principled with clearcoat")),
        *_kinds_of_glass(needs, found),
        Feature("lens", needs.has_lens, f"camera.defocus_angle is {lens:g}"),
        *_aims(needs, found),
        Feature("lamps in shared places", needs.has_coincident, _coincident(found)),
        Feature("background", needs.has_background, _background(scene)),
        Feature("horizon", needs.has_horizon, _horizon(scene)),
        Feature("image of the sky", needs.has_environment, _environment(scene)),
        Feature("sky sampling", needs.sample_sky, f"method {method}, {_environment(scene)}"),
        Feature("sun", needs.has_sun, "given" if scene.sun else "sun is not given"),
        Feature("sun sampling", needs.sample_sun, f"method {method}"),
        Feature("light sampling", needs.sample_lights, f"method {method}, {lamps}"),
        *(
            Feature(f"{kind} lamps", kind in needs.lamps, f"method {method}, {lamps}")
            for kind in SAMPLED
        ),
        Feature("lamps by area", needs.quads_by_area, f"method {method}, {lamps}"),
        Feature("near lamps", needs.clusters > 1, f"method {method}, {lamps}"),
        Feature("lamps in clusters", needs.many_lights, f"{lamps}; from {MOST_NEAR + 1} on"),
        Feature("both weighted", needs.weight_both, f"method {method}, {lamps}"),
        Feature("lighting model", needs.model > 0, _model(settings)),
        *_by_settings(needs, settings, found),
    ]


def _by_settings(needs: Needs, settings: Settings, found: SceneFacts) -> list[Feature]:
    return [
        Feature("probes", needs.has_probes, f"method {settings.method}"),
        Feature("final gather", needs.final_gather, f"method {settings.method}"),
        Feature("resampling", needs.resamples, _resampling(settings, found)),
        Feature("reuse", needs.reuses_own or needs.reuses_near > 0, _reuse(settings)),
        Feature("particles", needs.has_particles, f"caustics {settings.caustics}"),
        Feature("linked spheres", needs.linked != 0, _links(needs, settings)),
        Feature("roulette", needs.roulette, _roulette(settings)),
        Feature("Sobol points", needs.block > 1, f"sampler {settings.sampler}"),
    ]


def _resampling(settings: Settings, found: SceneFacts) -> str:
    method = f"method {settings.method}"
    if METHODS[settings.method].resamples and found.holed:
        return f"{method}, {_made_of(found.holed, 'alpha below 1')}: then it is gather"
    return method


def _reuse(settings: Settings) -> str:
    form = "" if settings.reuse == "none" or settings.unbiased else ", biased"
    return f"method {settings.method}, reuse {settings.reuse}{form}"


def _links(needs: Needs, settings: Settings) -> str:
    if settings.linked and not needs.linked and needs.has_particles:
        return "no sphere of smooth glass or metal that nothing lies in"
    text = f"linked {settings.linked:g}"
    return f"{text}, {counted(needs.linked.bit_count(), 'sphere')}" if needs.linked else text


def _aims(needs: Needs, found: SceneFacts) -> list[Feature]:
    return [
        Feature("cones", needs.has_cone, _lamps_with("a cone", found.cones)),
        Feature("one-sided lamps", needs.has_one_sided, _lamps_with("one side", found.one_sided)),
    ]


def _coincident(found: SceneFacts) -> str:
    pairs = len(found.coincidence.pairs)
    if not pairs:
        return "no flat lamp lies in the plane of another surface and overlaps it"
    return f"{counted(pairs, 'pair')} of a lamp and another object overlap in one plane"


def _textures(needs: Needs, found: SceneFacts) -> list[Feature]:
    """Return a feature for each kind of texture, and one for holes."""
    rows = [
        Feature(name, getattr(needs, constant), _mapped(keys, found))
        for constant, (name, keys) in _TEXTURED.items()
    ]
    return [*rows, Feature("holes", needs.has_hole, _made_of(found.holed, "alpha below 1"))]


def _mapped(keys: tuple[str, ...], found: SceneFacts) -> str:
    there = [key for key in keys if key in found.mapped]
    return f"{' and '.join(there or keys)} by {'a texture' if there else 'no texture'}"


def _kinds_of_glass(needs: Needs, found: SceneFacts) -> list[Feature]:
    return [
        Feature("rough glass", needs.has_rough_glass, _made_of(found.rough_glasses, "rough glass")),
        Feature("panes", needs.has_pane, _made_of(found.panes, "thin glass")),
        Feature("attenuation", needs.has_attenuation, _made_of(found.tinted, "tinted glass")),
        Feature("nested glass", needs.has_nested, _made_of(found.media, "glass with priority")),
    ]


_SPOKEN = {"dielectric": "glass"}


def _matches(material: Material, limits: dict[str, bool]) -> bool:
    rough = getattr(material, "alpha", 0.0) > 0
    return all(rough == wanted for wanted in limits.values())


def _of(count: str, least: int) -> str:
    return f"{count}; it pays from {least} on"


def _tree(found: SceneFacts) -> str:
    if found.tree_kinds or found.triangles:
        listed = [counted(found.shapes[kind], kind) for kind in found.tree_kinds]
        listed += [counted(found.triangles, "triangle")] if found.triangles else []
        return f"over {', '.join(listed)}"
    rest = [kind for kind in KINDS if kind not in (*ENDLESS, MESH)]
    if found.has_sphere_tree:
        count = counted(found.count_of(kind for kind in rest if kind != "sphere"), "other shape")
        return _of(count, REST_FROM)
    return _of(counted(found.count_of(rest), "bounded shape"), TREE_FROM)


def _smooth(found: SceneFacts) -> str:
    return "a mesh has smooth = true" if found.is_smooth else "no mesh has smooth = true"


def _colored(found: SceneFacts) -> str:
    return "a mesh has colours" if found.is_colored else "no mesh has colours"


def _made_of(names: Iterable[str], kind: str) -> str:
    listed = few(names)
    return f"{kind}: {listed}" if listed else f"nothing is {kind}"


def _lamps_with(what: str, names: list[str]) -> str:
    return f"emission with {what}: {few(names)}" if names else f"no lamp emits with {what}"


def _background(scene: Scene) -> str:
    return "its light is not black" if any(map(any, scene.background_colors)) else "black"


def _horizon(scene: Scene) -> str:
    is_given = scene.background.horizon is not None
    return f"background.horizon is {'given' if is_given else 'not given'}"


def _environment(scene: Scene) -> str:
    if scene.background.sky:
        return "background.sky is given"
    image = scene.background.image
    return f"background.image is {image.file}" if image else "background.image is not given"


def _model(settings: Settings) -> str:
    traces = settings.method not in CLASSIC
    return f"method {settings.method}{' traces paths' if traces else ', which leaves light out'}"


def _roulette(settings: Settings) -> str:
    if not settings.roulette:
        return "turned off"
    return "turned on; for paths whose throughput is below 1/4"


def _lamps(found: SceneFacts) -> str:
    named = (
        counted(count, f"{kind} lamp") + ("" if kind in found.sampled else " (by scattering alone)")
        for kind, count in found.lamps.items()
        if count
    )
    return ", ".join(named) or "no lamp"
