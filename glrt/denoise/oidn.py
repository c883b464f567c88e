"""Intel's Open Image Denoise, a trained filter, by the Python package pyoidn.

The noise of pixels must be independent. On a film it is, since each sample counts to one pixel.
Afra, "Intel Open Image Denoise" (www.openimagedenoise.org), filter RT.
"""

from importlib.util import find_spec

import numpy as np

from glrt.core.errors import UsageError
from glrt.core.install import install
from glrt.denoise.half import Half, Pixels

PACKAGE = "pyoidn"


def is_installed() -> bool:
    """Whether the package is installed; it is not imported."""
    return find_spec(PACKAGE) is not None


def check() -> None:
    """Raise UsageError if the package is not installed."""
    if not is_installed():
        raise UsageError(
            f"--denoise oidn needs the Python package {PACKAGE}: type "
            f"`{install('denoise')}`, which has it for Linux on x86-64, or take "
            "--denoise nlm, which needs no package."
        )


def filtered(half: Half) -> Pixels:
    """The filtered radiance, (H, W, 3); the same bits each time.

    The guides are declared free of noise. Compared to the light they nearly are, and edges stay
    sharper so.
    """
    check()
    from pyoidn import denoise

    albedo = np.clip(half.albedo.mean, 0, 1)
    normal = np.clip(half.normal.mean, -1, 1)
    color = np.maximum(half.radiance, 0)
    found = denoise(color, albedo, normal, hdr=True, clean_aux=True)
    return np.asarray(found, np.float32)
