"""Shares of live probes: what the table counts."""

import pytest

from bench.probe_shares import SHARES, measured
from glrt.gpu.context import Context
from tests.truths.test_probes import room


@pytest.mark.slow
def test_half_the_light_is_there_after_as_many_times_the_updates(context: Context) -> None:
    """ln 2 / -ln 0.97 is 22.8 in an almost black room, for all of the probes."""
    rows = measured(room("planes", 0.001), context, 8, 1)
    assert [row.length for row in rows] == [125, 63, 32, 16]
    for share, row in zip(SHARES, rows, strict=True):
        assert row.to_half == pytest.approx(22.8 / share, rel=0.06)
        assert len(row.seconds) == 1
