"""The picture of docs/explanation/denoising.md: plain, denoised, and the error that is left.

The error is a share of the radiance, from 0 (black) to 20 % and more (white).
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.contact_sheet import check_sheet, save_sheet
from bench.program import exit_code_of, parser_of
from glrt.api import render
from glrt.denoise.filters import FILTERS
from glrt.error.estimate import DARK
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.image.tonemap import encode_srgb, expose_and_encode

SCENES, SIZE, SAMPLES = ("cornell", "methods/caustic"), 300, 64
WHITE = 0.2  # the relative error that is white
MOST_BYTES = 150_000

Codes = NDArray[np.uint8]


def panels(image: Image) -> list[Codes]:
    """Plain, denoised, and the map of the error, (H, W, 3) sRGB each."""
    shown = image.denoised()
    scale = np.square(shown.radiance) + DARK * np.square(shown.radiance.mean())
    relative = np.sqrt((np.square(shown.error_map) / scale).mean(axis=-1, keepdims=True))
    gray = encode_srgb(np.clip(relative.astype(np.float64) / WHITE, 0, 1) ** 2)
    error = np.rint(255 * np.repeat(gray, 3, axis=-1)).astype(np.uint8)
    pictures = (image.radiance, shown.radiance)
    return [*(expose_and_encode(pixels, 0.0, "neutral") for pixels in pictures), error]


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.denoised_sheet -o FILE`; returns the exit code."""
    parser = parser_of("denoised_sheet", __doc__)
    parser.add_argument("-o", dest="output", metavar="FILE", required=True, type=Path)
    parser.add_argument("--by", choices=[*FILTERS], default="nlm")
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _make(given))


def _make(given: argparse.Namespace) -> None:
    check_sheet(given.output)
    options: dict[str, Any] = {"width": SIZE, "height": SIZE, "samples": SAMPLES}
    images = [render(load(name), denoise=given.by, **options) for name in SCENES]
    save_sheet([codes for image in images for codes in panels(image)], given.output, MOST_BYTES)


if __name__ == "__main__":
    sys.exit(main())
