"""The features that a kernel needs for a scene and its settings, and no others."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

from glrt.plan.facts import SceneFacts
from glrt.plan.methods import METHODS, SPATIAL, TEMPORAL, reuses_points
from glrt.scene.materials.kinds import TYPES
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import KINDS, SAMPLED
from glrt.settings import Settings

NEAR = 8  # pixels around, whose kept points a pixel reuses
NO_TREE: dict[str, bool | int] = {"TREE_STACK": 0}  # known once the BVH is built
NO_LAYERS: dict[str, bool | int] = {
    "LAYERS": 0,
    "BY_LENGTH": False,
    "BACKGROUND_LAYER": 0,
    "SUN_LAYER": 0,
}
PLAIN_PROBES: dict[str, bool | int] = {
    "FROM_PROBES": False,  # paths start at probes
    "WITHOUT_VISIBILITY": False,  # ignores the visibility of probes: for experiments
    "WITHOUT_BIAS": False,
}


@dataclass(frozen=True)
class Needs:
    """The features compiled into a kernel; each is a constant of its prelude, in upper case.

    `shapes`, `materials` and `lamps` become HAS_SPHERE, HAS_SPHERE_LIGHT and so on, one constant
    for each kind or type. Matte surfaces and lamps have none, since every kernel contains them.
    Metal has two constants of its own, HAS_MIRROR and HAS_ROUGH_METAL.
    """

    shapes: frozenset[str]
    materials: frozenset[str]
    lamps: frozenset[str]  # kinds that are sampled, or that light surfaces in the classic models
    has_sphere_tree: bool
    has_tree: bool  # a BVH over other shapes
    has_instance: bool  # meshes with BVHs of their own
    instance_bits: int
    has_smooth: bool  # meshes whose normals are interpolated
    has_vertex_color: bool  # meshes whose vertices have colours
    has_map: bool  # textures
    has_color_map: bool
    has_emission_map: bool
    has_gloss_map: bool  # textures of metallic or roughness
    has_normal_map: bool
    has_coverage_map: bool  # textures of alpha
    has_transmission_map: bool
    has_mirror: bool
    has_rough_metal: bool
    has_rough_glass: bool
    has_pane: bool  # glass that is thin
    has_attenuation: bool  # glass that absorbs light
    has_nested: bool  # glasses that overlap by priority
    media: int  # number of glasses with a priority
    has_transmission: bool  # principled surfaces that are glass in part
    has_hole: bool  # principled surfaces with holes
    has_coat: bool  # principled surfaces under a clear coat
    has_conductor: bool  # metal whose reflectance depends on the angle
    has_lens: bool
    has_cone: bool  # lamps that light a cone of directions
    has_one_sided: bool  # lamps that emit from their front alone
    has_coincident: bool  # flat lamps that share a place with other surfaces
    has_background: bool
    has_horizon: bool  # a background of two gradients
    has_environment: bool  # a background given by an image
    has_sun: bool
    sample_sky: bool  # samples the image of the sky
    sample_sun: bool
    sample_lights: bool
    weight_both: bool
    quads_by_area: bool  # samples lamps evenly by area, not by solid angle
    has_particles: bool  # particles from lamps, linked to the camera
    casters: int  # spheres at which some particles are aimed: a bit for each
    targets: int  # number of balls around other shapes at which some particles are aimed
    linked: int  # smooth spheres through which some particles are linked: a bit for each
    has_probes: bool  # indirect light from a grid of probes
    final_gather: bool  # traces paths to one more matte surface before it reads probes
    resamples: bool  # keeps one of the points that light the first matte surface
    reuses_own: bool  # reuses the point that the previous sample kept for the pixel
    reuses_near: int  # number of pixels around, whose kept points are reused
    unbiased: bool  # checks which reused points other pixels could have found
    roulette: bool
    model: int  # number of a classic lighting model; 0: paths are traced
    many_lights: bool  # more than MOST_NEAR lamps are sampled
    clusters: int  # lamps weighed at each point, or clusters of many lamps
    block: int  # samples in an observation: 16 or 64 of Sobol's points, 1 of independent numbers

    def constants(self) -> dict[str, bool | int]:
        """Return the constants of the kernel's prelude, by name."""
        kinds = {f"HAS_{kind.upper()}": kind in self.shapes for kind in KINDS}
        own = [name for name in TYPES if name not in WITHOUT_OWN_FLAG]
        types = {f"HAS_{name.upper()}": name in self.materials for name in own}
        lamps = {f"HAS_{kind.upper()}_LIGHT": kind in self.lamps for kind in SAMPLED}
        plain = [field.name for field in fields(self) if field.name not in _SETS]
        values = {name.upper(): getattr(self, name) for name in plain}
        counts = {"LAMP_KINDS": len(self.lamps), "COUNT_RAYS": False, "COUNT_BOUNCES": False}
        every = {**kinds, **types, **lamps, **values, **NO_LAYERS, **NO_TREE, **counts}
        return {**every, **PLAIN_PROBES}


def everything() -> dict[str, bool | int]:
    """Return the constants of a kernel with every feature, to try single functions.

    Paths are traced, and no lamp is chosen unless the caller replaces the constants of that choice.
    The sky has two gradients. It has no image, which would take their place, and there are no
    probes, which would take the place of paths.
    """
    plain: Any = {field.name: field.name not in _IMAGE for field in fields(Needs)}
    sets = {name: frozenset(all_) for name, all_ in _SETS.items()}
    numbers = {"model": 0, "clusters": 0, "block": 1, "media": 0, "instance_bits": 0, "casters": 0}
    numbers |= {"targets": 0, "linked": 0, "reuses_near": 0}
    return Needs(**{**plain, **sets, **numbers}).constants()


