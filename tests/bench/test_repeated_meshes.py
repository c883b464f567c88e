"""Both ways to keep repeated meshes are measured, and the table says what was measured."""

import pytest

from bench.repeated_meshes import heap, main, measure, table
from glrt.gpu.context import Context


@pytest.mark.slow
def test_each_heap_is_measured_in_both_ways(context: Context) -> None:
    rows = measure(context, [(2, 3), (3, 2)], size=8, rounds=6)
    assert [(row.triangles, row.copies) for row in rows] == [(320, 3), (1280, 2)]
    for row in rows:
        often, once = row.bytes_all
        assert 40 * row.triangles < once < often
        assert min(row.rates) > 0
    heading, _, *lines = table(rows)
    assert "kept once" in heading
    assert [line.split(" |")[:2] for line in lines] == [["| 320", " 3"], ["| 1,280", " 2"]]


def test_copies_share_a_file_and_stand_apart() -> None:
    meshes = heap(1, 5).meshes
    assert len({mesh.file for mesh in meshes}) == 1
    assert len({mesh.translate for mesh in meshes}) == 5


@pytest.mark.slow
def test_the_command_prints_the_machine_and_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--heaps", "1x2", "--size", "8", "--rounds", "6"]) == 0
    assert "8 x 8 pixels, 6 rounds" in capsys.readouterr().out
