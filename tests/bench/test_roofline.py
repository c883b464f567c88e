"""The estimate of how near the kernel comes to the machine's peak."""

import pytest

from bench.roofline import AROUND, SEARCH, Peak, main, measure, operations_of_ray, table
from glrt.gpu.context import Context
from glrt.image.sources import load


def test_every_shape_of_a_scene_is_counted() -> None:
    shapes = [shape.shape for shape in load("cornell").objects]
    assert {"sphere", "plane", "quad"} == set(shapes) == set(SEARCH)
    assert operations_of_ray(load("cornell")) == AROUND + sum(SEARCH[shape] for shape in shapes)


@pytest.mark.slow
def test_a_share_is_operations_over_time_over_peak(context: Context) -> None:
    peak, rows = measure(context, ["cornell"], size=8, rounds=1, samples=2)
    assert [row.method for row in rows] == ["naive", "mis"]
    for row in rows:
        assert row.operations == pytest.approx(row.rays * operations_of_ray(load("cornell")))
        assert row.share == pytest.approx(row.operations / row.seconds / peak)
        assert 0 < row.share < 1, "nothing is faster than the peak"
    assert rows[0].rays < rows[1].rays, "mis casts shadow rays"
    assert "cornell | mis" in list(table(rows))[3]


@pytest.mark.slow
def test_the_peak_is_no_less_than_a_core_does_one_by_one(context: Context) -> None:
    """A driver that threw the loop away would be a thousand times as fast."""
    peak = Peak(context)
    rate = peak.operations_per_second()
    peak.release()
    if not context.is_software:
        pytest.skip("this machine renders on hardware")
    assert 1e8 < rate < 1e13


def test_an_unknown_scene_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--scenes", "ski", "--rounds", "2"]) == 2
    assert "ski" in capsys.readouterr().err