_IMAGE = (
    *("has_environment", "sample_sky", "has_probes", "final_gather", "has_coincident"),
    *("resamples", "reuses_own", "unbiased"),
)
_SETS = {"shapes": KINDS, "materials": TYPES, "lamps": SAMPLED}
WITHOUT_OWN_FLAG = ("lambertian", "light", "metal")


def needs_of(facts: SceneFacts, settings: Settings) -> Needs:
    """Return the features that this scene needs with these settings."""
    scene, particles, traits = facts.scene, facts.particles, METHODS[settings.method]
    is_lit = traits.uses_lamps and facts.sampled_lamps > 0
    is_pictured, has_sun = has_image(scene), any(scene.sun_radiance)
    sends_particles = is_lit or particles.sun_sends or particles.sky_sends
    follows_particles = settings.caustics == "on" and sends_particles and traits.weighs_particles
    metals = [m for m in facts.materials.values() if m.type == "metal"]
    return Needs(
        shapes=frozenset(kind for kind, count in facts.shapes.items() if count),
        materials=_types(facts, traits.follows),
        lamps=frozenset(facts.sampled if is_lit else ()),
        has_sphere_tree=facts.has_sphere_tree,
        has_tree=bool(facts.tree_kinds),
        has_instance=bool(facts.instances),
        instance_bits=facts.instance_bits,
        has_smooth=facts.is_smooth,
        has_vertex_color=facts.is_colored,
        has_map=bool(facts.mapped),
        has_color_map="color" in facts.mapped,
        has_emission_map="emission" in facts.mapped,
        has_gloss_map=bool(facts.mapped & {"metallic", "roughness"}),
        has_normal_map="normal" in facts.mapped,
        has_coverage_map="alpha" in facts.mapped,
        has_transmission_map="transmission" in facts.mapped,
        has_mirror=traits.follows and any(m.alpha == 0 or not traits.has_rough for m in metals),
        has_rough_metal=traits.has_rough and any(m.alpha > 0 for m in metals),
        has_rough_glass=traits.follows and traits.has_rough and bool(facts.rough_glasses),
        has_transmission=bool(facts.transmitting),
        has_hole=bool(facts.holed),
        has_coat=bool(facts.coated),
        has_conductor=bool(facts.conductors),
        has_pane=traits.follows and bool(facts.panes),
        has_attenuation=traits.follows and bool(facts.tinted),
        has_nested=traits.follows and bool(facts.media),
        media=len(facts.media) if traits.follows else 0,
        has_lens=traits.has_lens and scene.camera.defocus_angle > 0,
        has_cone=bool(facts.cones),
        has_one_sided=bool(facts.one_sided),
        has_coincident=bool(facts.coincidence.pairs),
        has_background=any(map(any, scene.background_colors)),
        has_horizon=any(map(any, scene.background_colors)) and len(scene.background.gradient) > 2,
        has_environment=is_pictured,
        has_sun=has_sun and not traits.model,
        sample_sky=is_pictured and traits.samples_lights,
        sample_sun=has_sun and traits.samples_lights,
        sample_lights=is_lit and traits.samples_lights,
        weight_both=(is_lit or is_pictured or has_sun) and traits.weights_both,
        quads_by_area=is_lit and traits.weights_both and facts.lamps["quad"] > 0,
        has_particles=follows_particles,
        casters=particles.casters if follows_particles and settings.aimed else 0,
        targets=len(particles.targets) if follows_particles and settings.aimed else 0,
        linked=particles.links if follows_particles and settings.linked else 0,
        **_of_probes(settings, facts),
        roulette=settings.roulette and traits.follows,
        model=_model_number(settings.method, metals),
        many_lights=traits.chooses_lights and facts.has_many_lights,
        clusters=facts.clusters if traits.chooses_lights else 0,
        block=settings.block,
    )


def _of_probes(settings: Settings, found: SceneFacts) -> dict[str, Any]:
    """Return the features of methods with probes."""
    traits = METHODS[settings.method]
    resamples = traits.resamples and not found.holed  # a ray sees through holes at random
    reuses = resamples and reuses_points(settings)
    return {
        "has_probes": traits.has_probes,
        "final_gather": traits.gathers,
        "resamples": resamples,
        "reuses_own": reuses and settings.reuse in TEMPORAL,
        "reuses_near": NEAR if reuses and settings.reuse in SPATIAL else 0,
        "unbiased": reuses and settings.unbiased,
    }


def _types(found: SceneFacts, follows: bool) -> frozenset[str]:
    types = {m.type for m in found.materials.values() if not m.is_transparent}
    return frozenset(types | ({"dielectric"} if follows and found.solid_glasses else set()))


def has_image(scene: Scene) -> bool:
    """Return whether light comes from an image of the sky."""
    return any(map(any, scene.background_colors)) and scene.background.is_pictured


def _model_number(method: str, metals: Sequence[Metal]) -> int:
    """Return the number of a method's lighting model; 0 for path tracing.

    Without rough metal, `blinn` is the same model as `phong`: they differ only in highlights.
    """
    if method == "blinn" and not any(metal.alpha > 0 for metal in metals):
        return METHODS["phong"].model
    return METHODS[method].model
