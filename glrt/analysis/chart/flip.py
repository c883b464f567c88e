"""FLIP: how different two pictures look to someone who flips between them.

Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020. From 0, equal, to
1, black beside white: the mean over pixels of differences in colour and at edges, as seen from
where 67 pixels fill a degree. Pictures are taken as glrt writes PNG files, so that what a tone
curve hides does not count.
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
    """Whether the package flip-evaluator, which computes it, is there."""
    return find_spec(_PACKAGE) is not None


def flip(radiance: ArrayLike, truth: ArrayLike) -> float:
    """FLIP of a picture beside what it should show; both are radiance, (H, W, 3)."""
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # else its threads disturb what is timed
    evaluator = import_module(_PACKAGE)
    pictures = [_as_shown(each) for each in (truth, radiance)]
    _, mean, _ = evaluator.evaluate(*pictures, "LDR", applyMagma=False)
    return float(mean)


def _as_shown(radiance: ArrayLike) -> NDArray[Any]:
    fields = Settings.model_fields
    codes = expose_and_encode(radiance, fields["exposure"].default, fields["tonemap"].default)
    return np.divide(codes, 255, dtype=np.float32)
