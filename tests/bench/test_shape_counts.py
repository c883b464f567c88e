"""The sweep over the number of spheres runs, and its table says what was measured."""

import numpy as np
import pytest

from bench import shape_counts
from bench.shape_counts import FIRST, KINDS, crowd, main, measure, table
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.shapes.sphere import Sphere


@pytest.mark.parametrize("count", [16, 485])
def test_balls_of_a_crowd_stand_on_the_floor_and_do_not_touch(count: int) -> None:
    balls = [shape for shape in crowd(count).objects if isinstance(shape, Sphere)]
    center = np.array([ball.center for ball in balls])
    radius = np.array([ball.radius for ball in balls])
    assert len(balls) == count
    assert np.allclose(center[:, 1], radius)
    apart = np.linalg.norm(center[:, None] - center[None], axis=2) - radius - radius[:, None]
    assert apart[~np.eye(count, dtype=bool)].min() > 0
    assert 0.15 < np.pi * np.square(radius).sum() / 4 < 0.35, "the share of the floor"


@pytest.mark.parametrize("kind", KINDS)
def test_shapes_of_all_kinds_lie_within_their_balls(kind: str) -> None:
    balls, shapes = crowd(50).objects[:-1], crowd(50, kinds=[kind]).objects[:-1]
    assert {shape.shape for shape in shapes} == {kind}
    for ball, shape in zip(balls, shapes, strict=True):
        assert np.allclose(ball.middle, shape.middle, atol=0.2)
        assert shape.reach <= max(other.reach for other in balls) * (1 + 1e-9)


def test_kinds_take_turns_below_a_mesh() -> None:
    kinds = [it.shape for it in crowd(5, kinds=["box", "disk"], mesh=2).objects]
    assert kinds == ["box", "disk", "box", "disk", "box", "mesh", "plane"]


@pytest.mark.slow
def test_shapes_are_in_the_tree_of_a_mesh_or_outside(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_tree: list[bool] = []
    seconds = shape_counts._seconds

    def noted(renderer: Renderer) -> float:
        in_tree.append(renderer.plan.needs.has_tree)
        return seconds(renderer)

    monkeypatch.setattr(shape_counts, "_seconds", noted)
    (row,) = measure(context, [40], size=8, rounds=2, kinds=["sphere", "box"], mesh=2)
    assert in_tree == 2 * [True, False]
    assert row.gain


@pytest.mark.slow
def test_each_crowd_is_measured_with_a_tree_and_without(context: Context) -> None:
    rows = measure(context, [40, FIRST], size=8, rounds=3)
    assert [row.number for row in rows] == [40, FIRST]
    for row in rows:
        assert row.loop_seconds
        assert row.gain
        assert row.gain[1] <= row.gain[0] <= row.gain[2]
    assert rows[1].growth == (1, 1, 1)
    lines = list(table(rows, 64))
    assert len(lines) == 4
    assert f"{64 / rows[0].tree_seconds / 1e6:.2f}" in lines[2]


@pytest.mark.slow
@pytest.mark.usefixtures("loop_limit")
def test_a_crowd_beyond_the_loop_limit_is_measured_with_a_tree_alone(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["--counts", "6000", "--size", "8", "--rounds", "2"]) == 0
    (line,) = (line for line in capsys.readouterr().out.splitlines() if "6,000" in line)
    assert line.split("|")[3].strip() == "refused"
    quads = ["--shape", "quad", "--counts", "40", "--size", "8", "--rounds", "2"]
    assert main(quads) == 0
    assert "| quads | set-up" in capsys.readouterr().out


@pytest.mark.slow
def test_the_loop_is_in_constants_up_to_as_many_balls_as_are_asked_for(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    tiers: list[str] = []
    seconds = shape_counts._seconds

    def noted(renderer: Renderer) -> float:
        tiers.append(renderer.tier)
        return seconds(renderer)

    monkeypatch.setattr(shape_counts, "_seconds", noted)
    measure(context, [39, 40], size=8, rounds=2, constants=39)
    assert tiers == 2 * ["generic", "generic", "complete", "generic"]  # by tree, then one by one
