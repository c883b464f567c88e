"""The features that a kernel needs for a scene and its settings, as fields of `Needs`."""

from dataclasses import dataclass, fields
from typing import Any

from glrt.plan import reasons
from glrt.plan.case import Case
from glrt.plan.facts import MESH, SceneFacts
from glrt.plan.methods import SPATIAL, TEMPORAL, effect_bits
from glrt.plan.rows import Row, glass, lobe, row, texture
from glrt.scene.materials.kinds import TYPES
from glrt.scene.shapes.kinds import KINDS, SAMPLED
from glrt.settings import Settings

NEAR = 8  # pixels around, whose kept points a pixel reuses
NO_TREE: dict[str, bool | int] = {"TREE_STACK": 0}  # known once the BVH is built
NO_LAYERS = {"LAYERS": 0, "BY_LENGTH": False, "BACKGROUND_LAYER": 0, "SUN_LAYER": 0}
NO_COUNTS = {"COUNT_RAYS": False, "COUNT_BOUNCES": False, "LIGHT_TERMS": 0}
PLAIN_RASTER = {"WITHOUT_MARGIN": False}  # draws to the middles of pixels: for experiments
PLAIN_PROBES: dict[str, bool | int] = dict.fromkeys(  # the last two: for experiments
    ("FROM_PROBES", "WITHOUT_VISIBILITY", "WITHOUT_BIAS"), False
)
WITHOUT_OWN_FLAG = ("lambertian", "light", "metal")


