"""A page of compared pictures: one HTML file that needs no network.

Pictures are stored as half floats, compressed, so that the page can expose them. Codes for the
screen are those of the tone curve `none`.
"""

import base64
import gzip
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from glrt.comparison.heatmap import colors, strongest
from glrt.comparison.result import CHANNELS, Comparison, percent
from glrt.core.web_page import save_web_page
from glrt.image.image import Image

LARGEST = 65504.0  # the largest half float


class Compared(NamedTuple):
    """A picture, its reference, and what the comparison found."""

    title: str
    image: Image
    reference: Image
    found: Comparison


def save_page(entries: Sequence[dict[str, Any]], path: str | Path) -> None:
    """Write a page of entries, pictures that differ first. RenderError if it cannot be written."""
    ordered = sorted(entries, key=lambda entry: (entry["verdict"] != "different", entry["title"]))
    save_web_page(path, "glrt: compared pictures", ordered, ("glrt.comparison", "report.html"))


def entry_of(compared: Compared) -> dict[str, Any]:
    """Return what the page shows of a picture, as values of JSON."""
    title, image, reference, found = compared
    height, width, _ = image.radiance.shape
    recipes = {"new picture": image.recipe, "reference": reference.recipe}
    return {
        "title": title,
        "verdict": found.verdict,
        "text": str(found).partition(": ")[2],
        "width": width,
        "height": height,
        "image": _packed(_halves(image)),
        "reference": _packed(_halves(reference)),
        "scores": _packed(colors(strongest(found.pixel_scores))),
        "rows": _rows(found),
        "recipes": {f"Recipe of the {name}": it.to_json() for name, it in recipes.items() if it},
    }


def _halves(image: Image) -> np.ndarray[Any, Any]:
    return np.clip(image.radiance, -LARGEST, LARGEST).astype("<f2")


def _packed(values: np.ndarray[Any, Any]) -> str:
    return base64.b64encode(gzip.compress(values.tobytes(), 6, mtime=0)).decode()


def _span(low: float, high: float) -> str:
    return f"{percent(low, sign='+')} to {percent(high, sign='+')}"


def _rows(found: Comparison) -> list[list[str]]:
    sure = f"{100 * (1 - found.alpha):.4g} % interval"
    rows = [["mean", "new", "reference", "difference", sure]]
    for name, means, (size, low, high) in zip(
        CHANNELS, found.means, found.differences, strict=True
    ):
        rows.append(
            [name, *(f"{mean:.5g}" for mean in means), percent(size, sign="+"), _span(low, high)]
        )
    for name, (size, low, high) in zip(CHANNELS, found.factors, strict=False):
        rows.append(
            [f"{name}, weighted by 1 / noise", "", "", percent(size, sign="+"), _span(low, high)]
        )
    rows.append(["spread of blocks, 1 expected", "", "", f"{found.spread:.2f}", ""])
    rows.append(
        [
            f"largest block: {found.worst}",
            "",
            "",
            f"{found.largest:+.2f}",
            f"{found.limit:.2f} allowed",
        ]
    )
    light = found.sensitivity.light
    least = percent(light) if np.isfinite(light) else "unknown"
    return [*rows, ["smallest change of all light that would be found", "", "", least, ""]]
