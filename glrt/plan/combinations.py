"""A table of the render options that work together.

Each pair of options works, or is refused with a reason before anything compiles. A pair that the
table does not name is refused, so whoever adds an option tries every pair first.
docs/reference/combinations.md is generated from this table, and a test tries every cell.
"""

from collections.abc import Collection, Iterator
from enum import StrEnum
from itertools import combinations

from glrt.core.errors import UsageError
from glrt.plan.band_refusals import NOT_IN_BANDS
from glrt.plan.facts import SceneFacts
from glrt.plan.methods import METHODS, reuses_points, traits_of
from glrt.plan.particle_refusals import refusal
from glrt.plan.plan import Layering
from glrt.plan.shared_refusals import NOT_SHARED
from glrt.scene.summary import few
from glrt.settings import TERMS, Settings


class Way(StrEnum):
    """An option that departs from a plain render; its value is its name in messages."""

    CROP = "a crop"
    RESUME = "--resume"
    PART = "a part of a render"
    MERGED = "a merged picture"
    AOV = "AOVs"
    TERMS = "terms of light"
    LAYERS = "light by layers"
    FRAGMENT = "the fragment pipeline"
    INDEPENDENT = "the independent sampler"
    SHARED = "--sampler shared"
    ADAPTIVE = "--adaptive on"
    CLASSIC = "a classic lighting model"
    PROBES = "a method with probes"
    REUSE = "reuse of points"
    HYBRID = "the method hybrid"
    MARCH = "the method march"
    PARTICLES = "--caustics on"
    PILOT = "--caustics auto"
    DENOISE = "--denoise"
    AUTO = "--method auto"
    TIME = "--time"
    ERROR = "--error"
    SHUTTER = "an open shutter"
    CLUSTER = "--cluster of glrt render"


MEANINGS: dict[Way, str] = {
    Way.CROP: "`--crop`: a part of the frame",
    Way.RESUME: "`--resume`: go on from a picture",
    Way.PART: "`--part`: a range of the samples",
    Way.MERGED: "a picture of `glrt merge`, rendered again",
    Way.AOV: "`--aov`: albedo, normal, depth, position, object, bounces",
    Way.TERMS: f"`--aov`: {', '.join(TERMS)}",
    Way.LAYERS: "a picture relit in the window, and the window's film",
    Way.FRAGMENT: "`--pipeline fragment`, for OpenGL 4.1",
    Way.INDEPENDENT: "`--sampler independent`",
    Way.SHARED: "`--sampler shared`: random numbers that pixels share",
    Way.ADAPTIVE: "`--adaptive on`: samples in proportion to the noise of pixels",
    Way.CLASSIC: "`--method phong`, `blinn`, `whitted`, `whitted_tree`, `cook`",
    Way.PROBES: "`--method ddgi`, `gather`, `resampled`: indirect light from probes",
    Way.REUSE: "`--method resampled`, unless `--reuse none`: points that other samples have kept",
    Way.HYBRID: "`--method hybrid`: first surfaces by rasterisation, and chosen effects of rays; "
    "with the effect gi it has probes, too",
    Way.MARCH: "`--method march`: media with a grid in steps of a fixed length",
    Way.PARTICLES: "`--caustics on`: particles from lamps",
    Way.PILOT: "`--caustics auto`, the default: particles where a pilot finds that they pay",
    Way.DENOISE: "`--denoise`: a picture without its noise, with the error that is left",
    Way.AUTO: "`--method auto`: the cheapest that reaches `--error`",
    Way.TIME: "`--time`: end after some seconds",
    Way.ERROR: "`--error`: end at an error",
    Way.SHUTTER: "`shutter` of `[camera]`, in a scene that moves: motion blur",
    Way.CLUSTER: "`--cluster` of `glrt render`: bands of the picture by workers",
}

