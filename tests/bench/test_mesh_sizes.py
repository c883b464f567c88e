"""The sweep over the number of triangles runs, and its table says what was measured."""

import pytest

from bench.mesh_sizes import cluttered, displaced, main, measure, scene_of, table
from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.scene.shapes.mesh import Mesh


def test_a_ball_is_closed_and_stands_in_an_open_box() -> None:
    mesh = Mesh(*displaced(2), material="clay")
    assert mesh.triangles.opening == ""
    found = SceneFacts(scene_of(mesh))
    assert (found.shapes["mesh"], found.triangles) == (2, 320 + 8)


@pytest.mark.slow
def test_each_mesh_is_measured(context: Context) -> None:
    rows = measure(context, [1, 3], size=8, rounds=6)
    assert [row.triangles for row in rows] == [88, 1288]
    assert rows[0].growth == (1, 1, 1)
    for row in rows:
        assert row.bytes_each > 40
        assert row.rate > 0
    heading, _, *lines = table(rows)
    assert "time over that of 88" in heading
    assert [line.split(" |")[0] for line in lines] == ["| 88", "| 1,288"]


@pytest.mark.slow
def test_the_command_prints_the_machine_and_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--steps", "1", "--size", "8", "--rounds", "6"]) == 0
    told = capsys.readouterr().out
    assert "8 x 8 pixels, 6 rounds" in told
    assert "peak memory" in told


def test_rounds_that_give_no_interval_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["--rounds", "5"])
    assert "--rounds: 5 is less than 6" in capsys.readouterr().err


def test_the_clutter_has_its_triangles() -> None:
    scene = cluttered()
    of_balls = [len(mesh.triangles.faces) for mesh in scene.meshes if mesh.material != "wall"]
    assert sum(of_balls) == 102_400
