"""Sums: rounding of running means, correlation of pixels, truncation by a limit of bounces."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from glrt.lab.scenes import lamp, plane, scene_of
from glrt.lab.sweep import SIGMAS, Array, Lab, Sweep
from glrt.scene.scene import Scene

PORTION = 1 << 15  # samples per dispatch, below the loop limit of software drivers
DARK, BRIGHT, SHARE = 0.1, 0.9, 0.3  # samples of a pixel on an edge, and the share of bright ones
SAMPLE = "pcg_hash(seed ^ uint(k) * 0x9E3779B9u) < bright"
GATHER = f"""
    float ours = state.x, plain = state.y, sum = state.z, coarse = state.w;
    for (int k = first; k < first + count; ++k) {{
        float x = {SAMPLE} ? {BRIGHT} : {DARK};
        float w = 1.0 / float(k + 1);
        ours = next_mean(vec3(ours), vec3(x), float(k + 1)).x;
        plain = plain + (x - plain) * w;
        sum = sum + x;
        coarse = unpackHalf2x16(packHalf2x16(vec2(coarse + (x - coarse) * w, 0.0))).x;
    }}"""
MIX = f"""
    float mixed = state;
    uint hits = total;
    for (int k = first; k < first + count; ++k) {{
        bool hit = {SAMPLE};
        float x = hit ? {BRIGHT} : {DARK};
        float w = 1.0 / float(k + 1);
        mixed = mixed * (1.0 - w) + x * w;
        hits += uint(hit);
    }}"""


def frames(lab: Lab) -> Sweep:
    """Error of the running mean of a pixel on an edge, over up to 2^20 frames.

    Its samples have two values, so the true mean follows from their counts.
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
        measure="relative RMS error of the mean",
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
    """Add a portion of samples to the means; `mixed`: bits of a float, and count of bright ones."""
    given = {**portion, "bright": np.array([SHARE * 2**32], np.uint32)}
    result = "vec4(ours, plain, sum, coarse)"
    means = lab.path(result, {**given, "state": means}, returns="vec4", setup=GATHER)
    given |= {"state": mixed[:, 0].copy().view(np.float32), "total": mixed[:, 1].copy()}
    return means, lab.path("uvec2(floatBitsToUint(mixed), hits)", given, returns="uvec2", setup=MIX)


def _errors(means: Array, mixed: Array, count: int) -> Array:
    """Relative RMS errors of the means in GATHER and MIX, by the exact number of bright samples."""
    bright, dark = np.float64(np.float32(BRIGHT)), np.float64(np.float32(DARK))
    truth = dark + mixed[:, 1] / count * (bright - dark)
    mix = mixed[:, 0].copy().view(np.float32)
    found = np.column_stack([means * [1, 1, 1 / count, 1], mix])
    rms: Array = np.sqrt(np.mean((found / truth[:, None] - 1) ** 2, axis=0))
    return rms


SIDE, BLOCK = 128, 8  # edges of the frame in `seeds` and of the blocks it is judged by, in pixels
SUM = """
    ivec2 pixel = ivec2(i %% SIDE, i / SIDE);
    float sum = 0.0;
    for (int k = 0; k < frames; ++k) {
        uint index = first + uint(k);
        sum += unit_float(%s) - 0.5;
    }""".replace("SIDE", str(SIDE))
SHIFTED = f"pcg_hash(pcg_hash(uint(pixel.y * {SIDE} + pixel.x) + index))"
OURS = "pcg_hash(pixel_seed(pixel, int(index), 7u) ^ STEP)"


def seeds(lab: Lab) -> Sweep:
    """Variance of block means: as expected if pixels share no random numbers.

    The parameter is the number of the first frame.
    """
    x = [1 << power for power in (0, 8, 16, 20, 24, 28, 31)]
    frames = lab.count(256)
    ours: list[float] = []
    shifted: list[float] = []
    for first in x:
        given = {
            "frames": [frames],
            "first": np.array([first - 1], np.uint32),
            "place": np.zeros(SIDE * SIDE, np.int32),
        }
        for found, number in ((ours, OURS), (shifted, SHIFTED)):
            sums = lab.path("sum + 0.0 * float(place)", given, setup=SUM % number)
            found.append(_excess(sums.astype(np.float64) / math.sqrt(frames / 12)))
    blocks = (SIDE // BLOCK) ** 2
    return Sweep(
        parameter="number of the first frame",
        measure=f"relative excess of the noise\nof {BLOCK} x {BLOCK} pixel means",
        x=x,
        chosen=("glrt: pixel, frame and seed hashed together", ours),
        others={"hash of pixel + frame": shifted},
        promise="within 5.3 standard deviations of the expected noise",
        bound=[SIGMAS / math.sqrt(2 * blocks)] * len(x),
    )


def _excess(scores: Array) -> float:
    """|s - 1|; s, the standard deviation of scaled block means, is 1 for independent scores."""
    side = SIDE // BLOCK
    blocks = scores.reshape(side, BLOCK, side, BLOCK).sum(axis=(1, 3)) / BLOCK
    return float(abs(blocks.std() - 1))


def albedo(lab: Lab) -> Sweep:
    """Error of a closed room whose walls emit and reflect: bounce k adds albedo^k."""
    absorbed = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001]
    limits = (1000, 10, 100)
    light = {limit: [_room_light(lab, 1 - x, limit) for x in absorbed] for limit in limits}
    whole = [1 / float(np.float32(x)) for x in absorbed]
    sums = [sum_of_bounces(1 - x, 1000) for x in absorbed]
    lost = {
        f"light lost with {limit} bounces": _relative(light[limit], whole)
        for limit in (10, 100, 1000)
    }
    return Sweep(
        parameter="share of light that a wall absorbs, 1 - albedo",
        measure="relative error of the radiance",
        x=absorbed,
        chosen=("glrt, 1000 bounces, against their sum", _relative(light[1000], sums)),
        others=lost,
        promise="at most 2e-5 from the sum of all bounces",
        bound=[2e-5] * len(absorbed),
    )


def glowing_room(albedo: float) -> Scene:
    """Return a closed room of planes that emit 1."""
    normals = [
        [side if k == axis else 0 for k in range(3)] for axis in range(3) for side in (1, -1)
    ]
    walls = [plane([-x for x in normal], normal, "wall") for normal in normals]
    return scene_of(walls, {"wall": lamp(1, albedo)})


def _room_light(lab: Lab, albedo: float, bounces: int) -> float:
    """Radiance in a closed room of planes that emit 1; without roulette all paths agree."""
    size: dict[str, Any] = {
        "width": 8,
        "height": 8,
        "bounces": bounces,
        "roulette": False,
        "method": "naive",
    }
    image = lab.render(glowing_room(albedo), 1, **size)
    return float(image.radiance.mean(dtype=np.float64))


def sum_of_bounces(albedo: float, bounces: int) -> float:
    """Return 1 + a + ... + a^bounces, with the albedo a rounded to float32 as in the kernel."""
    a = float(np.float32(albedo))
    return (1 - a ** (bounces + 1)) / (1 - a)


def _relative(found: Sequence[float], truth: Sequence[float]) -> list[float]:
    return [abs(a / b - 1) for a, b in zip(found, truth, strict=True)]
