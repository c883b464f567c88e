"""Temporal modes on the samples of a still pixel: long series, and fireflies."""

from dataclasses import dataclass

import numpy as np

from glrt.gpu.evaluate import Probe
from glrt.lab.sweep import Array, Lab, Sweep

PORTION = 1 << 11  # frames per dispatch, below the loop limit of software drivers
STATE = 9  # rows of a pixel
FILES = [f"{name}.glsl" for name in ("film/finite", "temporal/least_squares", "temporal/wrls")]
FILES += ["temporal/wrls_rows.glsl", "sampling/hash.glsl", "sampling/unit_float.glsl"]
GREY = (0.3, 0.24, 0.18)  # radiance: white light on one surface, so that channels are proportional
FORMS = {"as published": 0, "trace of the covariance bounded": 1}
CHOSEN = "glrt: U D U^T, trace bounded"
SAMPLES = """
layout(std430) buffer State { vec4 state_[]; };

// Gamma noise of a mean of 1 and a standard deviation of 1 / 2.
float gamma_noise(int pixel, int frame) {
    float product = 1.0;
    for (int k = 0; k < 4; k += 1) {
        product *= unit_float(pcg_hash(pcg_hash(uint(4 * pixel + k)) + uint(frame)));
    }
    return -0.25 * log(max(product, 1e-30));
}
vec3 sample_of(int pixel, int frame) {
    return gamma_noise(pixel, frame) * vec3(%s);
}
bool is_wrong(vec3 shown) {
    return !is_finite(shown) || any(greaterThan(abs(shown / vec3(%s) - 1.0), vec3(2.5)));
}
""" % ((", ".join(map(str, GREY)),) * 2)
"""A prediction is wrong if it is off by more than five standard deviations of a sample."""
OURS = """
int wrong_frames(int pixel, int first, int count) {
    Rows rows;
    for (int j = 0; j < 7; j += 1) rows.row[j] = state_[STATE * pixel + j];
    Prediction last = first_prediction(sample_of(pixel, 0), 1.0);
    if (first > 1) last.model = model_of(rows);
    int wrong = 0;
    for (int frame = first; frame < first + count; frame += 1) {
        vec3 y = sample_of(pixel, frame);
        last = predicted(last.model, y, vec3(-1e9), vec3(1e9), 1.0, false);
        wrong += int(is_wrong(last.radiance));
    }
    rows = rows_of(last.model);
    for (int j = 0; j < 7; j += 1) state_[STATE * pixel + j] = rows.row[j];
    return wrong;
}
"""
USUAL = """
int wrong_frames(int pixel, int first, int count) {
    mat4 P = mat4(START_COVARIANCE);
    mat4x3 slopes = mat4x3(sample_of(pixel, 0), vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 z = sample_of(pixel, 0);
    if (first > 1) {
        for (int j = 0; j < 4; j += 1) {
            P[j] = state_[STATE * pixel + j];
            slopes[j] = state_[STATE * pixel + 4 + j].xyz;
        }
        z = state_[STATE * pixel + 8].xyz;
    }
    int wrong = 0;
    for (int frame = first; frame < first + count; frame += 1) {
        vec3 y = sample_of(pixel, frame);
        z = y + FEATURE_SHARE * (z - y);
        vec4 p = vec4(1.0, z);
        vec4 spread = P * p;
        vec4 gain = spread / (FORGETTING / sample_weight(y, z) + dot(p, spread));
        slopes += outerProduct(y - slopes * p, gain);
        P = (P - outerProduct(gain, spread)) / FORGETTING;
        P = 0.5 * (P + transpose(P));
        float sum = P[0].x + P[1].y + P[2].z + P[3].w;
        if (IS_BOUNDED && sum > MOST_TRACE) P *= MOST_TRACE / sum;
        wrong += int(is_wrong(slopes * p));
    }
    for (int j = 0; j < 4; j += 1) {
        state_[STATE * pixel + j] = P[j];
        state_[STATE * pixel + 4 + j] = vec4(slopes[j], 0.0);
    }
    state_[STATE * pixel + 8] = vec4(z, 0.0);
    return wrong;
}
"""
MARKS = (50, 300, 1000, 3000, 10_000, 30_000, 100_000)


@dataclass(frozen=True)
class Series:
    """A form of least squares, as GLSL."""

    text: str
    is_bounded: bool = False

    def wrong_shares(self, lab: Lab, pixels: int) -> list[float]:
        """The share of predictions that are wrong, from each mark of MARKS to the next."""
        constants = {"STATE": STATE, "IS_BOUNDED": self.is_bounded}
        probe = Probe(
            "wrong_frames(pixel, first, count)",
            "int",
            functions=SAMPLES + self.text,
            includes=FILES,
            constants=constants,
        )
        found = []
        with lab.context.gl as gl:
            state = gl.buffer(reserve=16 * STATE * pixels)
            last = 1
            for mark in MARKS:
                wrong, begun = 0, last
                while last < mark:
                    count = min(PORTION, mark - last)
                    given = {"pixel": np.arange(pixels), "first": [last], "count": [count]}
                    counts: Array = probe.run(gl, given, {"State": state})
                    wrong, last = wrong + int(counts.sum()), last + count
                found.append(wrong / ((mark - begun) * pixels))
            state.release()
        return found


