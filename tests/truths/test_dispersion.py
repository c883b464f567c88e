"""Glass that refracts each color by an index of its own: Snell's law, and pictures by channels."""

from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.shaders.test_dielectric import fresnel64
from tests.support.builders import MATTE, glass, lamp, plane, quad, scene_of, sphere
from tests.support.numerics import Array, wo_at
from tests.support.renders import (
    METHODS,
    Estimate,
    assert_agree,
    assert_mean,
    blocks,
    rendered,
    whole,
)

LINES = np.array([656.3, 587.6, 486.1])  # nanometres: the Fraunhofer lines C, d and F
CAMERA = {"position": [0, 0.5, 4], "look_at": [0, 0, 0], "fov": 30}
SKY = {"bottom": [0.1, 0.2, 0.3], "horizon": [0.5, 0.4, 0.3], "top": [0.9, 1.0, 0.8]}
LIT = ((1, 1, 1), (0, 1, 1), (1, 0, 1), (1, 1, 0), (0, 0, 1))  # channels with light
STEPS = 3000  # of the random number, a multiple of 1, 2 and 3


def indices(ior: float, dispersion: float) -> Array:
    """Cauchy's formula of KHR_materials_dispersion, which has the Abbe number 20 / dispersion."""
    found: Array = np.maximum(ior + (ior - 1) * dispersion / 20 * (523655 / LINES**2 - 1.5168), 1)
    return found


def ball(**more: Any) -> Scene:
    """A ball of glass above a floor and before the edge of a lamp, under a gradient."""
    parts = [sphere([0, 0, 0], 1, "glass"), plane([0, -1, 0], [0, 1, 0], "floor")]
    parts += [quad([0.4, -1, -3], [3, 0, 0], [0, 3, 0], "lamp")]
    materials = {"glass": glass(**more), "floor": MATTE, "lamp": lamp(4.0)}
    return scene_of(parts, materials, CAMERA, background=SKY)


def test_the_indices_of_the_lines_have_the_abbe_number() -> None:
    c, d, f = indices(1.7, 0.5)
    assert (d - 1) / (f - c) == pytest.approx(40, rel=1e-3)
    assert d == pytest.approx(1.7, abs=1e-4)


def test_each_color_gets_its_share_and_its_direction(call_glsl: CallGlsl) -> None:
    """Over all random numbers each channel is reflected by Fresnel's equations and refracted by
    Snell's law, with a total weight of 1.
    """
    cases = list(product(LIT, (True, False), (1.0, 0.85, 0.3)))
    lit, outside, cosine = (np.repeat(it, STEPS, axis=0) for it in zip(*cases, strict=True))
    setup = """
        mat3 frame = frame_around(vec3(0.6, 0.0, 0.8));
        Vertex vertex = vertex_of(frame, wo, material_at(0), outside > 0.0);
        vertex.etas = etas_of(vertex, lit);
        Scattering next = sample_dispersing(vertex, u);
        vec3 local = to_local(frame, next.direction);"""
    args = {
        "setup": setup,
        "scene": ball(ior=1.6, dispersion=2.0),
        "u": np.tile((np.arange(STEPS) + 0.5) / STEPS, len(cases)),
        "wo": wo_at(cosine),
        "outside": outside.astype(float),
        "lit": lit.astype(float),
    }
    weights = call_glsl("vec4(next.weight, next.scale)", "vec4", **args)
    goes = call_glsl("vec4(local, next.crosses ? 1.0 : 0.0)", "vec4", **args)
    iors = indices(1.6, 2.0)
    for n, (own_lit, is_outside, cos_i) in enumerate(cases):
        rows = slice(STEPS * n, STEPS * (n + 1))
        weight, scale = weights[rows, :3] * np.array(own_lit), weights[rows, 3]
        assert (weight.sum(axis=1) > 0).all()  # no sample without light
        crosses = goes[rows, 3] > 0
        etas = 1 / iors if is_outside else iors
        share = fresnel64(np.full(3, cos_i), etas) * own_lit
        assert_allclose(weight[~crosses].sum(axis=0) / STEPS, share, atol=4 / STEPS)
        assert_allclose(weight[crosses].sum(axis=0) / STEPS, own_lit - share, atol=4 / STEPS)
        for channel in range(3):
            own = crosses & (weight[:, channel] > 0)
            assert (np.delete(weight[own], channel, axis=1) == 0).all()
            sine = np.hypot(*goes[rows][own, :2].T)
            assert_allclose(sine, etas[channel] * np.sqrt(1 - cos_i**2), atol=3e-5)
            assert_allclose(scale[own], etas[channel] ** 2, rtol=1e-4)


@pytest.mark.parametrize(
    "method", [METHODS[0], *(pytest.param(it, marks=pytest.mark.slow) for it in METHODS[1:])]
)
def test_each_channel_is_that_of_glass_with_its_own_index(context: Context, method: str) -> None:
    settings: dict[str, Any] = {"method": method, "bounces": 6}
    both = blocks(rendered(ball(ior=1.5, dispersion=4.0), context, 256, **settings), 4)
    for channel, ior in enumerate(indices(1.5, 4.0)):
        plain = blocks(rendered(ball(ior=float(ior)), context, 256, seed=1, **settings), 4)
        difference = both.mean[..., channel] - plain.mean[..., channel]
        stderr = np.hypot(both.stderr[..., channel], plain.stderr[..., channel])
        level = plain.mean[..., channel]
        assert_mean(Estimate(1 + difference / level, stderr / level), 1, within=0.5, floor=1e-4)


def test_a_ball_under_an_even_sky_cannot_be_seen(context: Context) -> None:
    camera = {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 25}
    even = {"color": [1.0] * 3}
    materials = {"glass": glass(1.5, dispersion=5.0)}
    scene = scene_of([sphere([0, 0, 0], 1, "glass")], materials, camera, background=even)
    image = rendered(scene, context, 256, method="naive", bounces=60)
    assert_mean(whole(image), 1, within=0.03, floor=1e-3)


@pytest.mark.parametrize("color", [(6.0, 6.0, 6.0), (0.0, 6.0, 2.0)])
def test_particles_find_the_light_that_paths_find(
    context: Context, color: tuple[float, float, float]
) -> None:
    """A lamp without red: particles choose among two channels, and paths among three. Then the
    red light is that of the sky.
    """
    parts = [
        sphere([0, 0, 0], 0.5, "glass"),
        plane([0, -1, 0], [0, 1, 0], "floor"),
        sphere([0.5, 2, 0.3], 0.5, "lamp"),
    ]
    materials = {
        "glass": glass(1.6, dispersion=4.0),
        "floor": MATTE,
        "lamp": {**lamp(), "emission": list(color)},
    }
    sky = {"color": [0.3 if color[0] == 0 else 0.0, 0.0, 0.0]}
    camera = {"position": [0, 0.5, 4], "look_at": [0, -0.5, 0]}
    scene = scene_of(parts, materials, camera, background=sky)
    settings: dict[str, Any] = {"bounces": 5, "width": 16, "height": 16}
    paths = rendered(scene, context, 2048, method="naive", **settings)
    both = rendered(scene, context, 512, method="mis", caustics="on", seed=1, **settings)
    assert_agree(both, paths, within=0.1)


def test_without_dispersion_the_picture_keeps_its_bits(context: Context) -> None:
    plain, none = (
        rendered(ball(ior=1.5, **more), context, 4).radiance for more in ({}, {"dispersion": 0.0})
    )
    assert (plain == none).all()
