"""Paths as lines, and the view from outside, against paths that are known."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.image.sources import load
from glrt.rendering.paths.values import Contribution, Path, PathVertex
from glrt.view.viewport.outline import projected
from glrt.view.viewport.path_lines import FOV, Ball, lines_of, outside, surroundings


def vertex(*place: float, **more: Any) -> PathVertex:
    values: dict[str, Any] = {
        "event": "matte",
        "position": place,
        "normal": (0, 1, 0),
        "shading_normal": (0, 1, 0),
        "object": 0,
        "name": "floor",
        "material": "white",
        "distance": 1.0,
        "throughput": (1, 1, 1),
        "direction": (0, 1, 0),
        "pdf": 1.0,
        "survival": 1.0,
    }
    return PathVertex(**{**values, **more})


def light(at: int, strategy: str, distance: float | None, hidden: bool = False) -> Contribution:
    return Contribution(
        vertex=at,
        strategy=strategy,
        source="object",
        object=1,
        name="lamp",
        radiance=(1, 1, 1),
        direction=(0, 1, 0),
        distance=distance,
        pdf=1.0,
        other_pdf=1.0,
        weight=0.5,
        added=(1, 1, 1),
        hidden=hidden,
    )


def path(*lights: Contribution, end: str = "absorbed") -> Path:
    vertices = vertex(0, 0, 4, event="camera"), vertex(0, 0, 0), vertex(1, 0, 0)
    return Path(
        sample=3,
        radiance=(1, 1, 1),
        end=end,
        vertices=vertices,
        contributions=lights,
    )


def told(found: Path) -> list[tuple[str, list[float], list[float]]]:
    return [
        (line.kind, line.start.tolist(), line.end.tolist())
        for line in lines_of(found, 10.0, (0.0, 0.0, 9.0))
    ]


CAMERA, FLOOR, WALL = [0.0, 0.0, 4.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]


def test_segments_join_the_vertices() -> None:
    assert told(path()) == [("path", CAMERA, FLOOR), ("path", FLOOR, WALL)]


def test_a_path_that_leaves_goes_on_as_far_as_is_looked() -> None:
    assert told(path(end="left the scene"))[-1] == ("escape", WALL, [1.0, 10.0, 0.0])


@pytest.mark.parametrize(("hidden", "kind"), [(False, "sampled"), (True, "hidden")])
def test_sampled_points_are_as_far_as_they_are(hidden: bool, kind: str) -> None:
    lines = told(path(light(1, "light sampling", 2.5, hidden), light(2, "scattering", None)))
    assert lines[2:] == [(kind, FLOOR, [0.0, 2.5, 0.0])]


@pytest.mark.parametrize("distance", [None, math.inf])
def test_a_sun_is_far_away(distance: float | None) -> None:
    assert told(path(light(2, "light sampling", distance)))[-1][2] == [1.0, 10.0, 0.0]


@pytest.mark.parametrize(("yaw", "pitch"), [(0, 0), (35, 25), (200, -80)])
def test_a_ball_fills_the_view_from_outside(yaw: float, pitch: float) -> None:
    ball = Ball(np.array([1.0, 2.0, 3.0]), 0.5)
    camera = outside(ball, yaw, pitch)
    away = np.subtract(camera.position, ball.center)
    assert math.asin(ball.radius / np.linalg.norm(away)) < math.radians(FOV) / 2
    rng = np.random.default_rng(1)
    points = rng.normal(size=(100, 1, 3))
    points = ball.center + 0.5 * points / np.linalg.norm(points, axis=2, keepdims=True)
    places = projected(np.repeat(points, 2, axis=1), camera, 1.0, 1e-3)
    assert ((places > 0) & (places < 1)).all()
    assert np.ptp(places[:, 0], axis=0).min() > 0.7


def test_planes_and_far_things_do_not_make_the_view_from_outside_small() -> None:
    scene = load("cornell")
    ball = surroundings(scene, path())
    assert ball.radius < 4
    for place in (scene.camera.position, (0, 0, 4), (1, 0, 0)):
        assert np.linalg.norm(np.subtract(place, ball.center)) <= 1.001 * ball.radius


def test_a_particle_is_linked_to_the_camera_from_where_it_was_seen() -> None:
    found = Path(
        sample=0,
        radiance=(1, 1, 1),
        particle=7,
        end="linked to the camera",
        vertices=(vertex(0, 1, 0, event="lamp"), vertex(0, 0, 0), vertex(1, 0, 0)),
        contributions=(light(1, "particle", None), light(2, "particle", None)),
    )
    lines = lines_of(found, 10.0, (0.0, 0.0, 9.0))
    assert [line.kind for line in lines] == ["path", "path", "linked", "linked"]
    assert [line.start.tolist() for line in lines[2:]] == [[0, 0, 0], [1, 0, 0]]
    assert all(line.end.tolist() == [0, 0, 9] for line in lines[2:])
