"""The program that measures the choice among many lamps."""

import numpy as np
import pytest

from bench.efficiency import measure_scene
from bench.many_lamps import SCENES, WAYS, main
from glrt.gpu.context import Context
from glrt.plan.facts import MOST_NEAR, SceneFacts


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("count", [2, 400])
def test_a_scene_has_as_many_lamps_as_it_is_asked_for(name: str, count: int) -> None:
    scene = SCENES[name](count)
    assert SceneFacts(scene).sampled_lamps == count
    panels = sum(shape.shape == "quad" for shape in scene.objects)
    assert panels == (count // 2 if name == "mixed" else 0)


@pytest.mark.slow
def test_nearness_takes_noise_from_a_hall_and_none_from_lamps_equally_far(
    context: Context,
) -> None:
    """Variances, by flux alone over by nearness: measured 3 to 5, and 0.8 to 1.1."""
    for name, least, most in (("hall", 2.0, 20.0), ("around", 0.6, 1.6)):
        scene = SCENES[name](2 * MOST_NEAR)
        rows = measure_scene(context, name, scene, 16, 6, WAYS)
        fewer = [row.fewer_samples for row in rows]
        assert fewer[0] == 1
        assert np.all(np.array(fewer[1:]) > least)
        assert np.all(np.array(fewer[1:]) < most)


@pytest.mark.slow
def test_the_table_has_a_row_for_each_way(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["around", "--counts", "40", "--size", "8", "--rounds", "2"]) == 0
    rows = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| around")]
    assert [row.split(" | ")[1] for row in rows] == list(WAYS)
