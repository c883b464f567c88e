"""Walking, without a window: its speed, and the point that drags turn about."""

import math
from types import SimpleNamespace
from typing import Any

import pytest

from glrt.image.sources import load
from glrt.scene.scene import Scene
from glrt.scene.values import LARGEST
from glrt.view.camera_moves import CameraMoves
from glrt.view.state.preferences import Preferences
from glrt.view.viewport import orbit

STEPS = 40
SECONDS = 0.1


class Walker(CameraMoves):
    def __init__(self) -> None:
        session: Any = SimpleNamespace(scene=load("cornell"), edit=self._edit)
        self.session, self.preferences = session, Preferences()
        self.pivot = session.scene.camera.look_at

    def _edit(self, scene: Scene, _: str) -> None:
        self.session.scene = scene  # type: ignore[misc]


@pytest.mark.parametrize("way", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, 0)])
def test_a_walk_keeps_its_speed_and_the_distance_to_the_pivot(way: tuple[int, int, int]) -> None:
    """A walk goes past the former pivot: steps towards it do not get shorter."""
    walker = Walker()
    start, reach = walker.camera, walker.reach
    for _ in range(STEPS):
        walker.walk(*way, SECONDS)
    expected = STEPS * SECONDS * walker.preferences.walk_speed * reach
    assert expected > reach
    assert math.dist(walker.camera.position, start.position) == pytest.approx(expected, rel=1e-5)
    assert walker.reach == pytest.approx(reach, rel=1e-5)


def test_the_pivot_stays_where_it_would_be_beyond_all_lengths() -> None:
    walker = Walker()
    far = walker.camera.model_copy(update={"position": (0.9 * LARGEST, 0.0, 0.0)})
    point = (0.5 * LARGEST, 0.0, 0.0)
    assert orbit.carried(point, walker.camera, far) == point
    assert orbit.carried((1.0, 2.0, 3.0), walker.camera, walker.camera) == (1.0, 2.0, 3.0)
