"""Weighted recursive least squares against the batch form, closed forms, and 12,000 still frames.

W1 to W7 are properties of the paper, and of its guards.
"""

from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.gpu.evaluate import Probe
from tests.rendering.history.twins import Array, FactoredWrls, Wrls, batch

FORMS = [Wrls, FactoredWrls]
GREY = np.array([1.0, 0.8, 0.6])


def noisy(rng: np.random.Generator, n: int, spread: float, mean: Any = 0.3) -> Array:
    """Gamma noise of one channel, in the colour of a surface in white light: (n, 3)."""
    shape = spread**-2
    return np.asarray(rng.gamma(shape, 1 / shape, (n, 1)) * GREY * mean)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("is_delayed", [False, True])
def test_w1_it_is_weighted_least_squares_over_all_frames(
    form: type[Wrls], is_delayed: bool
) -> None:
    rng = np.random.default_rng(1)
    frames = [rng.gamma(2, 0.3, (20, 3)) for _ in range(60)]
    wrls = form(frames[0], is_delayed, limit=False)
    rows = []
    for radiance in frames[1:]:
        wrls.add(radiance)
        rows.append((wrls.p, wrls.weight, radiance))
    expected = batch(wrls, rows, frames[0])
    assert np.abs(wrls.slopes - expected).max() <= 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("form", FORMS)
def test_w2_of_a_constant_it_is_the_running_mean(form: type[Wrls]) -> None:
    """Less what it begins with, which counts as 1 / delta of a sample."""
    frames = np.random.default_rng(2).gamma(2, 0.3, (50, 7, 3))
    wrls = form(frames[0], width=np.inf, forgetting=1.0, is_constant=True, limit=False)
    for radiance in frames[1:]:
        shown = wrls.add(radiance)
    mean = (frames[0] / 1000 + frames[1:].sum(axis=0)) / (len(frames) - 1 + 1 / 1000)
    assert shown == pytest.approx(mean, rel=1e-12)


@pytest.mark.parametrize(("is_delayed", "slope", "noise"), [(False, 1.75, 0.661), (True, 0, 0.07)])
def test_w3_slopes_and_noise_of_a_still_picture(
    is_delayed: bool, slope: float, noise: float
) -> None:
    """The published predictor holds the sample: cov(y, z) / var(z) = (1 - a) / ((1 - a) / (1 + a)).

    So its noise is sqrt(1 - a^2) = 0.66 of the sample's, that of its feature 0.38.
    """
    rng, spread = np.random.default_rng(3), 0.05
    wrls = FactoredWrls(0.5 + spread * rng.standard_normal((400, 3)), is_delayed, width=np.inf)
    shown, features = [], []
    for frame in range(1500):
        prediction = wrls.add(0.5 + spread * rng.standard_normal((400, 3)))
        if frame > 1000:
            shown.append(prediction)
            features.append(wrls.feature)
    diagonal = np.diagonal(wrls.slopes[:, 1:], axis1=1, axis2=2).mean()
    assert diagonal == pytest.approx(slope, abs=0.03)  # of the mean of 1200: 0.005
    assert np.std(shown) / spread == pytest.approx(noise, abs=0.02)
    assert np.std(features) / spread == pytest.approx(0.378, abs=0.01)


def test_w5_a_step_of_light_is_followed_in_a_few_frames() -> None:
    """The published predictor follows at once, and overshoots; the delayed one follows later."""
    published, delayed = step_response(False), step_response(True)
    assert published[1] < 0.75
    assert published[4] == pytest.approx(1, abs=0.12)
    assert published[8:17].max() > 1.02
    assert delayed[1] < published[1] - 0.1
    assert delayed[8] == pytest.approx(1, abs=0.15)


def step_response(is_delayed: bool) -> Array:
    """The mean picture 1, 2, ... frames after a step to three times the light."""
    rng = np.random.default_rng(5)
    wrls = FactoredWrls(noisy(rng, 4000, 0.2), is_delayed)
    for _ in range(30):
        wrls.add(noisy(rng, 4000, 0.2))
    after = [wrls.add(noisy(rng, 4000, 0.2, 0.9))[:, 0].mean() / 0.9 for _ in range(20)]
    return np.array([np.nan, *after])


def test_w6_fireflies_weigh_little() -> None:
    """1 % of samples, fifty times as bright: about half the noise of least squares
    without weights (0.53); the predictor holds a quarter of each firefly."""
    weighted, plain = firefly_noise(0.75), firefly_noise(np.inf)
    assert weighted < 0.6 * plain


