"""Absorbing glass leaves exp(-depth) of light: against float64."""

import numpy as np
from numpy.testing import assert_allclose

from tests.conftest import CallGlsl


def test_decay_is_the_exponential_function(call_glsl: CallGlsl) -> None:
    depth = np.concatenate([np.linspace(0, 87, 200_000), 10.0 ** np.linspace(-12, 1, 100_000)])
    depth = depth.astype(np.float32)
    found = call_glsl("decay(depth)", depth=depth)
    assert_allclose(found, np.exp(-depth.astype(np.float64)), rtol=3e-7)


def test_decay_ends_at_nothing_and_starts_at_all(call_glsl: CallGlsl) -> None:
    found = call_glsl("decay(depth)", depth=np.array([0.0, 87.5, 1e30, 3.4e38, np.inf]))
    assert found.tolist() == [1.0, 0.0, 0.0, 0.0, 0.0]
