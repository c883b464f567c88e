"""The views of a render: the picture, or its errors and differences in false colours."""

from typing import Literal

from glrt.rendering.false_colors import DIFFERENCE, DROPPED, ERROR, Scale, symmetric

View = Literal["picture", "error", "dropped", "difference"]

HELP = (
    "picture: as it will be saved\n"
    "error: the estimated relative error of each pixel\n"
    "dropped: where samples were not finite and were left out\n"
    "difference: from the kept picture, at equal seeds and samples; what did not change shows no "
    "noise"
)
TITLES: dict[View, str] = {
    "error": "estimated relative error of a pixel",
    "dropped": "samples dropped, not finite",
    "difference": "luminance against the kept picture",
}


def scale_of(view: View, most: float) -> Scale:
    """The scale of a view in false colours; `most`: the largest difference that is told apart."""
    scales: dict[View, Scale] = {"error": ERROR, "dropped": DROPPED}
    return scales.get(view) or symmetric(DIFFERENCE, most)


def ticks_of(view: View, scale: Scale) -> dict[float, str]:
    """The numbers of a scale that are written out, and how."""
    if view == "error":
        return {0.001: "0.1 %", 0.01: "1 %", 0.1: "10 %", 1.0: "100 %"}
    if view == "dropped":
        return {1.0: "1", 10.0: "10", 100.0: "100", 1000.0: "1000"}
    shares = [part * scale.high for part in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    return {share: f"{100 * share:+.3g} %" if share else "0" for share in shares}