def firefly_noise(width: float) -> float:
    rng = np.random.default_rng(6)
    frames = [
        noisy(rng, 1000, 0.2) * np.where(rng.random((1000, 1)) < 0.01, 50, 1) for _ in range(60)
    ]
    wrls = FactoredWrls(frames[0], width=width)
    return float(np.std([wrls.add(radiance) for radiance in frames[1:]][20:]))


def test_w7_wide_weights_are_plain_least_squares() -> None:
    rng = np.random.default_rng(7)
    frames = [noisy(rng, 50, 0.3) for _ in range(40)]
    wide, plain = FactoredWrls(frames[0], width=1e9), FactoredWrls(frames[0], width=np.inf)
    for radiance in frames[1:]:
        assert wide.add(radiance) == pytest.approx(plain.add(radiance), rel=1e-9)


def wrong(shown: Array, spread: float) -> Array:
    """Pixels off by more than five standard deviations and a fifth."""
    off = np.abs(shown - 0.3 * GREY) > max(5 * spread, 0.2) * 0.3 * GREY
    return np.asarray((off | ~np.isfinite(shown)).any(axis=1))


@pytest.mark.slow
@pytest.mark.parametrize(("spread", "limit"), [(0.5, False), (0.05, True)])
def test_w4_the_usual_form_fails_in_float32_with_the_bound_and_without(
    spread: float, limit: bool
) -> None:
    """It fails within 12,000 still frames of grey light; its factors have not failed by then."""
    rng = np.random.default_rng(8)
    usual = Wrls(noisy(rng, 500, spread), limit=limit, dtype=np.float32)
    factored = FactoredWrls(usual.radiance, dtype=np.float32)
    failed = np.zeros(500, bool)
    with np.errstate(all="ignore"):
        for frame in range(12000):
            radiance = noisy(rng, 500, spread)
            both = usual.add(radiance), factored.add(radiance)
            if frame > 50:  # models of few frames follow rare samples
                failed |= wrong(both[0], spread)
                assert not wrong(both[1], spread).any()
    assert failed.mean() > 0.03


# --- in GLSL -------------------------------------------------------------------------------------

FILES = [f"{name}.glsl" for name in ("film/finite", "temporal/least_squares", "temporal/wrls")]
RECURSION = """
layout(std430) readonly buffer Frames { float values_[]; };
vec3 frame_at(int pixel, int frame) {
    int first = 3 * (COUNT * frame + pixel);
    return vec3(values_[first], values_[first + 1], values_[first + 2]);
}
Prediction after_all(int pixel) {
    Prediction last = first_prediction(frame_at(pixel, 0), float(FIRST));
    for (int frame = 1; frame < FRAMES; frame += 1) {
        vec3 y = frame_at(pixel, frame);
        Model before = last.model;
        last = predicted(before, y, y - float(REACH), y + float(REACH), float(WEIGHT), IS_DELAYED);
    }
    return last;
}
"""


def glsl_wrls(
    gl: moderngl.Context,
    expression: str,
    samples: Array,
    is_delayed: bool = False,
    frames: int = 1,
    reach: int = 1_000_000,
    functions: str = RECURSION,
    first: int = 1,
) -> Array:
    """A vec4 of `last`, the prediction after samples (count, n, 3), for each of n pixels."""
    count, n, _ = samples.shape
    sizes = {"FRAMES": count, "COUNT": n, "REACH": reach, "WEIGHT": frames, "FIRST": first}
    setup, constants = (
        "Prediction last = after_all(pixel);",
        {**sizes, "IS_DELAYED": is_delayed},
    )
    files = [*FILES, "temporal/wrls_rows.glsl"]
    probe = Probe(expression, "vec4", setup, functions, files, constants)
    buffer = gl.buffer(np.ascontiguousarray(samples, np.float32).tobytes())
    result = probe.run(gl, {"pixel": np.arange(n)}, {"Frames": buffer})
    buffer.release()
    return result


