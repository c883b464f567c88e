"""The benchmark runs, and its table and file say what was measured."""

import json
from pathlib import Path

import pytest

from bench.kernels import TARGET_ERROR, VARIANTS, main, measure, table
from glrt.gpu.context import Context


def test_each_variant_gets_a_row_against_the_first(context: Context) -> None:
    rows = measure(context, "cornell", "mis", size=16, rounds=3, seconds=0.001)
    assert [row.variant for row in rows] == [variant.name for variant in VARIANTS]
    assert rows[0].ratio == rows[0].ratio_low == rows[0].ratio_high == 1
    for row in rows:
        assert row.ratio_low <= row.ratio <= row.ratio_high
        samples = row.relative_variance / TARGET_ERROR**2
        seconds = samples * 16 * 16 / row.samples_per_second
        assert row.seconds_to_target == pytest.approx(seconds)


def test_figures_are_printed_and_saved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "bench.json"
    line = "--scenes sky --methods mis --size 8 --rounds 2 --seconds 0.001 --json"
    assert main([*line.split(), str(file)]) == 0
    rows = json.loads(file.read_text())["rows"]
    printed = capsys.readouterr().out
    assert "processors" in printed
    assert printed.count("| sky | mis |") == len(rows) == len(VARIANTS)
    assert len(list(table([]))) == 2


def test_unknown_scene_is_reported_in_one_paragraph(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--scenes", "ski", "--rounds", "2"]) == 2
    assert "sky" in capsys.readouterr().err
