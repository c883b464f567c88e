"""The features that a kernel needs for a scene and its settings, as fields of `Needs`."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

from glrt.plan import reasons
from glrt.plan.case import Case
from glrt.plan.facts import MESH, SceneFacts
from glrt.plan.lobes import LobeFacts
from glrt.plan.methods import SPATIAL, TEMPORAL, effect_bits
from glrt.plan.reasons import Reason, made_of, textured
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


class Row(NamedTuple):
    """A field of `Needs`."""

    when: Callable[[Case], Any]  # its value
    name: str  # for users; empty for what other rows explain
    why: Reason
    shown: Callable[["Needs"], bool] | None  # whether users see it as compiled in
    most: bool | int  # its value in a kernel with every feature


def _row(
    when: Callable[[Case], Any],
    name: str = "",
    why: Reason = reasons.by_method,
    shown: Callable[["Needs"], bool] | None = None,
    most: bool | int = True,
) -> Any:
    return field(metadata={"row": Row(when, name, why, shown, most)})


def _textured(name: str, *keys: str) -> Any:
    """Return the row of textures of some material keys."""
    return _row(lambda it: bool(it.facts.mapped & {*keys}), name, textured(*keys))


def _made_of(kind: str, name: str, names: Callable[[LobeFacts], list[str]]) -> Any:
    """Return the row of a kind of material, found by the names of such materials."""
    why = made_of(kind, lambda it: names(it.facts.lobes))
    return _row(lambda it: bool(names(it.facts.lobes)), name, why)


def _followed(kind: str, name: str, names: Callable[[SceneFacts], list[str]]) -> Any:
    """Return the row of a kind of glass that not every method follows."""
    why = made_of(kind, lambda it: names(it.facts))
    return _row(lambda it: it.traits.follows and bool(names(it.facts)), name, why)


@dataclass(frozen=True)
class Needs:
    """The features compiled into a kernel; each is a constant of its prelude, in upper case.

    `shapes`, `materials` and `lamps` become HAS_SPHERE, HAS_SPHERE_LIGHT and so on, one constant
    for each kind or type. Matte surfaces and lamps have none, since every kernel contains them.
    Metal has two constants of its own, HAS_MIRROR and HAS_ROUGH_METAL.
    """

    shapes: frozenset[str] = _row(lambda it: frozenset(k for k, n in it.facts.shapes.items() if n))
    has_sphere_tree: bool = _row(
        lambda it: it.facts.has_sphere_tree, "tree of spheres", reasons.sphere_tree
    )
    has_tree: bool = _row(  # a BVH over other shapes
        lambda it: bool(it.facts.tree_kinds),
        "tree of shapes",
        reasons.shape_tree,
        shown=lambda needs: needs.has_tree or MESH in needs.shapes,
    )
    has_instance: bool = _row(lambda it: bool(it.facts.instances))  # meshes with own BVHs
    instance_bits: int = _row(lambda it: it.facts.instance_bits, most=0)
    has_smooth: bool = _row(lambda it: it.facts.is_smooth, "smooth normals", reasons.smooth)
    has_hidden_back: bool = _row(  # meshes that rays pass from behind
        lambda it: bool(it.scene.hidden_backs), "hidden backs", reasons.hidden_backs
    )
    has_vertex_color: bool = _row(lambda it: it.facts.is_colored, "vertex colours", reasons.colored)
    has_map: bool = _row(lambda it: bool(it.facts.mapped))  # textures
    has_color_map: bool = _textured("textured color", "color")
    has_emission_map: bool = _textured("textured light", "emission")
    has_gloss_map: bool = _textured("textured gloss", "metallic", "roughness")
    has_normal_map: bool = _textured("normal maps", "normal")
    has_coverage_map: bool = _textured("textured alpha", "alpha")
    has_transmission_map: bool = _textured("textured transmission", "transmission")
    has_hole: bool = _made_of("surface with holes", "holes", lambda it: it.passed)
    has_media: bool = _row(lambda it: it.has_media, "media", reasons.media)
    has_grid: bool = _row(lambda it: it.has_grids, "grids", reasons.grids)
    has_transfer: bool = _row(lambda it: it.has_transfers, "transfer", reasons.transfers)
    marches: bool = _row(lambda it: it.marches, "ray marching", reasons.steps, most=False)
    has_equiangular: bool = _row(  # samples the light of few lamps along segments through media
        lambda it: it.samples_along_segments,
        "along segments",
        reasons.equiangular,
        most=False,
    )
    boundaries: int = _row(lambda it: len(it.facts.media.bounds), most=0)  # of volumes with media
    has_ranks: bool = _row(lambda it: it.has_ranks, "volumes by rank", reasons.ranks, most=False)
    has_mirror: bool = _row(
        lambda it: (
            it.traits.follows
            and any(metal.alpha == 0 or not it.traits.has_rough for metal in it.metals)
        ),
        "mirrors",
        made_of("metal of roughness 0", reasons.metals(is_rough=False)),
    )
    has_rough_metal: bool = _row(
        lambda it: it.traits.has_rough and any(metal.alpha > 0 for metal in it.metals),
        "rough metal",
        made_of("metal with roughness", reasons.metals(is_rough=True)),
    )
    has_conductor: bool = _made_of("measured metal", "conductors", lambda it: it.conductors)
    materials: frozenset[str] = _row(lambda it: it.types)
    has_transmission: bool = _made_of("glass in part", "transmission", lambda it: it.transmitting)
    has_coat: bool = _made_of("principled with clearcoat", "coats", lambda it: it.coated)
    has_anisotropy: bool = _made_of(
        "material with anisotropy", "anisotropy", lambda it: it.anisotropic
    )
    has_iridescence: bool = _made_of("thin film", "iridescence", lambda it: it.iridescent)
    has_sheen: bool = _made_of("surface with sheen", "sheen", lambda it: it.sheened)
    has_translucency: bool = _made_of("translucent", "translucency", lambda it: it.translucent)
    has_rough_glass: bool = _row(
        lambda it: it.traits.follows and it.traits.has_rough and bool(it.facts.rough_glasses),
        "rough glass",
        made_of("rough glass", lambda it: it.facts.rough_glasses),
    )
    has_dispersion: bool = _followed("dispersion", "dispersion", lambda it: it.lobes.dispersing)
    has_pane: bool = _followed("thin glass", "panes", lambda it: it.panes)
    has_attenuation: bool = _followed("tinted glass", "attenuation", lambda it: it.tinted)
    has_nested: bool = _followed("glass with priority", "nested glass", lambda it: it.nested)
    nested_glasses: int = _row(lambda it: len(it.facts.nested) if it.traits.follows else 0, most=0)
    has_lens: bool = _row(
        lambda it: it.traits.has_lens and it.scene.camera.defocus_angle > 0, "lens", reasons.lens
    )
    has_cone: bool = _row(  # lamps that light a cone of directions
        lambda it: bool(it.facts.cones), "cones", reasons.emitting("a cone", lambda it: it.cones)
    )
    has_one_sided: bool = _row(  # lamps that emit from their front alone
        lambda it: bool(it.facts.one_sided),
        "one-sided lamps",
        reasons.emitting("a dark back", lambda it: it.one_sided),
    )
    has_coincident: bool = _row(  # flat lamps that share a place with other surfaces
        lambda it: bool(it.facts.coincidence.pairs),
        "lamps in shared places",
        reasons.coincident,
        most=False,
    )
    has_background: bool = _row(lambda it: it.has_background, "background", reasons.background)
    has_horizon: bool = _row(  # a background of two gradients
        lambda it: it.has_background and len(it.scene.background.gradient) > 2,
        "horizon",
        reasons.horizon,
    )
    has_environment: bool = _row(  # a background given by an image
        lambda it: it.has_image, "image of the sky", reasons.environment, most=False
    )
    sample_sky: bool = _row(  # samples the image of the sky
        lambda it: it.has_image and it.traits.samples_lights,
        "sky sampling",
        reasons.by_method_and_sky,
        most=False,
    )
    has_sun: bool = _row(lambda it: it.has_sun and not it.traits.model, "sun", reasons.sun)
    sample_sun: bool = _row(lambda it: it.has_sun and it.traits.samples_lights, "sun sampling")
    sample_lights: bool = _row(
        lambda it: it.is_lit and it.traits.samples_lights,
        "light sampling",
        reasons.by_method_and_lamps,
    )
    # Kinds that are sampled, or that light surfaces in the classic models.
    lamps: frozenset[str] = _row(lambda it: frozenset(it.facts.sampled if it.is_lit else ()))
    quads_by_area: bool = _row(  # samples lamps evenly by area, not by solid angle
        lambda it: it.is_lit and it.traits.weights_both and it.facts.lamps["quad"] > 0,
        "lamps by area",
        reasons.by_method_and_lamps,
    )
    clusters: int = _row(  # lamps weighed at each point, or clusters of many lamps
        lambda it: it.facts.clusters if it.traits.chooses_lights else 0,
        "near lamps",
        reasons.by_method_and_lamps,
        shown=lambda needs: needs.clusters > 1,
        most=0,
    )
    many_lights: bool = _row(  # more than MOST_NEAR lamps are sampled
        lambda it: it.traits.chooses_lights and it.facts.has_many_lights,
        "lamps in clusters",
        reasons.in_clusters,
    )
    weight_both: bool = _row(
        lambda it: (it.is_lit or it.has_image or it.has_sun) and it.traits.weights_both,
        "both weighted",
        reasons.by_method_and_lamps,
    )
    model: int = _row(  # number of a classic lighting model; 0: paths are traced
        lambda it: it.model, "lighting model", reasons.model, most=0
    )
    own_phong: bool = _row(lambda it: it.own_phong, "own constants", reasons.phong, most=False)
    has_probes: bool = _row(  # indirect light from a grid of probes
        lambda it: it.traits.has_probes, "probes", most=False
    )
    some_probes: bool = _row(lambda it: it.takes_turns, "probes in turn", reasons.turns, most=False)
    final_gather: bool = _row(lambda it: it.traits.gathers, "final gather", most=False)
    resamples: bool = _row(  # keeps one of the points that light the first matte surface
        lambda it: it.resamples, "resampling", reasons.resampling, most=False
    )
    reuses_own: bool = _row(  # reuses the point that the previous sample kept for the pixel
        lambda it: it.reuses and it.settings.reuse in TEMPORAL,
        "reuse",
        reasons.reuse,
        shown=lambda needs: needs.reuses_own or needs.reuses_near > 0,
        most=False,
    )
    reuses_near: int = _row(  # number of pixels around, whose kept points are reused
        lambda it: NEAR if it.reuses and it.settings.reuse in SPATIAL else 0, most=0
    )
    unbiased: bool = _row(  # checks which reused points other pixels could have found
        lambda it: it.reuses and it.settings.unbiased, most=False
    )
    effects: int = _row(  # chosen effects of rays; 0: all light is traced
        lambda it: effect_bits(it.settings), "chosen effects", reasons.effects, most=0
    )
    rasters: bool = _row(  # first surfaces of paths are known from a raster
        lambda it: it.rasters, "rasterisation", reasons.raster, most=False
    )
    has_particles: bool = _row(  # particles from lamps, linked to the camera
        lambda it: it.sends_particles, "particles", reasons.caustics
    )
    casters: int = _row(  # spheres at which some particles are aimed: a bit for each
        lambda it: it.particles.casters if it.aims else 0, most=0
    )
    targets: int = _row(  # number of balls around other shapes at which some particles are aimed
        lambda it: len(it.particles.targets) if it.aims else 0, most=0
    )
    linked: int = _row(  # smooth spheres through which some particles are linked: a bit for each
        lambda it: it.particles.links if it.sends_particles and it.settings.linked else 0,
        "linked spheres",
        reasons.links,
        most=0,
    )
    roulette: bool = _row(
        lambda it: it.settings.roulette and it.traits.follows and not it.traits.splits,
        "roulette",
        reasons.roulette,
    )
    has_net: bool = _row(lambda it: it.settings.sampler == "net", most=False)  # that keep growing
    is_shared: bool = _row(  # each second block has the same random numbers in all pixels
        lambda it: it.settings.division.is_shared, "shared numbers", reasons.sampler, most=False
    )
    adaptive: bool = _row(lambda it: it.adapts, "own counts", reasons.adaptive, most=False)
    block: int = _row(  # samples of a block: 16 or 64 of Sobol's points, 1 of random numbers
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
