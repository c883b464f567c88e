"""The combinations of method, bounces, roulette and sampler that a chart compares."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, get_args

from glrt.denoise import oidn
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.methods import METHODS as TRAITS
from glrt.plan.methods import traits_of
from glrt.plan.particle_refusals import refusal
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.scene.grids import edges_of_voxels
from glrt.scene.scene import Scene
from glrt.settings import Method, Sampler, Settings, settings_for

METHODS: tuple[str, ...] = get_args(Method)
LEAD = "mis"  # the method whose variants are charted
ADAPTIVE = f"{LEAD}, adaptive"  # measured where it is asked for
LINKED = {"particles": 0.35, "aimed": 0.2, "linked": 1.0}  # particles that are linked, too
LONGER = 8  # times the step of a method that marches
LIVE = "ddgi, live probes"
SAMPLERS: tuple[Sampler, ...] = ("sobol", "sobol64", "shared", "independent")  # for short renders
FEW_BOUNCES, MANY_TIMES, MOST_BOUNCES = (1, 2, 5), 8, 256


@dataclass(frozen=True)
class Variant:
    """Settings with the name under which they are reported."""

    name: str
    settings: Settings
    hysteresis: float | None = None  # of live probes, which continue from picture to picture


def variants_of(
    scene: Scene, settings: Settings, methods: Sequence[str] = METHODS, leads: bool = True
) -> list[Variant]:
    """Return a variant for every method; with `leads`, also variants of the method LEAD.

    Variants of LEAD have few or many bounces, no roulette, another sampler, particles, or a
    denoiser. Variants that the same kernel renders, such as all methods in a scene without lamps,
    are merged into one, "a = b = c".
    """
    facts = SceneFacts(scene)
    methods = [it for it in methods if not _lacks_media(facts, settings, it)]
    named = [_of_method(it, settings) for it in methods if not TRAITS[it].marches]
    named += _marched(facts, settings, methods)
    if leads:
        named += _variants_of_lead(settings)
        named += _with_particles(facts, settings)
        named += _denoised()
    found: dict[Any, Variant] = {}
    for name, changes in named:
        wanted = settings_for(settings, **changes)
        step = wanted.march_step if TRAITS[wanted.method].marches else None
        key = (needs_of(facts, wanted), wanted.bounces, wanted.sampler, wanted.denoise, step)
        known = found.get(key)
        found[key] = (
            Variant(f"{known.name} = {name}", known.settings) if known else Variant(name, wanted)
        )
    return list(found.values())


def adaptive_of(settings: Settings) -> Variant:
    """Return the variant of LEAD whose pixels get samples in proportion to their noise."""
    return Variant(ADAPTIVE, settings_for(settings, method=LEAD, adaptive="on"))


def live_variant(scene: Scene, settings: Settings) -> Iterator[Variant]:
    """Probes as the window has them while a scene is at rest, if the scene can have probes.

    Each picture updates them once, and goes on from the updates before it, whose time is not its
    own. So the variant is no rival of the others.
    """
    if not _lacks_media(SceneFacts(scene), settings, "ddgi"):
        _, changes = _of_method("ddgi", settings)
        yield Variant(LIVE, settings_for(settings, **changes), HYSTERESIS)


def _lacks_media(facts: SceneFacts, settings: Settings, method: str) -> bool:
    """Whether the scene has media, and the method refuses them or leaves them out."""
    traits = traits_of(settings_for(settings, method=method))
    leaves_out = traits.has_probes or traits.rasters or traits.model > 0
    return bool(facts.media.names) and leaves_out


def _of_method(method: str, settings: Settings) -> tuple[str, dict[str, Any]]:
    """A method without changes; a method with probes gets the sampler that it needs."""
    has_probes = traits_of(settings_for(settings, method=method)).has_probes
    if not has_probes or settings.block > 1:
        return method, {"method": method}
    return f"{method}, sobol", {"method": method, "sampler": "sobol"}


def _marched(
    facts: SceneFacts, settings: Settings, methods: Sequence[str]
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Variants of the methods that march, where there is a grid: short steps and long ones."""
    for method in methods:
        if TRAITS[method].marches and facts.media.grids:
            yield method, {"method": method}
            edge = max(max(edges_of_voxels(facts.scene, name)) for name in facts.media.grids)
            step = settings.march_step or edge
            longer = {"method": method, "march_step": LONGER * step}
            yield f"{method}, {LONGER} times the step", longer


def _with_particles(facts: SceneFacts, settings: Settings) -> Iterator[tuple[str, dict[str, Any]]]:
    """Variants with particles, where there is glass or metal to aim them at.

    And with links, where there are spheres to link them through.
    """
    changes: dict[str, Any] = {"method": LEAD, "caustics": "on", "linked": 0.0}
    if not facts.particles.casters or refusal(facts, settings_for(settings, **changes)):
        return
    yield f"{LEAD}, particles", changes
    if facts.particles.links:
        yield f"{LEAD}, particles linked", {**changes, **LINKED}


def _denoised() -> Iterator[tuple[str, dict[str, Any]]]:
    """A variant for each denoiser that is installed."""
    yield f"{LEAD}, denoised by nlm", {"method": LEAD, "denoise": "nlm"}
    if oidn.is_installed():
        yield f"{LEAD}, denoised by oidn", {"method": LEAD, "denoise": "oidn"}


def _variants_of_lead(settings: Settings) -> Iterator[tuple[str, dict[str, Any]]]:
    few = [bounces for bounces in FEW_BOUNCES if bounces < settings.bounces]
    for bounces in [*few, min(MANY_TIMES * settings.bounces, MOST_BOUNCES)]:
        plural = "" if bounces == 1 else "s"
        yield f"{LEAD}, {bounces} bounce{plural}", {"method": LEAD, "bounces": bounces}
    if settings.roulette:
        yield f"{LEAD}, no roulette", {"method": LEAD, "roulette": False}
    for sampler in SAMPLERS:
        if sampler != settings.sampler:
            yield f"{LEAD}, {sampler}", {"method": LEAD, "sampler": sampler}
