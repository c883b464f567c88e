"""Roulette ends paths at random: the mean stays, whatever they carry and whatever they meet."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from tests.conftest import CallGlsl
from tests.support.alarms import assert_near
from tests.support.builders import lamp, plane, scene_of, sphere
from tests.support.numerics import ULP
from tests.support.renders import METHODS, SAMPLERS, assert_mean, rendered, whole
from tests.truths.test_furnace import OFF_CENTER, WHITE_SKY


def partial_sum(albedo: float, bounces: int) -> float:
    return (1 - albedo ** (bounces + 1)) / (1 - albedo)


@pytest.mark.parametrize("method", METHODS)
def test_roulette_raises_the_variance_and_leaves_the_mean(context: Context, method: str) -> None:
    albedo = [0.9, 0.5, 0.1]
    glow = {"type": "light", "emission": [1, 1, 1], "color": albedo}
    scene = scene_of([sphere([0, 0, 0], 1, "glow")], {"glow": glow}, OFF_CENTER)
    settings = {"bounces": 24, "method": method, "width": 64, "height": 64}
    plain = rendered(scene, context, 2, roulette=False, **settings)
    gambled = rendered(scene, context, 64, roulette=True, **settings)
    truth = [partial_sum(a, 24) for a in albedo]
    assert np.allclose(plain.radiance, truth, rtol=1e-6)
    assert (plain.stderr == 0).all()
    assert (gambled.stderr[..., 0] > 0).all()
    assert_mean(whole(gambled), truth, within=0.01, floor=5e-7)  # blue varies less than it rounds


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_roulette_is_fair_to_all_but_black_surfaces(context: Context, sampler: str) -> None:
    """Under a white sky. A chance below the last of a random number's 20 bits is met too often."""
    albedo, samples = 2.0**-24, 4096
    coal = {"type": "lambertian", "color": [albedo] * 3}
    floor, down = plane([0, -1, 0], [0, 1, 0], "coal"), {"look_at": [0, -1, 0], "up": [0, 0, 1]}
    scene = scene_of([floor], {"coal": coal}, down, background=WHITE_SKY)
    settings = {"width": 64, "height": 64, "bounces": 1, "sampler": sampler}
    radiance = rendered(scene, context, samples, **settings).radiance[..., 0].astype(float)
    survivors = radiance.sum() / radiance[radiance > 0].min()
    assert_near(radiance.mean() / albedo, 1.0, survivors**-0.5)


@pytest.mark.parametrize("method", METHODS)
def test_roulette_keeps_the_light_of_dim_paths(context: Context, method: str) -> None:
    """A lamp in the centre of a dark matte ball: every path that its wall scatters plays."""
    albedo, share = 0.1, (0.7 / 2) ** 2  # the share of the wall's view that the lamp takes
    wall = {"type": "lambertian", "color": [albedo] * 3}
    objects = [sphere([0, 0, 0], 2, "wall"), sphere([0, 0, 0], 0.7, "lamp")]
    eye = {"position": [0.2, 0.1, 1.2], "look_at": [0.5, 1, 3], "fov": 60}
    scene = scene_of(objects, {"wall": wall, "lamp": lamp(3.0, 0.9)}, eye)
    truth, lit = 0.0, 3.0
    for _ in range(6):
        truth, lit = albedo * (share * lit + (1 - share) * truth), 3.0 + 0.9 * truth
    samples = 4096 if method == "naive" else 512
    image = rendered(scene, context, samples, method=method, bounces=6, width=32, height=32)
    assert_mean(whole(image), truth, within=0.015)


@pytest.mark.slow
def test_roulette_makes_no_nan_of_any_throughput(call_glsl: CallGlsl) -> None:
    """From 0 over the smallest number to 1 and beyond, with 16 million numbers drawn, 0 included:
    survivors are brought to 1/4 or a little less, and the mean stays.
    """
    setup = """
        float sum = 0.0;
        float largest = 0.0;
        for (int k = 0; k < 1024; ++k) {
            Sampler rng = make_sampler(pixel_seed(ivec2(k, i), 0, 7u));
            vec3 throughput = vec3(t, 0.5 * t, 0.0);
            if (roulette_ends(throughput, rng)) continue;
            sum += throughput.x;
            largest = max(largest, throughput.x);
        }"""
    powers = 10.0 ** np.random.default_rng(9).uniform(-8, 1, 2**14)
    powers[:4] = [0.0, 1e-45, 1e-38, 1.0]
    found = call_glsl("vec2(sum / 1024.0, largest)", "vec2", setup=setup, t=powers)
    assert np.all(np.isfinite(found))
    given = powers.astype(np.float32)
    assert np.array_equal(found[given == 0], [[0, 0]])
    alive = found[:, 1] > 0
    chance = np.minimum(np.ceil(given * 2.0**18) / 2.0**16, 1)
    brought = np.divide(given, chance, out=np.zeros_like(chance), where=chance > 0)
    assert brought[given <= 0.25].max() <= 0.25
    assert_allclose(found[alive, 1], brought[alive], rtol=2 * ULP)
    spread = np.sqrt((brought**2 * (1 - chance) * chance)[given <= 1].sum() / 1024)
    total = (found[given <= 1, 0] - given[given <= 1]).sum(dtype=float)
    assert_near(total, 0, spread)