@pytest.mark.slow_cases("1-True", "2-False")
@pytest.mark.parametrize("is_delayed", [False, True])
@pytest.mark.parametrize("frames", [1, 2])
def test_the_shader_does_what_the_twin_does(
    ctx: moderngl.Context, is_delayed: bool, frames: int
) -> None:
    rng = np.random.default_rng(9)
    samples = rng.gamma(3, 0.2, (25, 100, 3)).astype(np.float32)
    twin = FactoredWrls(samples[0], is_delayed)
    for radiance in samples[1:]:
        shown = twin.add(radiance, frames=frames)
    got = glsl_wrls(ctx, "vec4(last.radiance, last.weight)", samples, is_delayed, frames)
    assert got[:, :3] == pytest.approx(shown, rel=2e-3, abs=2e-4)
    assert got[:, 3] == pytest.approx(twin.weight / frames, rel=1e-3, abs=1e-6)
    state = glsl_wrls(
        ctx, "vec4(last.model.feature, last.model.views)", samples, is_delayed, frames
    )
    assert state == pytest.approx(np.c_[twin.feature, np.full(100, 25)], rel=1e-4)
    trace = (twin.spread * np.square(twin.factor).sum(axis=1)).sum(axis=1)
    found = glsl_wrls(ctx, "vec4(trace(last.model.fit), 0, 0, 0)", samples, is_delayed, frames)
    assert found[:, 0] == pytest.approx(trace, rel=2e-2)


@pytest.mark.parametrize("first", [2, 50])
def test_a_model_that_begins_with_a_mean_of_samples_holds_on_to_it(
    ctx: moderngl.Context, first: int
) -> None:
    """It is as if equal samples had come one by one: certain only in the directions seen."""
    rng = np.random.default_rng(11)
    samples = rng.gamma(3, 0.2, (6, 40, 3)).astype(np.float32)
    twin = FactoredWrls(samples[0], frames=first)
    one_by_one = FactoredWrls(samples[0], forgetting=1.0)
    for _ in range(first - 1):
        one_by_one.add(samples[0])
    known = 1 / (1 / 1000 / np.square(twin.p).sum(axis=1) + first - 1)
    held = FactoredWrls(samples[0], frames=first, forgetting=1.0)
    for model in (held, one_by_one):
        spread = np.einsum("nij,ni->nj", model.factor, twin.p)
        variance = (model.spread * spread**2).sum(axis=1)
        assert variance == pytest.approx(known, rel=1e-6)
    for radiance in samples[1:]:
        shown = twin.add(radiance)
    got = glsl_wrls(ctx, "vec4(last.radiance, 0.0)", samples, first=first)
    assert got[:, :3] == pytest.approx(shown, rel=2e-3, abs=2e-4)


def test_the_covariance_of_the_shader_is_bounded_and_its_weights_are_not_zero(
    ctx: moderngl.Context,
) -> None:
    """Where no sample varies, nothing is learnt: forgetting alone goes on."""
    still = np.full((1200, 4, 3), 0.3, np.float32)
    assert glsl_wrls(ctx, "vec4(trace(last.model.fit))", still) == pytest.approx(4000, rel=1e-4)
    jump = np.concatenate([np.full((5, 4, 3), 0.3), np.full((1, 4, 3), 3e4)])
    assert glsl_wrls(ctx, "vec4(last.weight)", jump, True) == pytest.approx(1e-12)


def test_what_overflows_begins_again(ctx: moderngl.Context) -> None:
    samples = np.full((6, 3, 3), 0.3, np.float32)
    samples[3:] = [[[3e38] * 3, [0.5] * 3, [3e38, 1e-30, 0.1]]]
    got = glsl_wrls(ctx, "vec4(last.radiance, last.model.views)", samples)
    assert np.isfinite(got).all()
    assert got[:, 3].tolist() == [1, 6, 1]
    assert got[0, :3] == pytest.approx(3e38, rel=1e-6)


def test_the_feature_before_is_kept_within_the_neighbourhood(ctx: moderngl.Context) -> None:
    """5 is out of reach of 1: the feature is that of 1 and of 1 + 2, three quarters of it."""
    samples = np.stack([np.full((2, 3), 5.0), np.full((2, 3), 1.0)])
    got = glsl_wrls(ctx, "vec4(last.model.feature, 0.0)", samples, reach=2)
    assert got[:, :3] == pytest.approx(0.25 * 1 + 0.75 * 3, rel=1e-6)


def test_a_model_survives_its_texels(ctx: moderngl.Context) -> None:
    """Written as rows and read again, it predicts the same, bit for bit."""
    samples = np.random.default_rng(10).gamma(3, 0.2, (12, 50, 3)).astype(np.float32)
    through = RECURSION.replace("before = last.model", "before = model_of(rows_of(last.model))")
    assert through != RECURSION
    direct = glsl_wrls(ctx, "vec4(last.radiance, last.weight)", samples)
    again = glsl_wrls(ctx, "vec4(last.radiance, last.weight)", samples, functions=through)
    assert (direct == again).all()