def still(lab: Lab) -> Sweep:
    """Predictions of an unchanging pixel, over 100,000 frames of noisy grey light."""
    pixels = lab.count(256, 64)
    errors = {
        name: Series(USUAL, bool(bounded)).wrong_shares(lab, pixels)
        for name, bounded in FORMS.items()
    }
    ours = Series(OURS).wrong_shares(lab, pixels)
    return Sweep(
        parameter="frames of a still pixel",
        measure="share of predictions that are off\nby more than five standard deviations",
        x=MARKS,
        chosen=(CHOSEN, ours),
        others=errors,
        promise="at most 1 in 10,000, from frame 50 to 100,000",
        bound=[1e-4] * len(MARKS),
        guaranteed=[mark > MARKS[0] for mark in MARKS],  # models of few frames follow rare samples
    )


SHARES = (0.001, 0.003, 0.01, 0.03, 0.1)  # of samples that are fireflies
BRIGHT = 50  # times as bright as others
LESS = 0.8
SERIES = 200  # frames; the last half counts
RARE = """
float firefly(int pixel, int frame, float share) {
    uint bits = pcg_hash(pcg_hash(uint(pixel) ^ 0x9E3779B9u) + uint(frame));
    return unit_float(bits) < share ? float(BRIGHT) : 1.0;
}
float shown_of(inout Prediction last, inout float exponential, vec3 y, int way) {
    exponential += 0.1 * (y.x - exponential);
    if (way == EXPONENTIAL) return exponential;
    if (way != UNWEIGHTED) {
        last = predicted(last.model, y, vec3(-1e9), vec3(1e9), 1.0, way == DELAYED);
        return last.radiance.x;
    }
    last.model.feature = y + FEATURE_SHARE * (last.model.feature - y);
    vec4 p = vec4(1.0, last.model.feature);
    last.model.fit = corrected(last.model.fit, p, y, 1.0);
    return (last.model.fit.slopes * p).x;
}
vec2 moments_of(int pixel, float share, int way) {
    Prediction last = first_prediction(sample_of(pixel, 0), 1.0);
    float mean = 0.0, square = 0.0, exponential = sample_of(pixel, 0).x;
    for (int frame = 1; frame < SERIES; frame += 1) {
        vec3 y = firefly(pixel, frame, share) * sample_of(pixel, frame);
        float shown = shown_of(last, exponential, y, way);
        if (2 * frame >= SERIES) {
            mean += shown;
            square += shown * shown;
        }
    }
    return vec2(mean, square);
}
"""
WAYS = {
    "least squares, all samples alike": "UNWEIGHTED",
    "wrls": "PUBLISHED",
    "wrls delayed": "DELAYED",
    "exponential mean, a tenth": "EXPONENTIAL",
}


def outliers(lab: Lab) -> Sweep:
    """Error of the picture of a still pixel, some of whose samples are fifty times as bright.

    The truth is the mean of all other samples: a firefly is taken for noise, not for light.
    """
    pixels = lab.count(4096, 256)
    errors = {
        name: [_off(lab, pixels, way, share) for share in SHARES] for name, way in WAYS.items()
    }
    return Sweep(
        parameter=f"share of samples that are {BRIGHT} times as bright",
        measure="relative RMS error of what is shown",
        x=SHARES,
        chosen=("wrls", errors.pop("wrls")),
        others=errors,
        promise=f"at most {LESS:g} times that of samples that weigh alike, up to 1 %",
        bound=[LESS * error for error in errors["least squares, all samples alike"]],
        guaranteed=[share <= 0.01 for share in SHARES],
    )


def _off(lab: Lab, pixels: int, way: str, share: float) -> float:
    numbers = {other: place for place, other in enumerate(WAYS.values())}
    constants = {"STATE": STATE, "SERIES": SERIES, "BRIGHT": BRIGHT, **numbers}
    call, functions = f"moments_of(pixel, share, {way})", SAMPLES + RARE
    probe = Probe(call, "vec2", functions=functions, includes=FILES, constants=constants)
    with lab.context.gl as gl:
        state = gl.buffer(reserve=16)
        given = {"pixel": np.arange(pixels), "share": [share]}
        found = probe.run(gl, given, {"State": state}).astype(np.float64)
        state.release()
    mean, square = found.mean(axis=0) / (SERIES // 2)
    squared = square - 2 * mean * GREY[0] + GREY[0] ** 2
    return float(np.sqrt(max(squared, 0.0))) / GREY[0]
