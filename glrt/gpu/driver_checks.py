"""Measure the driver: when it ends loops, how it rounds, whether it heeds `precise`.

OpenGL promises little of this and reports none of it. A renderer measures the loop limit alone;
`glrt doctor` prints everything.
"""

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.evaluate import Probe

Array = np.ndarray[Any, Any]

MOST_ROUNDS = 1 << 17  # rounds in the test of loops; a driver that runs them all has no limit
# Limit of llvmpipe in Mesa 22, beyond which all loops of a SIMD group end. Mesa 25 has none.
LLVMPIPE_ROUNDS = 65_535
ROWS = 1 << 14  # inputs of the other tests

_limits: dict[tuple[str, str], int] = {}  # by renderer and version, measured once in a process


@dataclass(frozen=True)
class SelfTest:
    """Results of the driver's tests. Errors are the largest over ROWS inputs."""

    loop_limit: int  # rounds; MOST_ROUNDS if no limit was found
    hashes_equal: bool  # hashes equal those of Python's integers, to the last bit
    precise_kept: bool  # nothing `precise` is fused or reordered
    fuses_without: bool  # arithmetic that is not `precise` is fused or reordered
    ulps: dict[str, float]  # errors by expression, in units of the result's last place
    trig_error: float  # largest error of sin and cos over [0, 2 pi], in units of 2^-24


def self_test(context: Context) -> SelfTest:
    """Run every test; they compile several programs, 0.1 s on a software driver."""
    limit = measured_loop_limit(context)
    with context.gl as gl:
        return SelfTest(
            loop_limit=limit,
            hashes_equal=_hashes_equal(gl),
            precise_kept=not _rounding_changes(gl, "precise "),
            fuses_without=_rounding_changes(gl, ""),
            ulps=_ulps(gl),
            trig_error=_trig_error(gl),
        )


def usable_rounds(context: Context) -> int | None:
    """Return how many loop rounds a dispatch may plan, a twelfth below the limit; None: any number.

    One invocation measures the limit in a dispatch of its own. Without compute shaders, a software
    driver is taken for llvmpipe in Mesa 22.
    """
    if not context.has_compute:
        return _with_reserve(LLVMPIPE_ROUNDS) if context.is_software else None
    limit = measured_loop_limit(context)
    return None if limit >= MOST_ROUNDS else _with_reserve(limit)


def _with_reserve(limit: int) -> int:
    return limit - limit // 12


def measured_loop_limit(context: Context) -> int:
    """Return after how many rounds the driver ends an invocation's loops; MOST_ROUNDS if never.

    The rounds of all loops add up, including nested ones, and the last look at a loop's condition
    is a round. llvmpipe in Mesa 22 counts rounds in which any lane of a SIMD group takes part.
    """
    key = context.renderer, context.version
    if key not in _limits:
        with context.gl as gl:
            _limits[key] = _count_rounds(gl)
    return _limits[key]


def _count_rounds(gl: moderngl.Context) -> int:
    """Run a loop whose end depends on data, so that no compiler can know it; return its rounds."""
    count = Probe(
        "count",
        "uint",
        setup="uint count = 0u; for (uint k = 0u; k < rounds; ++k) if (++count == never) break;",
    )
    given = {"rounds": [MOST_ROUNDS], "never": [2 * MOST_ROUNDS]}
    found = count.run(gl, {name: np.array(value, np.uint32) for name, value in given.items()})
    return int(found[0])


def _hashes_equal(gl: moderngl.Context) -> bool:
    inputs = np.arange(ROWS, dtype=np.uint32) * np.uint32(0x9E3779B9)
    found = Probe("pcg_hash(x)", "uint", includes=["sampling/hash.glsl"]).run(gl, {"x": inputs})
    return bool(found.tolist() == [pcg_hash(int(x)) for x in inputs])


def pcg_hash(x: int) -> int:
    """Compute `pcg_hash` of sampling/hash.glsl in Python's integers, modulo 2^32."""
    state = (x * 747796405 + 2891336453) % 2**32
    word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737 % 2**32
    return (word >> 22) ^ word


_ROUNDING = """
vec2 lost_digits(float a, float b) {{
    {precise}float sum = a + b;
    {precise}float part = sum - a;
    {precise}float lost = (a - (sum - part)) + (b - part);
    {precise}float product = a * b;
    {precise}float fused = a * b - product;
    return vec2(lost, fused);
}}"""


def _rounding_changes(gl: moderngl.Context, qualifier: str) -> bool:
    """Return whether the driver rearranges Knuth's sum, or computes a * b - a * b as not 0."""
    a, b = _numbers(-20, 20)[: ROWS // 2], _numbers(-20, 20)[ROWS // 2 :]
    # One line: the loader adds `precise` where a line begins with a declaration.
    text = " ".join(_ROUNDING.format(precise=qualifier).split())
    found = Probe("lost_digits(a, b)", "vec2", functions=text).run(gl, {"a": a, "b": b})
    total = a + b
    part = total - a
    lost = (a - (total - part)) + (b - part)
    return not (np.array_equal(found[:, 0], lost) and not found[:, 1].any())


def _ulps(gl: moderngl.Context) -> dict[str, float]:
    """Return the errors, in ulps, of functions that kernels use, over the ranges that they use."""
    x, y = _numbers(-40, 40), _numbers(-40, 40)[::-1].copy()
    unit = _numbers(-12, 0)
    exact = {
        "sqrt(x)": np.sqrt(x.astype(np.float64)),
        "x / y": x.astype(np.float64) / y,
        "exp2(z)": np.exp2(np.linspace(-16, 16, ROWS, dtype=np.float32).astype(np.float64)),
        "pow(u, w)": np.power(unit.astype(np.float64), np.float64(np.float32(1 / 2.4))),
    }
    z = np.linspace(-16, 16, ROWS, dtype=np.float32)
    inputs = {"x": x, "y": y, "z": z, "u": unit, "w": np.full(ROWS, 1 / 2.4, np.float32)}
    return {name: _worst(Probe(name).run(gl, inputs), truth) for name, truth in exact.items()}


def _worst(found: Array, truth: Array) -> float:
    spacing = np.spacing(np.abs(truth).astype(np.float32)).astype(np.float64)
    return float(np.max(np.abs(found - truth) / spacing))


def _trig_error(gl: moderngl.Context) -> float:
    angle = np.linspace(0, 2 * np.pi, ROWS, dtype=np.float32)
    found = Probe("vec2(sin(x), cos(x))", "vec2").run(gl, {"x": angle})
    exact = np.stack([np.sin(angle.astype(np.float64)), np.cos(angle.astype(np.float64))], axis=-1)
    return float(np.abs(found - exact).max() * 2**24)


def _numbers(low: int, high: int) -> Array:
    """Return ROWS floats, spread over the binary exponents from `low` to `high`."""
    random = np.random.default_rng(1)
    values: Array = np.exp2(random.uniform(low, high, ROWS)).astype(np.float32)
    return values