# For each option: the options above it that it works with.
_WORKS: dict[Way, tuple[Way, ...]] = {
    Way.CROP: (),
    Way.RESUME: (Way.CROP,),
    Way.PART: (Way.CROP, Way.RESUME),
    Way.MERGED: (Way.CROP, Way.PART),
    Way.AOV: (Way.CROP, Way.RESUME, Way.PART, Way.MERGED),
    Way.TERMS: (Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV),
    Way.LAYERS: (Way.CROP, Way.AOV),
    Way.FRAGMENT: (Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.TERMS),
    Way.INDEPENDENT: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.LAYERS, Way.FRAGMENT),
        Way.TERMS,
    ),
    Way.SHARED: (Way.RESUME, Way.PART, Way.MERGED),
    Way.ADAPTIVE: (Way.RESUME, Way.INDEPENDENT),
    Way.CLASSIC: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.LAYERS, Way.FRAGMENT),
        *(Way.TERMS, Way.INDEPENDENT),
    ),
    Way.PROBES: (Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.TERMS),
    Way.REUSE: (Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.PROBES),
    Way.HYBRID: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.LAYERS, Way.FRAGMENT),
        *(Way.TERMS, Way.INDEPENDENT, Way.PROBES),
    ),
    Way.MARCH: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.LAYERS, Way.FRAGMENT),
        *(Way.TERMS, Way.INDEPENDENT),
    ),
    Way.PARTICLES: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.LAYERS, Way.INDEPENDENT),
        Way.SHARED,
    ),
    Way.PILOT: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.LAYERS, Way.FRAGMENT),
        *(Way.TERMS, Way.INDEPENDENT, Way.CLASSIC, Way.PROBES, Way.REUSE, Way.HYBRID),
        *(Way.MARCH, Way.SHARED, Way.ADAPTIVE),
    ),
    Way.DENOISE: (
        *(Way.CROP, Way.RESUME, Way.AOV, Way.LAYERS, Way.FRAGMENT, Way.INDEPENDENT),
        *(Way.CLASSIC, Way.PROBES, Way.REUSE, Way.PARTICLES, Way.PILOT, Way.TERMS),
        *(Way.HYBRID, Way.MARCH),
    ),
    Way.AUTO: (Way.CROP, Way.AOV, Way.TERMS, Way.FRAGMENT, Way.INDEPENDENT, Way.PILOT),
    Way.TIME: (
        *(Way.CROP, Way.RESUME, Way.AOV, Way.LAYERS, Way.FRAGMENT, Way.INDEPENDENT),
        *(Way.CLASSIC, Way.PROBES, Way.REUSE, Way.PARTICLES, Way.PILOT, Way.DENOISE, Way.AUTO),
        *(Way.TERMS, Way.HYBRID, Way.MARCH, Way.SHARED, Way.ADAPTIVE),
    ),
    Way.ERROR: (
        *(Way.CROP, Way.RESUME, Way.AOV, Way.LAYERS, Way.FRAGMENT, Way.INDEPENDENT),
        *(Way.CLASSIC, Way.PROBES, Way.REUSE, Way.PARTICLES, Way.PILOT, Way.DENOISE, Way.AUTO),
        *(Way.TERMS, Way.TIME, Way.HYBRID, Way.MARCH, Way.SHARED, Way.ADAPTIVE),
    ),
    Way.SHUTTER: (
        *(Way.CROP, Way.RESUME, Way.PART, Way.MERGED, Way.AOV, Way.TERMS, Way.FRAGMENT),
        *(Way.CLASSIC, Way.HYBRID, Way.MARCH, Way.PILOT, Way.DENOISE, Way.TIME, Way.ERROR),
    ),
    Way.CLUSTER: (
        *(Way.CROP, Way.AOV, Way.TERMS, Way.FRAGMENT, Way.INDEPENDENT, Way.CLASSIC),
        *(Way.HYBRID, Way.MARCH, Way.PILOT, Way.SHUTTER),
    ),
}

