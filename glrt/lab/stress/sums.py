"""Many samples: what a running mean loses, what seeds share, what a limit of bounces leaves out."""

import math
from itertools import pairwise
from typing import Any

import numpy as np

from glrt.lab.stress.sweep import Array, Lab, Sweep

PORTION = 1 << 15  # samples a dispatch, below the loop limit of software drivers
DARK, BRIGHT, SHARE = 0.1, 0.9, 0.3  # samples of a pixel on an edge, and how many are bright
SAMPLE = "pcg_hash(seed ^ uint(k) * 0x9E3779B9u) < bright"
GATHER = f"""
    precise float ours = state.x, plain = state.y, sum = state.z, coarse = state.w;
    for (int k = first; k < first + count; ++k) {{
        precise float x = {SAMPLE} ? {BRIGHT} : {DARK};
        precise float w = 1.0 / float(k + 1);
        ours = next_mean(vec3(ours), vec3(x), float(k + 1)).x;
        plain = plain + (x - plain) * w;
        sum = sum + x;
        coarse = unpackHalf2x16(packHalf2x16(vec2(coarse + (x - coarse) * w, 0.0))).x;
    }}"""
MIX = f"""
    precise float mixed = state;
    uint hits = total;
    for (int k = first; k < first + count; ++k) {{
        bool hit = {SAMPLE};
        precise float x = hit ? {BRIGHT} : {DARK};
        precise float w = 1.0 / float(k + 1);
        mixed = mixed * (1.0 - w) + x * w;
        hits += uint(hit);
    }}"""


def frames(lab: Lab) -> Sweep:
    """The mean of an edge pixel's samples, over as many frames as a film may take.

    They have two values, so their sum is known.
    """
    seeds = np.arange(lab.count(64), dtype=np.uint32) * np.uint32(0x85EBCA6B)
    marks = [1 << power for power in range(6, 21, 2)]
    means, mixed = np.zeros((len(seeds), 4)), np.zeros((len(seeds), 2), np.uint32)
    rows = []
    for first, last in pairwise([0, *marks]):
        for start in range(first, last, PORTION):
            portion = {"seed": seeds, "first": [start], "count": [min(PORTION, last - start)]}
            means, mixed = _gather(lab, portion, means, mixed)
        rows.append(_errors(means, mixed, last))
    ours, step, total, coarse, mix = np.array(rows).T.tolist()
    sd = (BRIGHT - DARK) * math.sqrt(SHARE * (1 - SHARE)) / (DARK + SHARE * (BRIGHT - DARK))
    noise = [sd / math.sqrt(count) for count in marks]
    return Sweep(
        parameter="frames accumulated, one sample each",
        measure="relative rms error of the mean",
        x=marks,
        chosen=("glrt: m + (x - m) / n, dithered", ours),
        others={
            "m (1 - 1/n) + x / n": mix,
            "m + (x - m) / n": step,
            "plain sum": total,
            "16-bit film": coarse,
            "noise of the samples": noise,
        },
        promise="at most a tenth of the noise, up to 2^20 frames",
        bound=[0.1 * error for error in noise],
    )


def _gather(lab: Lab, portion: dict[str, Any], means: Array, mixed: Array) -> tuple[Array, Array]:
    """Means with a portion of samples more; `mixed`: the bits of a float, and how many hit."""
    given = {**portion, "bright": np.array([SHARE * 2**32], np.uint32)}
    result = "vec4(ours, plain, sum, coarse)"
    means = lab.path(result, {**given, "state": means}, "vec4", setup=GATHER)
    given |= {"state": mixed[:, 0].copy().view(np.float32), "total": mixed[:, 1].copy()}
    return means, lab.path("uvec2(floatBitsToUint(mixed), hits)", given, "uvec2", setup=MIX)


def _errors(means: Array, mixed: Array, count: int) -> Array:
    """Relative rms errors of the means in GATHER and MIX; those of the exact number of hits."""
    bright, dark = np.float64(np.float32(BRIGHT)), np.float64(np.float32(DARK))
    truth = dark + mixed[:, 1] / count * (bright - dark)
    mix = mixed[:, 0].copy().view(np.float32)
    found = np.column_stack([means * [1, 1, 1 / count, 1], mix])
    rms: Array = np.sqrt(np.mean((found / truth[:, None] - 1) ** 2, axis=0))
    return rms