@dataclass(frozen=True)
class Needs:
    """The features compiled into a kernel; each is a constant of its prelude, in upper case.

    `shapes`, `materials` and `lamps` become HAS_SPHERE, HAS_SPHERE_LIGHT and so on, one constant
    for each kind or type. Matte surfaces and lamps have none, since every kernel contains them.
    Metal has two constants of its own, HAS_MIRROR and HAS_ROUGH_METAL.
    """

    shapes: frozenset[str] = row(lambda it: frozenset(k for k, n in it.facts.shapes.items() if n))
    has_sphere_tree: bool = row(
        lambda it: it.facts.has_sphere_tree, "tree of spheres", reasons.sphere_tree
    )
    has_tree: bool = row(  # a BVH over other shapes
        lambda it: bool(it.facts.tree_kinds),
        "tree of shapes",
        reasons.shape_tree,
        shown=lambda needs: needs.has_tree or MESH in needs.shapes,
    )
    has_instance: bool = row(lambda it: bool(it.facts.instances))  # meshes with own BVHs
    instance_bits: int = row(lambda it: it.facts.instance_bits, most=0)
    has_smooth: bool = row(lambda it: it.facts.is_smooth, "smooth normals", reasons.smooth)
    has_hidden_back: bool = row(  # meshes that rays pass from behind
        lambda it: bool(it.scene.hidden_backs), "hidden backs", reasons.hidden_backs
    )
    has_vertex_color: bool = row(lambda it: it.facts.is_colored, "vertex colours", reasons.colored)
    has_map: bool = row(lambda it: bool(it.facts.mapped))  # textures
    has_color_map: bool = texture("textured color", "color")
    has_emission_map: bool = texture("textured light", "emission")
    has_gloss_map: bool = texture("textured gloss", "metallic", "roughness")
    has_normal_map: bool = texture("normal maps", "normal")
    has_coverage_map: bool = texture("textured alpha", "alpha")
    has_transmission_map: bool = texture("textured transmission", "transmission")
    has_hole: bool = lobe("surface with holes", "holes", lambda it: it.passed)
    has_media: bool = row(lambda it: it.has_media, "media", reasons.media)
    has_grid: bool = row(lambda it: it.has_grids, "grids", reasons.grids)
    has_transfer: bool = row(lambda it: it.has_transfers, "transfer", reasons.transfers)
    marches: bool = row(lambda it: it.marches, "ray marching", reasons.steps, most=False)
    has_equiangular: bool = row(  # samples the light of few lamps along segments through media
        lambda it: it.samples_along_segments,
        "along segments",
        reasons.equiangular,
        most=False,
    )
    boundaries: int = row(lambda it: len(it.facts.media.bounds), most=0)  # of volumes with media
    has_ranks: bool = row(lambda it: it.has_ranks, "volumes by rank", reasons.ranks, most=False)
    has_mirror: bool = row(
        lambda it: (
            it.traits.follows
            and any(metal.alpha == 0 or not it.traits.has_rough for metal in it.metals)
        ),
        "mirrors",
        reasons.made_of("metal of roughness 0", reasons.metals(is_rough=False)),
    )
    has_rough_metal: bool = row(
        lambda it: it.traits.has_rough and any(metal.alpha > 0 for metal in it.metals),
        "rough metal",
        reasons.made_of("metal with roughness", reasons.metals(is_rough=True)),
    )
    has_conductor: bool = lobe("measured metal", "conductors", lambda it: it.conductors)
    materials: frozenset[str] = row(lambda it: it.types)
    has_transmission: bool = lobe("glass in part", "transmission", lambda it: it.transmitting)
    has_coat: bool = lobe("principled with clearcoat", "coats", lambda it: it.coated)
    has_anisotropy: bool = lobe("material with anisotropy", "anisotropy", lambda it: it.anisotropic)
    has_iridescence: bool = lobe("thin film", "iridescence", lambda it: it.iridescent)
    has_sheen: bool = lobe("surface with sheen", "sheen", lambda it: it.sheened)
    has_translucency: bool = lobe("translucent", "translucency", lambda it: it.translucent)
    has_rough_glass: bool = glass(
        "rough glass", "rough glass", lambda it: it.rough_glasses, is_rough=True
    )
    has_rough_pane: bool = glass(
        "rough thin glass", "rough panes", lambda it: it.rough_panes, is_rough=True
    )
    has_dispersion: bool = glass("dispersion", "dispersion", lambda it: it.lobes.dispersing)
    has_pane: bool = glass("thin glass", "panes", lambda it: it.panes)
    has_attenuation: bool = glass("tinted glass", "attenuation", lambda it: it.tinted)
    has_nested: bool = glass("glass with priority", "nested glass", lambda it: it.nested)
    nested_glasses: int = row(lambda it: len(it.facts.nested) if it.traits.follows else 0, most=0)
    has_lens: bool = row(
        lambda it: it.traits.has_lens and it.scene.camera.defocus_angle > 0, "lens", reasons.lens
    )
    has_cone: bool = row(  # lamps that light a cone of directions
        lambda it: bool(it.facts.cones), "cones", reasons.emitting("a cone", lambda it: it.cones)
    )
    has_one_sided: bool = row(  # lamps that emit from their front alone
        lambda it: bool(it.facts.one_sided),
        "one-sided lamps",
        reasons.emitting("a dark back", lambda it: it.one_sided),
    )
    has_coincident: bool = row(  # flat lamps that share a place with other surfaces
        lambda it: bool(it.facts.coincidence.pairs),
        "lamps in shared places",
        reasons.coincident,
        most=False,
    )
    has_background: bool = row(lambda it: it.has_background, "background", reasons.background)
    has_horizon: bool = row(  # a background of two gradients
        lambda it: it.has_background and len(it.scene.background.gradient) > 2,
        "horizon",
        reasons.horizon,
    )
    has_environment: bool = row(  # a background given by an image
        lambda it: it.has_image, "image of the sky", reasons.environment, most=False
    )
    sample_sky: bool = row(  # samples the image of the sky
        lambda it: it.has_image and it.traits.samples_lights,
        "sky sampling",
        reasons.by_method_and_sky,
        most=False,
    )
    has_sun: bool = row(lambda it: it.has_sun and not it.traits.model, "sun", reasons.sun)
    sample_sun: bool = row(lambda it: it.has_sun and it.traits.samples_lights, "sun sampling")
    sample_lights: bool = row(
        lambda it: it.is_lit and it.traits.samples_lights,
        "light sampling",
        reasons.by_method_and_lamps,
    )
    # Kinds that are sampled, or that light surfaces in the classic models.
    lamps: frozenset[str] = row(lambda it: frozenset(it.facts.sampled if it.is_lit else ()))
    quads_by_area: bool = row(  # samples lamps evenly by area, not by solid angle
        lambda it: it.is_lit and it.traits.weights_both and it.facts.lamps["quad"] > 0,
        "lamps by area",
        reasons.by_method_and_lamps,
    )
    clusters: int = row(  # lamps weighed at each point, or clusters of many lamps
        lambda it: it.facts.clusters if it.traits.chooses_lights else 0,
        "near lamps",
        reasons.by_method_and_lamps,
        shown=lambda needs: needs.clusters > 1,
        most=0,
    )
    many_lights: bool = row(  # more than MOST_NEAR lamps are sampled
        lambda it: it.traits.chooses_lights and it.facts.has_many_lights,
        "lamps in clusters",
        reasons.in_clusters,
    )
    weight_both: bool = row(
        lambda it: (it.is_lit or it.has_image or it.has_sun) and it.traits.weights_both,
        "both weighted",
        reasons.by_method_and_lamps,
    )
    model: int = row(  # number of a classic lighting model; 0: paths are traced
        lambda it: it.model, "lighting model", reasons.model, most=0
    )
    own_phong: bool = row(lambda it: it.own_phong, "own constants", reasons.phong, most=False)
    has_probes: bool = row(  # indirect light from a grid of probes
        lambda it: it.traits.has_probes, "probes", most=False
    )
    some_probes: bool = row(lambda it: it.takes_turns, "probes in turn", reasons.turns, most=False)
    final_gather: bool = row(lambda it: it.traits.gathers, "final gather", most=False)
    resamples: bool = row(  # keeps one of the points that light the first matte surface
        lambda it: it.resamples, "resampling", reasons.resampling, most=False
    )
    reuses_own: bool = row(  # reuses the point that the previous sample kept for the pixel
        lambda it: it.reuses and it.settings.reuse in TEMPORAL,
        "reuse",
        reasons.reuse,
        shown=lambda needs: needs.reuses_own or needs.reuses_near > 0,
        most=False,
    )
    reuses_near: int = row(  # number of pixels around, whose kept points are reused
        lambda it: NEAR if it.reuses and it.settings.reuse in SPATIAL else 0, most=0
    )
    unbiased: bool = row(  # checks which reused points other pixels could have found
        lambda it: it.reuses and it.settings.unbiased, most=False
    )
    effects: int = row(  # chosen effects of rays; 0: all light is traced
        lambda it: effect_bits(it.settings), "chosen effects", reasons.effects, most=0
    )
    rasters: bool = row(  # first surfaces of paths are known from a raster
        lambda it: it.rasters, "rasterisation", reasons.raster, most=False
    )
    has_particles: bool = row(  # particles from lamps, linked to the camera
        lambda it: it.sends_particles, "particles", reasons.caustics
    )
    sky_sends: bool = row(  # the sky sends some particles, or all
        lambda it: it.sends_particles and it.particles.sky_sends, most=False
    )
    casters: int = row(  # spheres at which some particles are aimed: a bit for each
        lambda it: it.particles.casters if it.aims else 0, most=0
    )
    targets: int = row(  # number of balls around other shapes at which some particles are aimed
        lambda it: len(it.particles.targets) if it.aims else 0, most=0
    )
    linked: int = row(  # smooth spheres through which some particles are linked: a bit for each
        lambda it: it.particles.links if it.sends_particles and it.settings.linked else 0,
        "linked spheres",
        reasons.links,
        most=0,
    )
    roulette: bool = row(
        lambda it: it.settings.roulette and it.traits.follows and not it.traits.splits,
        "roulette",
        reasons.roulette,
    )
    is_shared: bool = row(  # each second block has the same random numbers in all pixels
        lambda it: it.settings.division.is_shared, "shared numbers", reasons.sampler, most=False
    )
    adaptive: bool = row(lambda it: it.adapts, "own counts", reasons.adaptive, most=False)
    block: int = row(  # samples of a block: 16 or more of Sobol's points, 1 of random numbers
        lambda it: it.settings.division.points,
        "Sobol points",
        reasons.sampler,
        shown=lambda needs: needs.block > 1,
        most=1,
    )

    def constants(self) -> dict[str, bool | int]:
        """Return the constants of the kernel's prelude, by name."""
        kinds = {f"HAS_{kind.upper()}": kind in self.shapes for kind in KINDS}
        own = [name for name in TYPES if name not in WITHOUT_OWN_FLAG]
        types = {f"HAS_{name.upper()}": name in self.materials for name in own}
        lamps = {f"HAS_{kind.upper()}_LIGHT": kind in self.lamps for kind in SAMPLED}
        values = {name.upper(): getattr(self, name) for name in ROWS if name not in SETS}
        every = {**kinds, **types, **lamps, **values, **NO_LAYERS, **NO_TREE, **PLAIN_PROBES}
        return {**every, "LAMP_KINDS": len(self.lamps), **NO_COUNTS, **PLAIN_RASTER}


ROWS: dict[str, Row] = {it.name: it.metadata["row"] for it in fields(Needs)}
SETS = {"shapes": KINDS, "materials": TYPES, "lamps": SAMPLED}


def needs_of(facts: SceneFacts, settings: Settings) -> Needs:
    """Return the features that this scene needs with these settings."""
    case = Case(facts, settings)
    return Needs(**{name: row.when(case) for name, row in ROWS.items()})


def everything() -> dict[str, bool | int]:
    """Return the constants of a kernel with every feature, to try single functions.

    Paths are traced, and no lamp is chosen unless the caller replaces the constants of that choice.
    The sky has two gradients and no image. There are no probes, which would replace paths.
    """
    plain: Any = {name: row.most for name, row in ROWS.items()}
    sets = {name: frozenset(every) for name, every in SETS.items()}
    return Needs(**{**plain, **sets}).constants()
