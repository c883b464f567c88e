"""Why a picture is black; no window is opened."""

import math
from collections.abc import Iterator
from typing import Any

import pytest

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from glrt.view.state.session import ANNOUNCED, Session
from glrt.view.viewport.black import PATHS, Blackness, surrounding
from glrt.view.viewport.picture import Picture
from tests.support.builders import (
    MATTE,
    box,
    box_of_quads,
    cylinder,
    lamp,
    plane,
    room_of_planes,
    scene_of,
    sphere,
)

MATERIALS = {"matte": MATTE, "lamp": lamp(1.0)}
FAR_LAMP = sphere([0, 0, 30], 1.0, "lamp")
BALL, CRATE = sphere([0, 0, 0], 2.0, "matte"), box([-1] * 3, [1] * 3, "matte", [10, 20, 30])
DRUM = cylinder([0, -1, 0], [0, 1, 0], 1.0, "matte")
TUBE = cylinder([0, -1, 0], [0, 1, 0], 1.0, "matte", capped=False)
ON_THREE_SIDES = sphere([1.1, 1.2, -0.7], 1.6, "matte")  # to the right, above and in front
INSIDE = {"position": [0.1, 0.2, 0.3], "look_at": [0.1, 0.2, -1.0]}


def seen(objects: list[Any], lights: dict[str, float] | None = None, **camera: Any) -> Scene:
    scene = scene_of(objects, MATERIALS, {**INSIDE, **camera})
    return scene.model_copy(update={"lights": lights or {}})


@pytest.mark.parametrize(
    ("objects", "expected"),
    [
        ([FAR_LAMP, BALL], 1),
        ([CRATE, FAR_LAMP], 0),
        ([DRUM], 0),
        ([TUBE], None),
        (room_of_planes("matte"), None),
        (box_of_quads("matte"), None),
        ([sphere([5, 0, 0], 2.0, "matte")], None),
        ([ON_THREE_SIDES], None),
        ([FAR_LAMP, BALL, sphere([0.1, 0.2, -0.5], 0.1, "matte")], None),
    ],
)
def test_an_object_around_the_camera_is_known(objects: list[Any], expected: int | None) -> None:
    assert surrounding(seen(objects)) == expected


@pytest.fixture
def looked(context: Context) -> Iterator[Any]:
    """Renders a scene, and reports why it is black."""
    sessions: list[Session] = []
    with context.gl:
        picture = Picture(context.gl)

    def draw_and_look(session: Session, blackness: Blackness) -> None:
        assert session.renderer
        with context.gl:
            picture.draw(session.renderer.weighed(session.weights), session.settings)
            blackness.look(session, picture)

    def look(scene: Scene, samples: int = 16, until: int = 0, **settings: Any) -> str:
        sizes = {"width": 40, "height": 40, "bounces": 2, "samples": samples, **settings}
        session = Session(scene, settings_for(scene.render, **sizes), context)
        sessions.append(session)
        blackness = Blackness()
        for _ in range(ANNOUNCED + (until or samples)):
            with context.gl:
                session.advance(1.0, 1)
            if session.samples:
                draw_and_look(session, blackness)
        assert session.samples == (until or samples)
        return blackness.reason

    yield look
    with context.gl:
        picture.release()
        for session in sessions:
            session.release()


LIT = [plane([0, -1, 0], [0, 1, 0], "matte"), sphere([0, 3, -3], 1.0, "lamp")]
BEHIND = [*LIT, plane([0, -2, 0], [0, 1, 0], "matte")]
BELOW: dict[str, Any] = {"position": [0, -1.5, 0], "look_at": [0, -1.5, -1]}


@pytest.mark.parametrize(
    ("scene", "settings", "words"),
    [
        (seen(LIT), {}, ""),
        (seen(LIT), {"exposure": -20.0}, "Black at this exposure"),
        (seen(LIT, {"lamp": 0.0}), {}, "every light is off"),
        (seen([BALL]), {}, "or there is none"),
        (seen([FAR_LAMP, BALL]), {}, "inside sphere of matte"),
        (seen(BEHIND, **BELOW), {}, "gone through a wall"),
        (seen(BEHIND, **BELOW), {"samples": 3}, "gone through a wall"),
        (seen(LIT, look_at=[0.1, -0.9, 0.2]), {"bounces": 0}, "0 bounces"),
    ],
)
def test_the_reason_is_reported(looked: Any, scene: Scene, settings: Any, words: str) -> None:
    reason = looked(scene, **settings)
    assert words in reason
    assert bool(reason) == bool(words)


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_a_picture_of_few_paths_is_not_judged(looked: Any, share: float) -> None:
    """It may have met no light yet: these are no more than it is to have."""
    samples = math.ceil(PATHS / 1600)
    reason = looked(seen([BALL]), samples=1000, until=math.ceil(share * samples))
    assert bool(reason) == (share == 1.0)


def test_light_that_no_exposure_shows_is_none(looked: Any) -> None:
    """Rays that graze the rim where two walls meet bring 1e-15 of a lamp behind them."""
    dim = scene_of(LIT, {"matte": MATTE, "lamp": lamp(1e-14)}, INSIDE)
    assert "at this exposure" not in looked(dim)
    dark = scene_of(LIT, {"matte": MATTE, "lamp": lamp(1e-5)}, INSIDE)
    assert "at this exposure" in looked(dark)