_LENGTH = "which samples a part has follows from their number in all: give --samples"
_EQUAL = "it needs equal counts of samples in all pixels: leave out --adaptive"
_UNPROVEN = "--adaptive is proven for paths by compute shaders alone: leave it out"
_OF_EQUAL = (Way.PART, Way.MERGED, Way.AOV, Way.TERMS, Way.LAYERS, Way.DENOISE)
_METHODS = (Way.CLASSIC, Way.PROBES, Way.REUSE, Way.HYBRID, Way.MARCH)
_UNPROVEN_TOO = (*_METHODS, Way.FRAGMENT, Way.PARTICLES)
_WITH_PROBES = {Way.PROBES, Way.REUSE}, {Way.PROBES, Way.HYBRID}  # methods that have probes
_SHARED = "the 16 samples of a block share their probes, so that they are one observation"
_REFUSED: dict[frozenset[Way], str] = {
    **{frozenset({way, Way.INDEPENDENT}): _SHARED for way in (Way.PROBES, Way.REUSE)},
    **{
        frozenset(pair): "each is a method"
        for pair in combinations(_METHODS, 2)
        if {*pair} not in _WITH_PROBES
    },
    **{
        frozenset({Way.PARTICLES, way}): "particles are weighed by the method mis alone"
        for way in _METHODS
    },
    **{frozenset({Way.ADAPTIVE, way}): _EQUAL for way in _OF_EQUAL},
    **{frozenset({Way.ADAPTIVE, way}): _UNPROVEN for way in _UNPROVEN_TOO},
    frozenset({Way.ADAPTIVE, Way.CROP}): "counts follow from pixels beyond the crop, too",
    frozenset({Way.ADAPTIVE, Way.AUTO}): "it measures methods at equal samples: name a method",
    frozenset({Way.MERGED, Way.RESUME}): "a plain render adds its samples in another order",
    frozenset({Way.LAYERS, Way.RESUME}): "the picture lacks the layers that it was summed from",
    frozenset({Way.LAYERS, Way.PART}): "a part holds the sum alone: save the scene and render that",
    frozenset({Way.LAYERS, Way.MERGED}): "a part holds the sum alone",
    frozenset({Way.LAYERS, Way.FRAGMENT}): "a fragment shader writes to too few textures for them",
    frozenset({Way.TERMS, Way.LAYERS}): "its terms were traced before the lamps changed: save "
    "the scene and render that",
    frozenset({Way.TERMS, Way.REUSE}): "a reused point is lit by direct and indirect light at once",
    frozenset({Way.TERMS, Way.PARTICLES}): "particles add their light to the picture alone",
    frozenset({Way.PARTICLES, Way.FRAGMENT}): "a fragment shader adds to its own pixel alone",
    frozenset({Way.PROBES, Way.LAYERS}): "probes hold the light of all lamps in one",
    frozenset({Way.PROBES, Way.FRAGMENT}): "compute shaders fill the probes",
    frozenset({Way.PROBES, Way.AUTO}): "it chooses among methods that leave no light out",
    frozenset({Way.REUSE, Way.CROP}): "a sample asks pixels around, beyond the crop, too",
    frozenset({Way.REUSE, Way.LAYERS}): "probes hold the light of all lamps in one",
    frozenset({Way.REUSE, Way.FRAGMENT}): "compute shaders fill the probes",
    frozenset({Way.REUSE, Way.AUTO}): "it chooses among methods that leave no light out",
    frozenset({Way.HYBRID, Way.AUTO}): "it chooses among methods that leave no light out",
    frozenset({Way.MARCH, Way.AUTO}): "it has a method of its own: leave out --method auto",
    frozenset({Way.PARTICLES, Way.AUTO}): "particles are weighed by the method mis alone: name it",
    frozenset({Way.PARTICLES, Way.PILOT}): "the one leaves open what the other says",
    frozenset({Way.AUTO, Way.RESUME}): "the picture has its method: leave out --method auto",
    frozenset({Way.AUTO, Way.PART}): "each part might choose another method: name one",
    frozenset({Way.AUTO, Way.MERGED}): "its parts have their method: leave out --method auto",
    frozenset({Way.AUTO, Way.LAYERS}): "its layers were traced by one method: leave it out",
    frozenset({Way.AUTO, Way.CLASSIC}): "it chooses among methods that leave no light out",
    **{frozenset({a, b}): _LENGTH for a in (Way.TIME, Way.ERROR) for b in (Way.PART, Way.MERGED)},
    frozenset({Way.DENOISE, Way.PART}): "it compares halves of all samples: render without parts",
    frozenset({Way.DENOISE, Way.MERGED}): "halves of all samples cannot be found from its parts",
    frozenset({Way.DENOISE, Way.AUTO}): "it chooses by the error of plain pictures: name a method",
}
_REFUSED |= {
    frozenset({Way.SHUTTER, way}): f"{why}: close the shutter by `shutter = 0`"
    for way, why in {
        Way.INDEPENDENT: "its samples share no even times, so that all pixels would err alike",
        Way.LAYERS: "the window's film shows one time",
        Way.PROBES: "probes hold the light of one time",
        Way.REUSE: "probes hold the light of one time",
        Way.PARTICLES: "particles are followed for many samples at once, which see one time",
        Way.AUTO: "it measures a picture of one time",
        Way.ADAPTIVE: "pixels of other counts would see other times",
    }.items()
}
_REFUSED |= {frozenset({Way.CLUSTER, Way[name]}): why for name, why in NOT_IN_BANDS.items()}
_REFUSED |= {frozenset({Way.SHARED, Way[name]}): why for name, why in NOT_SHARED.items()}
_UNTRIED = "nobody has tried the two together"


