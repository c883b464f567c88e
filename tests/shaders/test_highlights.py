"""Highlights of the models before path tracing: their form, width and share of the light."""

import math
from typing import Any

import numpy as np
import pytest

from tests.conftest import CallGlsl


def hemisphere(count: int = 200_000) -> np.ndarray[Any, Any]:
    """Directions spread evenly: a Fibonacci lattice."""
    i = np.arange(count) + 0.5
    z, phi = i / count, i * math.pi * (3 - math.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


@pytest.mark.parametrize("model", [1, 2])
@pytest.mark.parametrize("alpha", [0.1, 0.3, 0.5, 1.0])
def test_a_white_highlight_reflects_everything_head_on(
    call_glsl: CallGlsl, model: int, alpha: float
) -> None:
    wi = hemisphere()
    call = "eval_highlight(alpha, vec3(0.0, 0.0, 1.0), wi)"
    values = call_glsl(call, wi=wi, alpha=np.array([alpha]), constants={"MODEL": model})
    assert 2 * math.pi * values.mean(dtype=float) == pytest.approx(1, rel=2e-3)


@pytest.mark.slow
def test_highlights_of_both_forms_are_as_wide(call_glsl: CallGlsl) -> None:
    """Half the peak is reached at the same angle from the mirrored direction, within 3 %."""
    angles = np.linspace(0, 0.5, 2001)
    wi = np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=1)
    call = "eval_highlight(0.1, vec3(0.0, 0.0, 1.0), wi) / wi.z"
    widths = []
    for model in (1, 2):
        values = call_glsl(call, wi=wi, constants={"MODEL": model})
        widths.append(angles[np.argmax(values < values[0] / 2)])
    assert widths[0] == pytest.approx(widths[1], rel=0.03)


@pytest.mark.slow
def test_the_half_vector_form_is_reciprocal(call_glsl: CallGlsl) -> None:
    draw = np.random.default_rng(1)
    a, b = (np.abs(draw.normal(size=(1000, 3))) + 0.01 for _ in range(2))
    a, b = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (a, b))
    settings: dict[str, Any] = {"wo": a, "wi": b, "constants": {"MODEL": 2}}
    there = call_glsl("eval_highlight(0.4, wo, wi) / wi.z", **settings)
    back = call_glsl("eval_highlight(0.4, wi, wo) / wo.z", **settings)
    assert np.allclose(there, back, rtol=1e-4)


@pytest.mark.slow
def test_whole_powers_are_powers(call_glsl: CallGlsl) -> None:
    x = np.linspace(0.9, 1.0, 50)
    for n in (0, 1, 2, 7, 48, 1001):
        assert np.allclose(call_glsl(f"whole_power(x, {n})", x=x), x**n, rtol=1e-4, atol=1e-30)


@pytest.mark.parametrize("alpha", [1e-30, 1e-5, 0.01, 1.0])
def test_exponents_stay_in_range(call_glsl: CallGlsl, alpha: float) -> None:
    [n] = call_glsl("highlight_exponent(a)", returns="int", a=[alpha])
    assert n == pytest.approx(min(2 / alpha**2, 2**24) - 2, rel=1e-4)
