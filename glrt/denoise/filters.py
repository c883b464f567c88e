"""The filters by name, and which of them are installed."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import UsageError
from glrt.core.text import counted
from glrt.denoise import nlm, oidn
from glrt.denoise.half import Half, Pixels
from glrt.settings import Settings


class Filtered(NamedTuple):
    """The result of a filter."""

    radiance: Pixels  # (H, W, 3)
    own_weight: NDArray[np.float32]  # (H, W): weight of a pixel's own noise in its result, 0 to 1


def _by_oidn(half: Half) -> Filtered:
    """Filter by OIDN. It does not report the weight of a pixel's own noise: it is taken as 0."""
    return Filtered(oidn.filtered(half), np.zeros(half.radiance.shape[:2], np.float32))


FILTERS: Mapping[str, Callable[[Half], Filtered]] = {
    "nlm": lambda half: Filtered(*nlm.filtered(half)),
    "oidn": _by_oidn,
}


LEAST = 2  # observations a half: fewer have no variance


def least_samples(block: int) -> int:
    """Samples per pixel that two halves need; `block` samples make an observation."""
    return 2 * LEAST * block


def with_filter(settings: Settings) -> Settings:
    """Settings that name the filter: `auto` is oidn if it is installed, else nlm.

    Raises UsageError for oidn if it is not installed, and for too few samples for two halves.
    """
    least = least_samples(settings.block)
    if settings.denoise != "none" and settings.samples < least:
        raise UsageError(
            f"--denoise needs {counted(least, 'sample')} a pixel at least, to know its error, "
            f"with --sampler {settings.sampler}; got {settings.samples}: give --samples {least} "
            "or more"
        )
    if settings.denoise == "oidn":
        oidn.check()
    if settings.denoise != "auto":
        return settings
    name = "oidn" if oidn.is_installed() else "nlm"
    return settings.model_copy(update={"denoise": name})
