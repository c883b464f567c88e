"""The share of even light that facets reflect, against figures that others have published."""

import numpy as np
import pytest

from glrt.scene.materials.gloss import facet_shares

# MaterialX (Academy Software Foundation), the rational fit of the directional albedo of GGX with
# height-correlated shadowing: factors of 1, x, y, xy, x^2, y^2, x^2 y, x y^2 and x^2 y^2, with the
# cosine x and alpha y, in the numerators by f0 and f90 and in their denominators.
FIT = np.array(
    [
        [0.1003, 0.9345, 1, 1],
        [-0.6303, -2.323, -1.765, 0.2281],
        [9.748, 2.229, 8.263, 15.94],
        [-2.038, -3.748, 11.53, -55.83],
        [29.34, 1.424, 28.96, 13.08],
        [-8.245, -0.7684, -7.507, 41.26],
        [-26.44, 1.436, -36.11, 54.9],
        [19.99, 0.2913, 15.86, 300.2],
        [-5.448, 0.6286, 33.37, -285.1],
    ]
)


@pytest.mark.parametrize("alpha", [0.04, 0.09, 0.25, 0.49, 0.81, 1.0])
def test_facets_reflect_what_materialx_says(alpha: float) -> None:
    """The fit is within some hundredths; what facets lose is up to 0.69."""
    shares = facet_shares(alpha)
    root = np.linspace(0, 1, len(shares.head_on))
    is_in = root**2 > 0.05  # below, the fit leaves the albedo
    x, y = root[is_in] ** 2, np.full(int(is_in.sum()), alpha)
    terms = np.stack([x**0, x, y, x * y, x**2, y**2, x**2 * y, x * y**2, x**2 * y**2])
    parts = FIT.T @ terms
    head_on, grazing = parts[:2] / parts[2:]
    assert np.abs(shares.head_on[is_in] - head_on).max() < 0.035
    assert np.abs(shares.grazing[is_in] - grazing).max() < 0.01
    assert np.abs(shares.head_on[is_in] - head_on).mean() < 0.02
