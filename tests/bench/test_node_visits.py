"""How many nodes of the tree are looked at: counted, and averaged over rays and over lanes."""

import numpy as np
import pytest

from bench import node_visits
from bench.node_visits import looks_of, main, per_lanes, per_ray
from bench.shape_counts import crowd
from glrt.gpu.context import Context
from tests.support.builders import MATTE, scene_of, sphere


def test_lanes_wait_for_the_one_that_looks_at_the_most() -> None:
    counts = np.zeros((2, 2, 1, 8), np.float32)  # samples, rays of a path
    counts[0, 0] = 3
    counts[0, 0, 0, 5] = 7
    counts[1, 0] = 2
    counts[0, 1, 0, 0] = 9  # the first pixel makes its second ray beside the next sample of others
    assert per_ray(counts) == pytest.approx((7 * 3 + 7 + 8 * 2 + 9) / 17)
    assert per_lanes(counts) == pytest.approx((7 + 9 + 2) / 3)


@pytest.mark.slow
def test_a_ray_away_from_all_spheres_looks_at_one_node(context: Context) -> None:
    behind = [sphere([x, 0, 5], 0.4, "m") for x in range(40)]
    scene = scene_of(behind, {"m": MATTE}, {"position": [0, 0, 0], "look_at": [0, 0, -1]})
    assert (looks_of(scene, context, 8, 1)[:, 0] == 1).all()


@pytest.mark.slow
def test_rays_among_balls_look_at_some_nodes_and_not_at_all(context: Context) -> None:
    counts = looks_of(crowd(200), context, 8, 2)
    assert counts.shape == (2, 11, 8, 8)
    assert 3 < per_ray(counts) <= per_lanes(counts) < 30
    assert not np.array_equal(counts[0], counts[1]), "each sample has its own rays"


@pytest.mark.slow
def test_the_table_has_a_row_a_scene(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(node_visits, "SIZE", 8)
    monkeypatch.setattr(node_visits, "SAMPLES", 1)
    assert main(["--spheres", "100"]) == 0
    rows = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| ")]
    assert [row.split("|")[1].strip() for row in rows] == ["scene", "100 spheres", "`weekend`"]
