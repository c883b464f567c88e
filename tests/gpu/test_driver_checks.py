"""The checks of the driver, whether they would show failures, and the scheduler's reaction."""

from dataclasses import asdict, dataclass, replace

import moderngl
import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.doctor.report import findings
from glrt.gpu import driver_checks
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import (
    MOST_ROUNDS,
    SelfTest,
    measured_loop_limit,
    self_test,
    usable_rounds,
)
from glrt.rendering.schedule import most_samples
from tests.conftest import CallGlsl


@dataclass(frozen=True)
class Driver:
    """As much of a context as a loop limit needs that is known already."""

    renderer: str
    version: str = "4.6"
    has_compute: bool = True
    is_software: bool = True


def driver(monkeypatch: pytest.MonkeyPatch, renderer: str, limit: int) -> Context:
    monkeypatch.setitem(driver_checks._limits, (renderer, "4.6"), limit)
    return Driver(renderer)  # type: ignore[return-value]


def test_this_driver_computes_what_the_renderer_takes_for_granted(context: Context) -> None:
    found = self_test(context)
    assert found.hashes_equal
    assert found.precise_kept
    assert found.ulps.keys() == {"sqrt(x)", "x / y", "exp2(z)", "pow(u, w)"}
    assert found.ulps["sqrt(x)"] <= 3  # GLSL 4.3, section 4.7.1: 2 of inversesqrt, and a division
    assert found.ulps["x / y"] <= 2.5
    assert found.trig_error <= 2**13  # 2^-11, what WGSL asks for; GLSL asks for nothing


def test_loops_end_where_the_scheduler_believes(context: Context, call_glsl: CallGlsl) -> None:
    """All loops of a SIMD group together, with the last look at each condition; or never."""
    limit = measured_loop_limit(context)
    nested = """
        uvec2 count = uvec2(0u);
        for (uint k = 0u; k < rounds; ++k) {
            count.x += 1u;
            for (uint j = 0u; j < inner; ++j) if (++count.y == never) break;
        }"""
    outer, inner = call_glsl("count", "uvec2", setup=nested, **rounds(inner=10))[0].tolist()
    if limit == MOST_ROUNDS:
        assert (outer, inner) == (MOST_ROUNDS, 10 * MOST_ROUNDS)
    else:
        assert abs(outer * (1 + 10 + 1) - limit) < 12
        assert 10 * (outer - 1) <= inner <= 10 * outer
    in_turn = "uint count = 0u; for (uint k = 0u; k < mine; ++k) if (++count == never) break;"
    mine = 10_000 * np.arange(1, 9, dtype=np.uint32)
    counts = call_glsl("count", "uint", setup=in_turn, mine=mine, **rounds())
    assert counts.tolist() == np.minimum(mine, limit).tolist()


def test_rounds_of_any_lane_count(context: Context, call_glsl: CallGlsl) -> None:
    """Four lanes take turns: each runs 30,000 rounds, and one of them in 96,000 together."""
    limit = measured_loop_limit(context)
    turns = """
        uint count = 0u;
        for (uint k = 0u; k < outer; ++k) {
            if (k / 1000u % 4u != lane % 4u) continue;
            for (uint j = 0u; j < inner; ++j) if (++count == never) break;
        }"""
    lanes = np.arange(64, dtype=np.uint32)
    counts = call_glsl("count", "uint", setup=turns, lane=lanes, **rounds(outer=8000, inner=10))
    assert counts.max() == 20_000
    assert (counts.min() < 20_000) == (limit < 96_000)


def rounds(**more: int) -> dict[str, np.ndarray[tuple[int], np.dtype[np.uint32]]]:
    given = {"rounds": MOST_ROUNDS, "never": 1 << 30, **more}
    return {name: np.array([value], np.uint32) for name, value in given.items()}


def test_wrong_random_numbers_are_seen(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert driver_checks.pcg_hash(0) == 129708002
    assert driver_checks._hashes_equal(ctx)
    right = driver_checks.pcg_hash
    monkeypatch.setattr(driver_checks, "pcg_hash", lambda x: right(x) ^ (x == 0))
    assert not driver_checks._hashes_equal(ctx)


@pytest.mark.parametrize(
    ("written", "fused"),
    [("(a - (sum - part)) + (b - part)", "0.0"), ("a * b - product", "1e-9 * product")],
)
def test_rounding_against_the_text_is_seen(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, written: str, fused: str
) -> None:
    assert not driver_checks._rounding_changes(ctx, "precise ")
    assert written in driver_checks._ROUNDING
    monkeypatch.setattr(driver_checks, "_ROUNDING", driver_checks._ROUNDING.replace(written, fused))
    assert driver_checks._rounding_changes(ctx, "precise ")


def test_each_version_of_llvmpipe_is_taken_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    older = driver(monkeypatch, "llvmpipe (LLVM 15)", 65_535)
    assert 60_000 < (usable_rounds(older) or 0) <= 65_535
    assert usable_rounds(driver(monkeypatch, "llvmpipe (LLVM 99)", MOST_ROUNDS)) is None


def test_other_drivers_are_taken_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    assert usable_rounds(driver(monkeypatch, "A card", MOST_ROUNDS)) is None
    rounds = usable_rounds(driver(monkeypatch, "A slow one", 12_000))
    assert rounds == 11_000
    assert most_samples(1000, rounds) == 11
    with pytest.raises(SceneError, match="11001 rounds of its loops"):
        most_samples(11_001, rounds)
    assert most_samples(10**9, None) == 1024


def test_without_compute_nothing_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    """A software driver is taken for llvmpipe, a GPU for one without a limit."""
    monkeypatch.setattr(driver_checks, "_count_rounds", lambda _: pytest.fail("measured"))
    for name in ("llvmpipe (LLVM 99)", "softpipe"):
        old = usable_rounds(Driver(name, has_compute=False))  # type: ignore[arg-type]
        assert 60_000 < (old or 0) <= 65_535
    assert usable_rounds(Driver("Apple M1", "4.1", False, False)) is None  # type: ignore[arg-type]


def test_a_loop_limit_is_measured_once_a_process(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    measured_loop_limit(context)
    monkeypatch.setattr(driver_checks, "_count_rounds", lambda _: pytest.fail("measured again"))
    measured_loop_limit(context)


def test_the_doctor_names_what_is_wrong() -> None:
    good = SelfTest(MOST_ROUNDS, True, True, True, {"sqrt(x)": 0.5}, 1.2)
    text = "\n".join(findings(asdict(good)))
    assert "run for 131,072 rounds and more" in text
    assert "fused or reordered" in text
    bad = replace(good, loop_limit=1000, hashes_equal=False, precise_kept=False)
    text = "\n".join(findings(asdict(bad)))
    assert "end silently after 1,000 rounds" in text
    assert "WRONG" in text
    assert "NOT KEPT" in text
