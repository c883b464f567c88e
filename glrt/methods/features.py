"""What the kernel must be able to do for a scene and its settings, and nothing else."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

from glrt.scene.materials import Material, Metal
from glrt.scene.scene import Scene
from glrt.settings import Settings
from glrt.text import counted

TREE_FROM = 33  # spheres: more than are baked, and there a tree pays (docs/speed.md)
LADDER = {"phong": 1, "blinn": 2, "whitted": 3, "cook": 4}  # the numbers of ladder.glsl
MOST_NEAR = 32  # lamps that are weighed at each point; of more, so many clusters
NO_LAYERS: dict[str, bool | int] = {"LAYERS": 0, "BY_LENGTH": False, "BACKGROUND_LAYER": 0}


@dataclass(frozen=True)
class Needs:
    """The features compiled into a kernel; each is a constant of its prelude, in upper case."""

    has_sphere: bool
    has_plane: bool
    has_quad: bool
    has_tree: bool
    has_mirror: bool
    has_rough_metal: bool
    has_dielectric: bool
    has_lens: bool
    has_background: bool
    has_sphere_light: bool
    has_quad_light: bool
    sample_lights: bool
    weight_both: bool
    roulette: bool
    model: int  # of the ladder; 0: paths are traced
    many_lights: bool  # more than MOST_NEAR to sample
    clusters: int  # lamps to weigh at each point, or of many clusters of them
    block: int  # samples of an observation: 16 for Sobol's points, 1 for independent numbers

    def constants(self) -> dict[str, bool | int]:
        """The prelude: what the compiler may take for granted."""
        values = {field.name.upper(): getattr(self, field.name) for field in fields(self)}
        return {**values, **NO_LAYERS}


class Feature(NamedTuple):
    """A feature of the kernel, whether it is compiled in, and why."""

    name: str
    present: bool
    reason: str


def needs_of(scene: Scene, settings: Settings) -> Needs:
    """The features that this scene, rendered with these settings, makes use of."""
    shapes = {shape.shape for shape in scene.objects}
    used = list(used_materials(scene).values())
    lamps = {shape.shape for shape in scene.objects if is_light(scene.materials[shape.material])}
    method = settings.method
    chooses = method in ("nee", "mis", "cook")
    is_lit = method != "naive" and bool(lamps & {"sphere", "quad"})
    follows = method not in ("phong", "blinn")  # mirrors and glass
    metals = [m for m in used if m.type == "metal"]
    return Needs(
        has_sphere="sphere" in shapes,
        has_plane="plane" in shapes,
        has_quad="quad" in shapes,
        has_tree=has_tree(scene),
        has_mirror=follows and any(m.alpha == 0 or method == "whitted" for m in metals),
        has_rough_metal=method != "whitted" and any(m.alpha > 0 for m in metals),
        has_dielectric=follows and any(m.type == "dielectric" for m in used),
        has_lens=method not in ("phong", "blinn", "whitted") and scene.camera.defocus_angle > 0,
        has_background=any(map(any, scene.background_colors)),
        has_sphere_light=is_lit and "sphere" in lamps,
        has_quad_light=is_lit and "quad" in lamps,
        sample_lights=is_lit and method in ("nee", "mis"),
        weight_both=is_lit and method == "mis",
        roulette=settings.roulette and follows,
        model=_number_of(method, metals),
        many_lights=chooses and has_many_lights(scene),
        clusters=clusters_of(scene) if chooses else 0,
        block=settings.block,
    )


def has_tree(scene: Scene) -> bool:
    """Whether rays are to find spheres by a tree."""
    return sum(shape.shape == "sphere" for shape in scene.objects) >= TREE_FROM


def _number_of(method: str, metals: Sequence[Metal]) -> int:
    """Of the model; without highlights, the two that differ in their form are one."""
    if method == "blinn" and not any(metal.alpha > 0 for metal in metals):
        return LADDER["phong"]
    return LADDER.get(method, 0)


def has_many_lights(scene: Scene) -> bool:
    """Whether there are more lamps than are weighed one by one."""
    return sampled_lamps(scene) > MOST_NEAR


def sampled_lamps(scene: Scene) -> int:
    """How many lamps can be sampled: all but planes."""
    return sum(
        shape.shape != "plane" and is_light(scene.materials[shape.material])
        for shape in scene.objects
    )


def clusters_of(scene: Scene) -> int:
    """How many clusters of lamps are weighed at each point; of few lamps each is one."""
    return min(sampled_lamps(scene), MOST_NEAR)


def is_light(material: Material) -> bool:
    """Whether a material emits."""
    return material.type == "light"


def used_materials(scene: Scene) -> dict[str, Material]:
    """The materials that some object is made of, in the order of the scene file."""
    names = {shape.material for shape in scene.objects}
    return {name: material for name, material in scene.materials.items() if name in names}


def explain(scene: Scene, settings: Settings) -> list[Feature]:
    """Every feature of the kernel: in or out, and what in the scene decides that."""
    needs = needs_of(scene, settings)
    used = used_materials(scene)

    def made_of(kind: str, **limits: bool) -> list[str]:
        return [name for name, m in used.items() if m.type == kind and _matches(m, limits)]

    def shapes(kind: str) -> str:
        return counted(sum(1 for shape in scene.objects if shape.shape == kind), kind)

    lens, method = scene.camera.defocus_angle, settings.method
    mirrors, rough = made_of("metal", rough=False), made_of("metal", rough=True)
    lamps = _lamps(scene)
    return [
        Feature("spheres", needs.has_sphere, shapes("sphere")),
        Feature("tree", needs.has_tree, f"{shapes('sphere')}; it pays from {TREE_FROM} on"),
        Feature("planes", needs.has_plane, shapes("plane")),
        Feature("quads", needs.has_quad, shapes("quad")),
        Feature("mirrors", needs.has_mirror, _made_of(mirrors, "metal of roughness 0")),
        Feature("rough metal", needs.has_rough_metal, _made_of(rough, "metal with roughness")),
        Feature("glass", needs.has_dielectric, _made_of(made_of("dielectric"), "dielectric")),
        Feature("lens", needs.has_lens, f"camera.defocus_angle is {lens:g}"),
        Feature("background", needs.has_background, _background(scene)),
        Feature("light sampling", needs.sample_lights, f"method {method}, {lamps}"),
        Feature("sphere lamps", needs.has_sphere_light, f"method {method}, {lamps}"),
        Feature("quad lamps", needs.has_quad_light, f"method {method}, {lamps}"),
        Feature("near lamps", needs.clusters > 1, f"method {method}, {lamps}"),
        Feature("lamps in clusters", needs.many_lights, f"{lamps}; from {MOST_NEAR + 1} on"),
        Feature("both weighted", needs.weight_both, f"method {method}, {lamps}"),
        Feature("lighting model", needs.model > 0, _model(settings)),
        Feature("roulette", needs.roulette, _roulette(settings)),
        Feature("Sobol points", needs.block > 1, f"sampler {settings.sampler}"),
    ]


def _matches(material: Material, limits: dict[str, bool]) -> bool:
    rough = getattr(material, "alpha", 0.0) > 0
    return all(rough == wanted for wanted in limits.values())


def _made_of(names: Iterable[str], kind: str) -> str:
    listed = ", ".join(names)
    return f"{kind}: {listed}" if listed else f"nothing is {kind}"


def _background(scene: Scene) -> str:
    return "its light is not black" if any(map(any, scene.background_colors)) else "black"


def _model(settings: Settings) -> str:
    traces = settings.method not in LADDER
    return f"method {settings.method}{' traces paths' if traces else ', which leaves light out'}"


def _roulette(settings: Settings) -> str:
    if not settings.roulette:
        return "turned off"
    return "turned on; for paths whose throughput is below 1/4"


def _lamps(scene: Scene) -> str:
    lit = [s.shape for s in scene.objects if is_light(scene.materials[s.material])]
    kinds = [counted(lit.count(kind), f"{kind} lamp") for kind in ("sphere", "quad", "plane")]
    return ", ".join(text for text in kinds if not text.startswith("no ")) or "no lamp"
