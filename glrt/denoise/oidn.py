"""Intel's Open Image Denoise, a trained filter, by the Python package pyoidn.

Noise must not be shared between pixels, as it is not on a film that counts a sample to one pixel.
Afra, "Intel Open Image Denoise" (www.openimagedenoise.org), filter RT.
"""

from importlib.util import find_spec

import numpy as np

from glrt.core.errors import UsageError
from glrt.denoise.half import Half, Pixels

PACKAGE = "pyoidn"


def is_installed() -> bool:
    """Whether the package is there; it is not loaded."""
    return find_spec(PACKAGE) is not None


def check() -> None:
    """UsageError where the package is not there."""
    if not is_installed():
        raise UsageError(
            f"--denoise oidn needs the Python package {PACKAGE}: type "
            "`pip install 'glrt[denoise]'`, which has it for Linux on x86-64, or take "
            "--denoise nlm, which needs no package."
        )


def filtered(half: Half) -> Pixels:
    """The radiance filtered, (H, W, 3); the same bits each time.

    The guides are told to be free of noise: beside the noise of light they nearly are, and edges
    stay sharper so.
    """
    check()
    from pyoidn import denoise

    albedo = np.clip(half.albedo.mean, 0, 1)
    normal = np.clip(half.normal.mean, -1, 1)
    color = np.maximum(half.radiance, 0)
    found = denoise(color, albedo, normal, hdr=True, clean_aux=True)
    return np.asarray(found, np.float32)
