"""Light that a render method leaves out of a scene, in words."""

from collections.abc import Iterator

from glrt.plan.facts import SceneFacts
from glrt.plan.methods import CLASSIC, METHODS, has_ambient, reuses_points, traits_of
from glrt.plan.probe_grid import grid_of
from glrt.scene.grids import edges_of_voxels
from glrt.scene.materials.kinds import glass_of
from glrt.scene.shapes.kinds import KINDS
from glrt.settings import EFFECTS, Settings


def omissions(facts: SceneFacts, settings: Settings) -> list[str]:
    """Return the light of this scene that the method does not show; nothing for path tracing.

    Light beyond the limit of bounces is not listed.
    """
    if METHODS[settings.method].rasters:
        return list(_without_effects(facts, settings))
    if traits_of(settings).has_probes:
        return list(_blurred(facts, settings))
    if METHODS[settings.method].marches:
        return list(_between_steps(facts, settings))
    if settings.method not in CLASSIC:
        return []
    own = _phong(facts, settings)
    return [*own, *_omissions(facts, settings.method, is_ambient=has_ambient(settings))]


def _phong(facts: SceneFacts, settings: Settings) -> Iterator[str]:
    """Yield what constants for all surfaces leave out of materials."""
    phong = settings.phong
    if phong is None or not METHODS[settings.method].has_constants:
        return
    kinds = {material.type for material in facts.materials.values()} - {"light"}
    if phong.diffuse is not None and kinds - {"lambertian", "dielectric"}:
        yield "metal and principled surfaces reflect as matte ones do"
    if phong.specular is not None and kinds:
        yield "highlights are white and alike on all surfaces"


def _without_effects(facts: SceneFacts, settings: Settings) -> Iterator[str]:
    """Yield what method hybrid leaves out without some of its effects, and what its probes blur."""
    scene, effects = facts.scene, settings.effects
    kinds = {material.type for material in facts.materials.values()}
    is_alone = len(scene.visible) < 2
    lamps = {shape.shape for shape in scene.visible if scene.finish(shape).group}
    if "gi" in effects:
        yield from _blurred(facts, settings)
    elif "lambertian" in kinds:
        yield "no indirect light on matte surfaces"
    if "shadows" not in effects:
        if (lamps or any(scene.sun_radiance)) and not is_alone:
            yield "no shadows"
        for kind in KINDS:
            if kind in lamps and kind not in facts.sampled:
                yield f"{kind} lamps light nothing"
    if "reflections" not in effects and kinds & {"metal", "dielectric"}:
        yield "mirrors and glass reflect nothing"
    if "reflections" not in effects and kinds & {"metal", "principled"}:
        yield "rough metal and principled surfaces reflect lamps and the background alone"
    if "refractions" not in effects and any(map(glass_of, facts.materials.values())):
        yield "glass shows nothing behind it"
    is_open = "ambient_occlusion" not in effects and not is_alone
    if is_open and any(map(any, scene.background_colors)):
        yield "nothing hides the sky"


def _between_steps(facts: SceneFacts, settings: Settings) -> Iterator[str]:
    """Yield what method march does not see of media with a grid."""
    for name in facts.media.grids:
        step = settings.march_step or max(edges_of_voxels(facts.scene, name))
        yield f"of the medium {name} what is finer than its steps, {step:.2g} long"


def _blurred(facts: SceneFacts, settings: Settings) -> Iterator[str]:
    """Yield the indirect light that probes cannot hold."""
    gathers = METHODS[settings.method].gathers
    if settings.bounces < 2 + gathers or not facts.scene.visible:
        return
    kinds = {material.type for material in facts.materials.values()}
    if "lambertian" not in kinds:
        return
    cell = "{:.2g} x {:.2g} x {:.2g}".format(*grid_of(facts.scene, settings).cell)
    light = "light over three matte surfaces or more" if gathers else "indirect light"
    yield f"of {light} what is finer than its probes, {cell} apart"
    if reuses_points(settings) and not settings.unbiased:
        yield "light at contacts and edges, where reused samples are unreliable"
    if kinds & {"metal", "dielectric"}:
        lit = "matte surfaces that light others" if gathers else "matte surfaces"
        yield f"light over mirrors or through glass onto {lit}"


def _omissions(facts: SceneFacts, method: str, is_ambient: bool) -> Iterator[str]:
    """Yield what a classic lighting model leaves out, usually the most important first."""
    scene, materials = facts.scene, facts.materials.values()
    kinds = {material.type for material in materials}
    metals = [material for material in materials if material.type == "metal"]
    is_local = not METHODS[method].follows
    lamps = {shape.shape for shape in scene.visible if scene.finish(shape).group}
    traits = METHODS[method]
    reflects = any(
        not material.is_transparent and (material.type != "light" or any(material.color))
        for material in materials
    )
    if facts.media.names:
        yield "media neither scatter, absorb nor emit light"
    if is_local and any(metal.alpha == 0 for metal in metals):
        yield "mirrors reflect nothing"
    if is_local and any(map(glass_of, materials)):
        yield "glass is black"
    if reflects:
        yield "no indirect light"
    if is_local and lamps and len(scene.visible) > 1:
        yield "no shadows"
    if traits.follows and not traits.chooses_lights and lamps:
        yield "hard shadows: lamps are points"
    if not traits.has_rough and any(metal.alpha > 0 for metal in metals):
        yield "rough metal is a mirror"
    if traits.has_rough and any(getattr(metal, "anisotropy", 0) > 0 for metal in metals):
        yield "highlights of metal are alike in all directions"
    if not is_local and not traits.has_rough and (facts.rough_glasses or facts.rough_panes):
        yield "rough glass is smooth"
    if traits.splits and facts.lobes.dispersing:
        yield "glass refracts all colors alike"
    if not is_local and lamps and "lambertian" in kinds and kinds & {"metal", "dielectric"}:
        yield "no light over mirrors or through glass onto matte surfaces"
    if "principled" in kinds and len(scene.visible) > 1:
        yield "principled surfaces reflect lamps alone"
    for kind in KINDS:
        if kind in lamps and kind not in facts.sampled:
            yield f"{kind} lamps light nothing"
    has_sky = any(map(any, scene.background_colors))
    if has_sky and is_ambient:
        yield "the background lights nothing"
    elif has_sky and scene.background.is_pictured:
        yield "the image of the sky lights nothing"
    elif has_sky and len(scene.visible) > 1:
        yield "nothing hides the sky"
    if any(scene.sun_radiance):
        yield "the sun lights nothing"
    if not traits.has_lens and scene.camera.defocus_angle > 0:
        yield "everything is in focus"


def left_out(settings: Settings, missing: list[str]) -> str:
    """Return a sentence that names what `omissions` found."""
    traits = traits_of(settings)
    is_whole = not traits.rasters or settings.effects == EFFECTS
    blurs = traits.marches or (traits.has_probes and is_whole)
    what = "blurs light" if blurs else "leaves light out"
    return (
        f"Method {settings.method} {what}, which no estimated error contains: {'; '.join(missing)}."
    )
