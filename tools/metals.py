"""Print the metals of glrt/scene/materials/conductors.py from spectra: python tools/metals.py.

Spectra of n and k from the refractiveindex.info database (M. N. Polyanskiy, CC0 1.0). Reflectances
at normal incidence are averaged with the sensitivities of linear sRGB, of the CIE 1931 observer
under light of equal energy; so white stays white. n is averaged with what of them is above 0, and k
is what gives that reflectance (as O. Gulbrandsen, "Artist Friendly Metallic Fresnel", JCGT 2014).
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

NOBLE = "Johnson and Christy, Phys. Rev. B 6, 4370 (1972)"
TRANSITION = "Johnson and Christy, Phys. Rev. B 9, 5056 (1974)"


class Spectrum(NamedTuple):
    """A metal as it was measured; each row: wavelength in micrometres, n, k."""

    source: str
    rows: str


SPECTRA = {
    "aluminium": Spectrum(
        "McPeak et al., ACS Photonics 2, 326 (2015)",
        """0.38 0.336 4.003 0.4 0.3752 4.226 0.42 0.4176 4.447 0.44 0.4642 4.669 0.46 0.5148 4.888
        0.48 0.568 5.106 0.5 0.6257 5.32 0.52 0.6883 5.536 0.54 0.7545 5.746 0.56 0.8292 5.958
        0.58 0.9086 6.165 0.6 0.9925 6.369 0.62 1.0882 6.567 0.64 1.1903 6.759 0.66 1.3044 6.942
        0.68 1.426 7.116 0.7 1.5598 7.274 0.72 1.7068 7.414 0.74 1.8722 7.528 0.76 2.0542 7.599""",
    ),
    "brass": Spectrum(
        "Querry, Contractor Report CRDC-CR-85034 (1985), 70 % copper and 30 % zinc",
        """0.38 1.487 1.818 0.39 1.471 1.813 0.4 1.445 1.805 0.41 1.405 1.794 0.42 1.35 1.786
        0.43 1.278 1.784 0.44 1.191 1.797 0.45 1.094 1.829 0.46 0.994 1.883 0.47 0.9 1.957
        0.48 0.816 2.046 0.49 0.745 2.145 0.5 0.686 2.25 0.51 0.639 2.358 0.52 0.602 2.464
        0.53 0.573 2.568 0.54 0.549 2.668 0.55 0.527 2.765 0.56 0.505 2.86 0.57 0.484 2.958
        0.58 0.468 3.059 0.59 0.46 3.159 0.6 0.45 3.253 0.61 0.452 3.345 0.62 0.449 3.434
        0.63 0.445 3.522 0.64 0.444 3.609 0.65 0.444 3.695 0.66 0.445 3.778 0.68 0.444 3.943
        0.7 0.446 4.106 0.72 0.45 4.266 0.74 0.455 4.424 0.76 0.458 4.579""",
    ),
    "chromium": Spectrum(
        TRANSITION,
        """0.368 1.87 2.69 0.381 1.92 2.74 0.397 2 2.83 0.413 2.08 2.93 0.431 2.19 3.04
        0.451 2.33 3.14 0.471 2.51 3.24 0.496 2.75 3.3 0.521 2.94 3.33 0.549 3.18 3.33
        0.582 3.22 3.3 0.617 3.17 3.3 0.659 3.09 3.34 0.704 3.05 3.39 0.756 3.08 3.42""",
    ),
    "copper": Spectrum(
        NOBLE,
        """0.3679 1.36 1.975 0.3815 1.33 2.045 0.3974 1.32 2.116 0.4133 1.28 2.207
        0.4305 1.25 2.305 0.4509 1.24 2.397 0.4714 1.25 2.483 0.4959 1.22 2.564 0.5209 1.18 2.608
        0.5486 1.02 2.577 0.5821 0.7 2.704 0.6168 0.3 3.205 0.6595 0.22 3.747 0.7045 0.21 4.205
        0.756 0.24 4.665""",
    ),
    "gold": Spectrum(
        NOBLE,
        """0.3679 1.48 1.895 0.3815 1.46 1.933 0.3974 1.47 1.952 0.4133 1.46 1.958
        0.4305 1.45 1.948 0.4509 1.38 1.914 0.4714 1.31 1.849 0.4959 1.04 1.833 0.5209 0.62 2.081
        0.5486 0.43 2.455 0.5821 0.29 2.863 0.6168 0.21 3.272 0.6595 0.14 3.697 0.7045 0.13 4.103
        0.756 0.14 4.542""",
    ),
    "iron": Spectrum(
        TRANSITION,
        """0.368 2.02 2.43 0.381 2.12 2.5 0.397 2.24 2.58 0.413 2.35 2.65 0.431 2.48 2.71
        0.451 2.59 2.77 0.471 2.67 2.82 0.496 2.74 2.88 0.521 2.86 2.91 0.549 2.95 2.93
        0.582 2.94 2.99 0.617 2.88 3.05 0.659 2.92 3.1 0.704 2.86 3.19 0.756 2.87 3.28""",
    ),
    "silver": Spectrum(
        NOBLE,
        """0.3679 0.07 1.657 0.3815 0.05 1.864 0.3974 0.05 2.07 0.4133 0.05 2.275
        0.4305 0.04 2.462 0.4509 0.04 2.657 0.4714 0.05 2.869 0.4959 0.05 3.093 0.5209 0.05 3.324
        0.5486 0.06 3.586 0.5821 0.05 3.858 0.6168 0.06 4.152 0.6595 0.05 4.483 0.7045 0.04 4.838
        0.756 0.03 5.242""",
    ),
    "titanium": Spectrum(
        TRANSITION,
        """0.368 1.9 2.9 0.381 1.99 2.93 0.397 2.08 2.95 0.413 2.14 2.98 0.431 2.21 3.01
        0.451 2.27 3.04 0.471 2.32 3.1 0.496 2.36 3.19 0.521 2.44 3.3 0.549 2.54 3.43
        0.582 2.6 3.58 0.617 2.67 3.72 0.659 2.76 3.84 0.704 2.86 3.96 0.756 3 4.01""",
    ),
}

WAVELENGTHS = np.arange(380.0, 751.0, 1.0)  # nanometres
BRIGHTEST = 0.99  # reflectance of a channel: the reds of gold and copper lie beyond sRGB


def _lobe(center: float, below: float, above: float) -> Floats:
    sigma = np.where(center > WAVELENGTHS, below, above)
    lobe: Floats = np.exp(-0.5 * ((WAVELENGTHS - center) / sigma) ** 2)
    return lobe


def sensitivities() -> Floats:
    """(3, w): of red, green and blue of linear sRGB, 1 in sum each.

    Observer: Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color
    Matching Functions" (JCGT 2013). Each channel is divided by its sum.
    """
    x = (
        1.056 * _lobe(599.8, 37.9, 31.0)
        + 0.362 * _lobe(442.0, 16.0, 26.7)
        - 0.065 * _lobe(501.1, 20.4, 26.2)
    )
    y = 0.821 * _lobe(568.8, 46.9, 40.5) + 0.286 * _lobe(530.9, 16.3, 31.1)
    z = 1.217 * _lobe(437.0, 11.8, 36.0) + 0.681 * _lobe(459.0, 26.0, 13.8)
    to_rgb = [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
    rgb = np.array(to_rgb) @ np.stack([x, y, z])
    weights: Floats = rgb / rgb.sum(axis=1, keepdims=True)
    return weights


def reflectance(n: Any, k: Any) -> Any:
    """At normal incidence."""
    return ((n - 1) ** 2 + k**2) / ((n + 1) ** 2 + k**2)


def channels(spectrum: Spectrum) -> tuple[Floats, Floats]:
    """n and k of red, green and blue, (3,) each, to three digits after the point."""
    rows = np.array(spectrum.rows.split(), float).reshape(-1, 3)
    n, k = (np.interp(WAVELENGTHS / 1000, rows[:, 0], rows[:, column]) for column in (1, 2))
    weights = sensitivities()
    target = np.clip(weights @ reflectance(n, k), 0, BRIGHTEST)
    above = np.maximum(weights, 0)
    mean = (above @ n) / above.sum(axis=1)
    squared = (target * (mean + 1) ** 2 - (mean - 1) ** 2) / (1 - target)
    return np.round(mean, 3), np.round(np.sqrt(squared), 3)


if __name__ == "__main__":
    for name, spectrum in SPECTRA.items():
        n, k = channels(spectrum)
        seen = np.round(reflectance(n, k), 3).tolist()
        print(f"{name}: n {n.tolist()}, k {k.tolist()}, reflects {seen}; {spectrum.source}")
