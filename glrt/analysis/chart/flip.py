"""FLIP: the perceived difference of two pictures that are shown in alternation.

Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020. The mean over
pixels of differences in colour and at edges, at a viewing distance of 67 pixels per degree: 0 for
equal pictures, 1 for black against white. Pictures are compared with the tone curve and encoding of
glrt's PNG files, so differences that those do not show do not count.
"""

import os
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.image.tonemap import expose_and_encode
from glrt.settings import Settings

_PACKAGE = "flip_evaluator"


def is_installed() -> bool:
    """Whether the package flip-evaluator, which computes FLIP, is installed."""
    return find_spec(_PACKAGE) is not None


def flip(radiance: ArrayLike, truth: ArrayLike) -> float:
    """Mean FLIP of a picture against the reference `truth`; both are radiance, (H, W, 3)."""
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # else its idle threads disturb timings
    evaluator = import_module(_PACKAGE)
    pictures = [_as_shown(each) for each in (truth, radiance)]
    _, mean, _ = evaluator.evaluate(*pictures, "LDR", applyMagma=False)
    return float(mean)


def _as_shown(radiance: ArrayLike) -> NDArray[Any]:
    """sRGB values from 0 to 1, float32, as in a PNG file with the default exposure."""
    fields = Settings.model_fields
    codes = expose_and_encode(radiance, fields["exposure"].default, fields["tonemap"].default)
    return np.divide(codes, 255, dtype=np.float32)
