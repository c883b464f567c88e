"""What the kernel must be able to do for a scene and its settings, and nothing else."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

from glrt.methods.contents import (
    ENDLESS,
    MESH,
    MOST_NEAR,
    REST_FROM,
    SAMPLED,
    SPHERES_FROM,
    TREE_FROM,
    Contents,
    contents_of,
)
from glrt.methods.table import CLASSIC, METHODS
from glrt.scene.materials import TYPES, Material, Metal
from glrt.scene.scene import Scene
from glrt.scene.shapes import KINDS
from glrt.scene.summary import few
from glrt.settings import Settings
from glrt.text import counted, plural

NO_TREE: dict[str, bool | int] = {"TREE_STACK": 0}  # what the tree needs is known once it stands
NO_LAYERS: dict[str, bool | int] = {"LAYERS": 0, "BY_LENGTH": False, "BACKGROUND_LAYER": 0}


@dataclass(frozen=True)
class Needs:
    """The features compiled into a kernel; each is a constant of its prelude, in upper case.

    `shapes`, `materials` and `lamps` become HAS_SPHERE, HAS_SPHERE_LIGHT and so on, one for each
    kind and type there is, but for matte surfaces, which are always there, and metal, of which
    there are two sorts.
    """

    shapes: frozenset[str]
    materials: frozenset[str]
    lamps: frozenset[str]  # kinds that are sampled, or lit by in the classic models
    has_sphere_tree: bool
    has_tree: bool  # over other shapes
    has_smooth: bool  # meshes whose normals are interpolated
    has_vertex_color: bool  # meshes whose vertices have colours
    has_mirror: bool
    has_rough_metal: bool
    has_conductor: bool  # metal whose reflectance depends on the angle
    has_lens: bool
    has_cone: bool  # lamps that light a cone of directions
    has_one_sided: bool  # lamps that emit from their front alone
    has_background: bool
    has_horizon: bool  # a background of two gradients
    has_environment: bool  # a background in an image
    sample_lights: bool
    weight_both: bool
    quads_by_area: bool  # points on lamps even in area, not in solid angle
    roulette: bool
    model: int  # of those before path tracing; 0: paths are traced
    many_lights: bool  # more than MOST_NEAR to sample
    clusters: int  # lamps to weigh at each point, or of many clusters of them
    block: int  # samples of an observation: 16 for Sobol's points, 1 for independent numbers

    def constants(self) -> dict[str, bool | int]:
        """The prelude: what the compiler may take for granted."""
        kinds = {f"HAS_{kind.upper()}": kind in self.shapes for kind in KINDS}
        own = [name for name in TYPES if name not in _WITHOUT_OWN_FLAG]
        types = {f"HAS_{name.upper()}": name in self.materials for name in own}
        lamps = {f"HAS_{kind.upper()}_LIGHT": kind in self.lamps for kind in SAMPLED}
        plain = [field.name for field in fields(self) if field.name not in _SETS]
        values = {name.upper(): getattr(self, name) for name in plain}
        return {**kinds, **types, **lamps, **values, **NO_LAYERS, **NO_TREE, "COUNT_RAYS": False}


def everything() -> dict[str, bool | int]:
    """The constants of a kernel with every feature, for functions that are tried alone.

    Paths are traced; lamps are chosen as in the scene that the caller names, or not at all. The sky
    has two gradients and no image, which would take their place.
    """
    plain: Any = {field.name: field.name != "has_environment" for field in fields(Needs)}
    sets = {name: frozenset(all_) for name, all_ in _SETS.items()}
    return Needs(**{**plain, **sets, "model": 0, "clusters": 0, "block": 1}).constants()


_SETS = {"shapes": KINDS, "materials": TYPES, "lamps": SAMPLED}
_WITHOUT_OWN_FLAG = ("lambertian", "light", "metal")


class Feature(NamedTuple):
    """A feature of the kernel, whether it is compiled in, and why."""

    name: str
    present: bool
    reason: str


def needs_of(scene: Scene, settings: Settings, contents: Contents | None = None) -> Needs:
    """The features that this scene, rendered with these settings, makes use of."""
    found = contents or contents_of(scene)
    traits = METHODS[settings.method]
    is_lit = traits.uses_lamps and found.sampled_lamps > 0
    metals = [m for m in found.materials.values() if m.type == "metal"]
    types = {m.type for m in found.materials.values() if traits.follows or not m.is_transparent}
    return Needs(
        shapes=frozenset(kind for kind, count in found.shapes.items() if count),
        materials=frozenset(types),
        lamps=frozenset(found.sampled if is_lit else ()),
        has_sphere_tree=found.has_sphere_tree,
        has_tree=bool(found.tree_kinds),
        has_smooth=found.is_smooth,
        has_vertex_color=found.is_colored,
        has_mirror=traits.follows
        and any(m.alpha == 0 or not traits.has_rough_metal for m in metals),
        has_rough_metal=traits.has_rough_metal and any(m.alpha > 0 for m in metals),
        has_conductor=bool(found.conductors),
        has_lens=traits.has_lens and scene.camera.defocus_angle > 0,
        has_cone=bool(found.cones),
        has_one_sided=bool(found.one_sided),
        has_background=any(map(any, scene.background_colors)),
        has_horizon=any(map(any, scene.background_colors)) and len(scene.background.gradient) > 2,
        has_environment=any(map(any, scene.background_colors)) and bool(scene.background.image),
        sample_lights=is_lit and traits.samples_lights,
        weight_both=is_lit and traits.weights_both,
        quads_by_area=is_lit and traits.weights_both and found.lamps["quad"] > 0,
        roulette=settings.roulette and traits.follows,
        model=_model_number(settings.method, metals),
        many_lights=traits.chooses_lights and found.has_many_lights,
        clusters=found.clusters if traits.chooses_lights else 0,
        block=settings.block,
    )


def _model_number(method: str, metals: Sequence[Metal]) -> int:
    """Of the model; without highlights, the two that differ in their form are one."""
    if method == "blinn" and not any(metal.alpha > 0 for metal in metals):
        return METHODS["phong"].model
    return METHODS[method].model


def explain(scene: Scene, settings: Settings) -> list[Feature]:
    """Every feature of the kernel: in or out, and what in the scene decides that."""
    found = contents_of(scene)
    needs = needs_of(scene, settings, found)
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
        Feature("mirrors", needs.has_mirror, _made_of(mirrors, "metal of roughness 0")),
        Feature("rough metal", needs.has_rough_metal, _made_of(rough, "metal with roughness")),
        Feature("conductors", needs.has_conductor, _made_of(found.conductors, "measured metal")),
        *(
            Feature(_SPOKEN.get(name, name), name in needs.materials, _made_of(made_of(name), name))
            for name in TYPES
            if name not in _WITHOUT_OWN_FLAG
        ),
        Feature("lens", needs.has_lens, f"camera.defocus_angle is {lens:g}"),
        Feature("cones", needs.has_cone, _lamps_with("a cone", found.cones)),
        Feature("one-sided lamps", needs.has_one_sided, _lamps_with("one side", found.one_sided)),
        Feature("background", needs.has_background, _background(scene)),
        Feature("horizon", needs.has_horizon, _horizon(scene)),
        Feature("image of the sky", needs.has_environment, _environment(scene)),
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
        Feature("roulette", needs.roulette, _roulette(settings)),
        Feature("Sobol points", needs.block > 1, f"sampler {settings.sampler}"),
    ]


_SPOKEN = {"dielectric": "glass"}


def _matches(material: Material, limits: dict[str, bool]) -> bool:
    rough = getattr(material, "alpha", 0.0) > 0
    return all(rough == wanted for wanted in limits.values())


def _of(count: str, least: int) -> str:
    return f"{count}; it pays from {least} on"


def _tree(found: Contents) -> str:
    if found.tree_kinds or found.triangles:
        listed = [counted(found.shapes[kind], kind) for kind in found.tree_kinds]
        listed += [counted(found.triangles, "triangle")] if found.triangles else []
        return f"over {', '.join(listed)}"
    rest = [kind for kind in KINDS if kind not in (*ENDLESS, MESH)]
    if found.has_sphere_tree:
        count = counted(found.count_of(kind for kind in rest if kind != "sphere"), "other shape")
        return _of(count, REST_FROM)
    return _of(counted(found.count_of(rest), "bounded shape"), TREE_FROM)


def _smooth(found: Contents) -> str:
    return "a mesh has smooth = true" if found.is_smooth else "no mesh has smooth = true"


def _colored(found: Contents) -> str:
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
    image = scene.background.image
    if image is None:
        return "background.image is not given"
    return f"background.image is {image.file}; it is found by scattering alone"


def _model(settings: Settings) -> str:
    traces = settings.method not in CLASSIC
    return f"method {settings.method}{' traces paths' if traces else ', which leaves light out'}"


def _roulette(settings: Settings) -> str:
    if not settings.roulette:
        return "turned off"
    return "turned on; for paths whose throughput is below 1/4"


def _lamps(found: Contents) -> str:
    named = (
        counted(count, f"{kind} lamp") + ("" if kind in found.sampled else " (by scattering alone)")
        for kind, count in found.lamps.items()
        if count
    )
    return ", ".join(named) or "no lamp"
