"""The views of a render: the picture, or its errors and differences in false colours."""

from typing import Literal, get_args

from glrt.gpu.context import Pipeline
from glrt.rendering.screen.aov_view import MOST_BOUNCES, cell_of, scale_of_bounces
from glrt.rendering.screen.false_colors import (
    DIFFERENCE,
    DROPPED,
    ERROR,
    HISTORY,
    MASK,
    VIRIDIS,
    WEIGHT,
    Number,
    Scale,
    symmetric,
)
from glrt.scene.camera import Camera
from glrt.settings import GUIDES, TERMS, Aov

Filtered = Literal["denoised", "denoised error"]
OfProbes = Literal["probes", "probe distances"]
FilmView = Literal["picture", Filtered, "error", "dropped", "difference", Number, OfProbes]
View = FilmView | Aov
VIEWS: tuple[View, ...] = (*get_args(FilmView), *get_args(Aov))

HELP = (
    "picture: as it will be saved\n"
    "denoised: without its noise, as --denoise makes it, and how wrong that is; files have the "
    "plain picture\n"
    "denoised error: of the denoised picture, about each pixel: noise, and what the filter gets "
    "wrong\n"
    "error: the estimated relative error of each pixel\n"
    "dropped: where samples were not finite and were left out\n"
    "difference: from the kept picture, at equal seeds and samples; what did not change shows no "
    "noise\n"
    "history: while light of earlier views is shown, the samples that each pixel stands for (by "
    "temporal wrls, views); grey where it has none\n"
    "weight: by temporal wrls, how much the new samples count\n"
    "mask: by temporal ataa, where history fails; dark: filtered, green: traced, with history, "
    "yellow: traced alone; grey where history is shown\n"
    "probes: the picture with its probes as balls; each shows by direction the indirect light that "
    "it would bring to a white surface there, so that a leak is seen at once; those "
    "in solids are left out\n"
    "probe distances: the same with how far each sees on average\n"
    "albedo, normal, depth, position, object: of the first surface behind each pixel; they are "
    "gathered while they are shown\n"
    "bounces: how often the paths of a pixel scatter before they end, in the mean\n"
    "emission, direct, indirect: light that scatters never, once, or more often\n"
    "diffuse, glossy, transmission, volume: light that scatters, by what it last meets on its way "
    "to the camera: a matte base, a reflection, a surface that it crosses, a medium"
)
TITLES: dict[View, str] = {
    "denoised": "denoised; files have the plain picture",
    "denoised error": "error of the denoised picture, about a pixel",
    "error": "estimated relative error of a pixel",
    "dropped": "samples dropped, not finite",
    "difference": "luminance against the kept picture",
    "history": "samples (wrls: views) of history; grey: none",
    "weight": "weight of the new samples; grey: no sample",
    "mask": "no history: 1 filtered, 2 and 3 traced; grey: history",
    "probes": "indirect light that probes hold",
    "probe distances": "mean distance that probes see, in scene units",
    "albedo": "albedo of the first surface",
    "normal": "normal, x y z as red green blue around grey",
    "depth": "depth, grey at {focus:.3g}, where the camera focuses",
    "position": "position, x y z as red green blue, again every {cell:g}",
    "object": "a colour for each object",
    "bounces": "bounces of a path until its end, mean",
    "emission": "light that nothing scatters",
    "direct": "light that is scattered once",
    "indirect": "light that is scattered more than once",
    "diffuse": "light that a matte base scatters first",
    "glossy": "light that is first reflected",
    "transmission": "light that first crosses a surface",
    "volume": "light that a medium scatters first",
}


def title_of(view: View, camera: Camera, limit: int | None = None) -> str:
    """Return the title of a view; lengths are in scene units.

    `limit`: the bounces that its paths were traced to, where the picture shows fewer of them.
    """
    focus, cell = camera.resolved_focus_distance, cell_of(camera)
    of_others = limit_text(limit) if view == "bounces" else ""
    return TITLES[view].format(focus=focus, cell=cell) + of_others


def limit_text(limit: int | None) -> str:
    """Return a note that counts are of paths of up to `limit` bounces; "" for None."""
    return "" if limit is None else f", of paths of up to {limit}"


def gathered_for(view: View, pipeline: Pipeline = "compute") -> tuple[Aov, ...]:
    """Return the AOVs that a view needs. Where one pass gathers all terms of light, all are."""
    if is_of_probes(view):
        return ("depth",)
    aov = aov_of(view)
    if aov in TERMS and pipeline == "compute":
        return TERMS
    return GUIDES if is_filtered(view) else (aov,) if aov else ()


def is_filtered(view: View) -> bool:
    """Whether a view shows a result of the denoiser."""
    return view in get_args(Filtered)


def is_of_probes(view: View) -> bool:
    """Whether a view shows probes as balls."""
    return view in get_args(OfProbes)


def aov_of(view: View) -> Aov | None:
    """Return the AOV that a view shows; None if it shows none."""
    return next((aov for aov in get_args(Aov) if aov == view), None)


def number_of(view: View) -> Number | None:
    """Return the number of the temporal history that a view shows; None if it shows none."""
    return next((number for number in get_args(Number) if number == view), None)


def has_scale(view: View) -> bool:
    """Whether a view has false colours, and so a legend with numbers."""
    return view in ("bounces", "denoised error", "probe distances") or not gathered_for(view)


def scale_of(view: View, most: float, bounces: int, farthest: float = 1.0) -> Scale:
    """Return the false-colour scale of a view; `most`: the largest difference on the scale.

    `bounces`: limit of the paths; `farthest`: largest distance in probes, in scene units.
    """
    if view == "bounces":
        return scale_of_bounces(bounces)
    if view == "probe distances":
        return Scale(VIRIDIS, 0.0, farthest, is_logarithmic=False)
    scales: dict[View, Scale] = {"error": ERROR, "denoised error": ERROR, "dropped": DROPPED}
    scales |= {"history": HISTORY, "weight": WEIGHT, "mask": MASK}
    return scales.get(view) or symmetric(DIFFERENCE, most)


def ticks_of(view: View, scale: Scale) -> dict[float, str]:
    """Return the numbers on a scale that have labels, and the labels."""
    if view in ("error", "denoised error"):
        return {0.001: "0.1 %", 0.01: "1 %", 0.1: "10 %", 1.0: "100 %"}
    if view == "dropped":
        return {1.0: "1", 10.0: "10", 100.0: "100", 1000.0: "1000"}
    if view == "history":
        return {1.0: "1", 4.0: "4", 16.0: "16", 64.0: "64 and more"}
    if view == "weight":
        return {0.001: "0.001", 0.01: "0.01", 0.1: "0.1", 1.0: "1"}
    if view == "probe distances":
        return {share * scale.high: f"{share * scale.high:.3g}" for share in (0.0, 0.5, 1.0)}
    if view == "bounces":
        end = f"{scale.high:g}" + (" and more" if scale.high == MOST_BOUNCES else "")
        return {0.0: "0", scale.high / 2: f"{scale.high / 2:g}", scale.high: end}
    shares = [part * scale.high for part in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    return {share: f"{100 * share:+.3g} %" if share else "0" for share in shares}
