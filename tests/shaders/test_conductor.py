"""The reflectance of metal by a complex index: complex arithmetic, and measured spectra."""

from pathlib import Path
from runpy import run_path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.scene.materials.conductors import PRESETS, Conductor
from tests.conftest import CallGlsl
from tests.support.builders import scene_of, sphere
from tests.support.numerics import Array

TOOL = run_path(str(Path(__file__).parents[2] / "tools/metals.py"))
SPECTRA = TOOL["SPECTRA"]
COSINES = np.concatenate([np.linspace(0, 1, 400), np.logspace(-6, 0, 200)]).astype(np.float32)


def exact(cosine: Array, n: Array, k: Array) -> Array:
    """Fresnel's equations with a complex index; no root is rearranged."""
    index = n + 1j * k
    beyond = np.sqrt(index**2 - 1 + cosine**2)
    s = (cosine - beyond) / (cosine + beyond)
    p = (index**2 * cosine - beyond) / (index**2 * cosine + beyond)
    found: Array = (np.abs(s) ** 2 + np.abs(p) ** 2) / 2
    return found


@pytest.mark.parametrize("name", PRESETS)
def test_metals_reflect_as_complex_arithmetic_says(call_glsl: CallGlsl, name: str) -> None:
    scene = scene_of([sphere([0, 0, -3], 1, "m")], {"m": {"type": "metal", "preset": name}})
    found = call_glsl(
        "metal_reflectance(material_at(0), cosine)", "vec3", scene=scene, cosine=COSINES
    )
    metal = PRESETS[name]
    cosine = COSINES.astype(np.float64)[:, None]
    assert_allclose(found, exact(cosine, np.array(metal.ior), np.array(metal.k)), atol=5e-7)


def test_any_index_reflects_as_complex_arithmetic_says(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(3)
    n = np.exp(random.uniform(np.log(0.01), np.log(30), 20_000)).astype(np.float32)
    k = np.exp(random.uniform(np.log(1e-3), np.log(100), 20_000)).astype(np.float32)
    cosine = random.uniform(0, 1, 20_000).astype(np.float32)
    found = call_glsl("fresnel_conductor(cosine, n, k)", n=n, k=k, cosine=cosine)
    wide = (part.astype(np.float64) for part in (cosine, n, k))
    assert_allclose(found, exact(*wide), atol=5e-6)
    assert found.min() >= 0
    assert found.max() <= 1


def test_without_extinction_metal_reflects_as_glass(call_glsl: CallGlsl) -> None:
    n = np.linspace(1.01, 4, len(COSINES)).astype(np.float32)
    found = call_glsl(
        "vec2(fresnel_conductor(cosine, n, 0.0), fresnel(cosine, 1.0 / n))",
        "vec2",
        n=n,
        cosine=COSINES,
    )
    assert_allclose(found[:, 0], found[:, 1], atol=1e-6)


def test_all_is_reflected_along_the_surface(call_glsl: CallGlsl) -> None:
    assert call_glsl("fresnel_conductor(0.0, 0.2, 3.0)").tolist() == [1.0]


@pytest.mark.parametrize("name", SPECTRA)
def test_presets_follow_from_the_spectra(name: str) -> None:
    n, k = TOOL["channels"](SPECTRA[name])
    assert PRESETS[name] == Conductor(tuple(n.tolist()), tuple(k.tolist()))
    rows = np.array(SPECTRA[name].rows.split(), float).reshape(-1, 3)
    seen = TOOL["reflectance"](rows[:, 1], rows[:, 2])
    head_on = np.array(PRESETS[name].head_on)
    assert head_on.min() > seen.min() - 0.05, "sRGB is narrower than what is seen"
    assert head_on.max() <= max(seen.max(), TOOL["BRIGHTEST"]) + 0.001


def test_metals_have_their_colours() -> None:
    """Reddish, yellow, bluish or grey."""
    red, green, blue = (
        {name: metal.head_on[channel] for name, metal in PRESETS.items()} for channel in range(3)
    )
    assert green["copper"] / red["copper"] < 0.75
    assert blue["gold"] / green["gold"] < 0.55
    assert green["gold"] / red["gold"] > 0.7
    assert blue["aluminium"] > red["aluminium"]
    for name in ("silver", "chromium", "iron"):
        assert abs(red[name] / blue[name] - 1) < 0.08
