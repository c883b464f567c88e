"""Ray marching: steps of a fixed length through grids, and how far that is from the truth."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.plan.omissions import left_out, omissions
from glrt.plan.plan import prepare
from glrt.rendering.schedule import iterations_per_sample
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.builders import box, quad, sphere
from tests.support.images import same_bits
from tests.support.media import DUSK, EVEN, HAZE, MU, ball, filled, with_fog
from tests.support.numerics import Array
from tests.support.renders import assert_agree, assert_mean, rendered, same, whole
from tests.truths.test_grids import BUMPY, CUBE, RAMP, STEPS, depth_along_z, smoke, with_smoke
from tests.truths.test_transfer import LAYERS, RAINBOW, along_z, volume, with_volume
from tests.truths.test_transfer import RAMP as RISE

DEPTH = 2.0  # of CUBE, along the view
MARCH: dict[str, Any] = {"method": "march"}
VOXEL = DEPTH / len(RAMP)


def densities(values: Array, step: float) -> tuple[Array, Array]:
    """Densities in the middles of steps from the front of CUBE on, and the lengths of steps."""
    layers = values[:, 0, 0].astype(float)
    begin = np.arange(0, DEPTH, step)
    end = np.minimum(begin + step, DEPTH)
    place = (DEPTH - (begin + end) / 2) * len(layers) / DEPTH  # in voxels, from the back
    return np.interp(place - 0.5, np.arange(len(layers)), layers), end - begin


# --- what comes through: without noise -------------------------------------------------------


@pytest.mark.parametrize("step", [0.0, 0.3, 5.0], ids=["a voxel", "some voxels", "all"])
@pytest.mark.parametrize("values", [RAMP, STEPS], ids=["ramp", "steps"])
def test_a_step_is_as_dense_as_its_middle(context: Context, values: Array, step: float) -> None:
    scene = with_smoke(smoke(values, absorption=MU), background=EVEN)
    image = rendered(scene, context, 4, **MARCH, march_step=step)
    density, length = densities(values, step or VOXEL)
    truth = np.exp(-MU * (density * length).sum())
    assert_allclose(image.radiance, np.broadcast_to(truth, (16, 16, 3)), rtol=1e-4)  # half floats
    assert (image.stderr <= 1e-6).all()


def test_the_error_of_steps_falls_with_the_square_of_their_length(context: Context) -> None:
    """Where density is smooth: as that of the midpoint rule."""
    layers = np.exp(np.linspace(-2, 1, 128)).astype(np.float32)
    smooth = layers[:, None, None] * np.ones((128, 3, 2), np.float32)
    scene = with_smoke(smoke(smooth, absorption=1), background=EVEN)
    truth, found = depth_along_z(smooth), []
    for step in (DEPTH / 4, DEPTH / 8, DEPTH / 16):
        image = rendered(scene, context, 1, **MARCH, march_step=step)
        found.append(truth + np.log(whole(image).mean[0]))
    assert found[2] > 1e-3
    assert 3.8 < found[0] / found[1] < 4.4
    assert 3.8 < found[1] / found[2] < 4.4


def test_a_volume_in_steps_is_front_to_back_compositing(context: Context) -> None:
    """Opacity 1 - (1 - o)^(step / length) in front of the rest; and it comes near the truth."""
    scene = with_volume(volume(RISE, RAINBOW))
    for step, within in ((0.5, 1.0), (DEPTH / (LAYERS + 1), 0.1), (0.004, 2e-3)):
        image = rendered(scene, context, 1, bounces=0, **MARCH, march_step=step)
        density, length = densities(RISE, step)
        opacity = np.interp(density, RAINBOW.values, RAINBOW.opacities)
        color = np.array(
            [np.interp(density, RAINBOW.values, it) for it in np.array(RAINBOW.colors).T]
        )
        left = np.cumprod((1 - opacity) ** (length / RAINBOW.length))
        truth = (color * -np.diff(left, prepend=1.0)).sum(axis=1) + left[-1]
        assert_allclose(image.radiance, np.broadcast_to(truth, (16, 16, 3)), rtol=2e-4)
        assert_allclose(truth, along_z(RISE, RAINBOW), atol=within)


# --- scattering ------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("step", [0.0, 0.37])
def test_white_smoke_in_steps_cannot_be_seen_under_an_even_sky(
    context: Context, step: float
) -> None:
    scene = with_smoke(smoke(BUMPY, [0.5, 2, 5], anisotropy=0.5), background=EVEN)
    image = rendered(scene, context, 256, bounces=1000, roulette=False, **MARCH, march_step=step)
    assert_mean(whole(image), [1.0] * 3, 0.03)


@pytest.mark.slow
def test_smoke_in_steps_scatters_what_its_steps_do_not_let_through(context: Context) -> None:
    """At most 0 bounces: all that is scattered is lost. The channels differ by up to 4."""
    scene = with_smoke(smoke(RAMP, 0.75 * MU, 0.25 * MU), background=EVEN)
    image = rendered(scene, context, 2048, bounces=0, **MARCH, march_step=0.3)
    density, length = densities(RAMP, 0.3)
    assert_mean(whole(image), np.exp(-MU * (density * length).sum()), 0.1)


@pytest.mark.slow
def test_even_smoke_in_steps_is_the_same_as_without(context: Context) -> None:
    """A lamp near a medium that shines, whose channels differ."""
    things = [CUBE, filled(sphere([0, 1.6, 0.4], 0.3, ""), None, "lamp")]
    eye = {"position": [0, 0, 4], "fov": 40}
    fog = smoke(
        np.ones((4, 4, 4), np.float32), [1, 2, 0.5], [0.1, 0.1, 0.3], emission=0.2, anisotropy=0.4
    )
    scene = with_smoke(fog, things, eye)
    steps = rendered(scene, context, 2048, seed=1, **MARCH, march_step=0.23)
    assert_agree(steps, rendered(scene, context, 4096), 0.1)


@pytest.mark.slow
def test_a_shadow_in_steps_is_as_deep_as_they_are(context: Context) -> None:
    """A floor under smoke that scatters; direct light of a lamp straight above it, far away."""
    things = [
        CUBE,
        quad([-0.01, -0.01, -1.5], [0.02, 0, 0], [0, 0.02, 0], "white"),
        filled(sphere([0, 0, 90], 0.5, ""), None, "lamp"),
    ]
    eye = {"position": [0, 0, -1.2], "look_at": [0, 0, -1.5], "up": [0, 1, 0], "fov": 0.01}
    image, clear = (
        rendered(
            with_smoke(smoke(it, MU), things, eye),
            context,
            1024,
            bounces=1,
            roulette=False,
            **MARCH,
            march_step=0.3,
        )
        for it in (RAMP, 0 * RAMP)
    )
    density, length = densities(RAMP[::-1], 0.3)  # from below
    left = whole(image).mean / whole(clear).mean
    assert_allclose(left, np.exp(-MU * (density * length).sum()), rtol=1e-4)


@pytest.mark.slow
def test_steps_that_are_twice_as_long_keep_the_bits(context: Context) -> None:
    def picture(size: float) -> Any:
        fog = smoke(BUMPY, np.array([1, 2, 4]) / size, 0.5 / size, emission=0.25 / size)
        eye = {"position": [0, 0, 5 * size], "look_at": [0, 0, 0], "fov": 40}
        scene = with_smoke(fog, [filled(box([-size] * 3, [size] * 3, ""))], eye, background=EVEN)
        return rendered(scene, context, 16, **MARCH, march_step=0.3 * size)

    assert same(picture(1.0), picture(8.0))


# --- where it is not needed, and where it fails ----------------------------------------------


def test_without_a_grid_the_kernel_is_that_of_mis() -> None:
    scene = with_fog([ball()], HAZE, background=DUSK)
    found = [
        needs_of(SceneFacts(scene), settings_for(scene.render, method=it))
        for it in ("march", "mis")
    ]
    assert found[0] == found[1]


def steps_through(scene: Scene, **settings: Any) -> Any:
    return settings_for(scene.render, method="march", **settings)


def test_steps_are_named_as_what_blurs_light() -> None:
    scene = with_smoke(smoke(RAMP, absorption=MU))
    for step, length in ((0.0, "0.062"), (0.5, "0.5")):
        settings = steps_through(scene, march_step=step)
        said = left_out(settings, omissions(SceneFacts(scene), settings))
        assert said.startswith("Method march blurs light")
        assert said.endswith(f"of the medium fog what is finer than its steps, {length} long.")
    assert omissions(SceneFacts(with_fog([ball()], HAZE)), steps_through(scene)) == []


def test_steps_that_are_too_short_are_refused_with_the_shortest_that_is_not(
    context: Context,
) -> None:
    scene = with_smoke(smoke(RAMP, absorption=MU), background=EVEN)
    with pytest.raises(UsageError, match=r"march-step 1e-05 .* media\.fog.* at least 0\.00035\."):
        rendered(scene, context, 1, **MARCH, march_step=1e-5)


def test_steps_count_among_the_rounds_of_a_sample() -> None:
    """The path and a ray to a lamp take them in each segment, which may end at the bound."""
    scene = with_smoke(smoke(RAMP, MU), [CUBE, filled(sphere([0, 0, 9], 0.5, ""), None, "lamp")])
    rounds = [
        iterations_per_sample(prepare(scene, steps_through(scene, march_step=it, bounces=3)))
        for it in (0.3, 0.003)
    ]
    most = [math.ceil(DEPTH * math.sqrt(3) / it) for it in (0.3, 0.003)]
    assert rounds[1] - rounds[0] == (3 + 1) * 2 * 2 * (most[1] - most[0])


def test_short_steps_of_one_grid_reach_through_it(context: Context) -> None:
    scene = with_smoke(smoke(RAMP, absorption=MU), background=EVEN)
    few, many = (rendered(scene, context, 1, **MARCH, march_step=it) for it in (0.01, 0.001))
    assert_allclose(few.radiance, many.radiance, rtol=1e-4)
    assert not same_bits(few.radiance, many.radiance)