def works(one: Way, other: Way) -> bool:
    """Return whether two options work together."""
    return other in _WORKS.get(one, ()) or one in _WORKS.get(other, ())


def reason(one: Way, other: Way) -> str:
    """Return why two options are refused together."""
    return _REFUSED.get(frozenset({one, other}), _UNTRIED)


def pairs() -> Iterator[tuple[Way, Way]]:
    """Yield every pair of options: the cells of the table."""
    return combinations(Way, 2)


def check(ways: Collection[Way]) -> None:
    """Raise UsageError for the first two options that do not work together."""
    for one, other in combinations([way for way in Way if way in ways], 2):
        if not works(one, other):
            first = one[:1].upper() + one[1:]
            rest = other if one is Way.PROBES else one
            is_light = Way.PROBES in (one, other) and Way.HYBRID in ways and works(Way.HYBRID, rest)
            advice = " Leave gi out of the effects." if is_light else ""
            why = reason(one, other)
            raise UsageError(f"{first} and {other} do not go together: {why}.{advice}")


def check_render(
    facts: SceneFacts,
    settings: Settings,
    layering: Layering,
    is_part: bool,
    is_fragment: bool,
    is_blurred: bool = False,
) -> None:
    """Raise UsageError if a renderer cannot combine these options, or cannot follow particles."""
    more = {Way.PART: is_part, Way.FRAGMENT: is_fragment, Way.SHUTTER: is_blurred}
    check(ways_of(settings, layering) | {way for way, is_asked in more.items() if is_asked})
    traits = traits_of(settings)
    if facts.media.names and (traits.has_probes or traits.rasters):
        why = "a raster finds" if traits.rasters else "its probes hold the light of"
        raise UsageError(
            f"Method {settings.method} does not go with media ({few(facts.media.names)}): {why} "
            "surfaces alone. Use the method mis, nee or naive."
        )
    if traits.marches and (problem := facts.media.beyond_steps(settings.march_step)):
        raise UsageError(problem)
    if settings.method == "resampled" and settings.terms:
        raise UsageError(
            "Method resampled does not sort its light into terms: one point stands for direct and "
            "indirect light. Use the method gather, or leave the terms out of --aov."
        )
    if reason := refusal(facts, settings):
        raise UsageError(f"--caustics on does not fit here: {reason}. Leave it out.")


def ways_of(settings: Settings, layering: Layering = "none") -> set[Way]:
    """Return the options that settings and light layers ask for."""
    found = {
        Way.CROP: settings.crop is not None,
        Way.AOV: bool(settings.aov),
        Way.TERMS: bool(settings.terms),
        Way.LAYERS: layering != "none" and not settings.terms,  # a plan with terms is not relit
        Way.INDEPENDENT: settings.sampler == "independent",
        Way.SHARED: settings.division.is_shared,
        Way.ADAPTIVE: settings.adaptive == "on",
        Way.CLASSIC: METHODS[settings.method].model != 0,
        Way.PROBES: traits_of(settings).has_probes,
        Way.REUSE: reuses_points(settings),
        Way.HYBRID: METHODS[settings.method].rasters,
        Way.MARCH: METHODS[settings.method].marches,
        Way.PARTICLES: settings.caustics == "on",
        Way.DENOISE: settings.denoise != "none",
    }
    return {way for way, is_asked in found.items() if is_asked}
