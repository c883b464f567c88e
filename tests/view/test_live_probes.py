"""Live probes in the window: they go on while edits follow one another, and rest after."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.scene.scene import with_lights
from glrt.settings import Settings, settings_for
from glrt.view.state.live_probes import kept_by_probes, notice_of_lag
from glrt.view.state.preview_size import STILL
from glrt.view.state.session import Session
from tests.support.images import same_bits
from tests.support.renders import rendered
from tests.support.sessions import Clock, frames, start, walked

WAY: dict[str, Any] = {"width": 16, "height": 16, "method": "ddgi", "probes": 2, "sampler": "sobol"}
Opened = Callable[[], Session]


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def opened(context: Context, clock: Clock) -> Iterator[Opened]:
    """A session by `ddgi` with a picture of 4 samples."""
    sessions: list[Session] = []

    def open_one() -> Session:
        scene = load("lamps")
        session = Session(scene, settings(), context, clock)
        sessions.append(session)
        start(session)
        session.advance(10.0, count=4)
        return session

    with context.gl:
        yield open_one
        for session in sessions:
            session.release()


def settings() -> Settings:
    return settings_for(load("lamps").render, **WAY, samples=96)


def dim(session: Session, factor: float) -> None:
    group = sorted(finish.group for finish in session.scene.finishes if finish.group)[0]
    session.edit(with_lights(session.scene, {group: factor}))
    session.advance(10.0, count=1)


def test_probes_go_on_while_edits_follow_one_another(opened: Opened) -> None:
    session = opened()
    assert session.lag == 0.0
    dim(session, 0.5)
    assert session.lag == pytest.approx(HYSTERESIS)
    frames(session, 3)  # the picture begins again with each, though nothing is edited
    assert session.lag == pytest.approx(HYSTERESIS**4)
    dim(session, 0.25)
    assert session.lag == pytest.approx(HYSTERESIS)


def test_a_walk_of_the_camera_changes_no_light(opened: Opened) -> None:
    session = opened()
    dim(session, 0.5)
    session.edit(walked(session.scene))
    session.advance(10.0, count=1)
    assert session.lag == pytest.approx(HYSTERESIS**2)


@pytest.mark.slow
def test_at_rest_the_picture_is_one_of_its_own(
    opened: Opened, clock: Clock, context: Context
) -> None:
    session = opened()
    dim(session, 0.5)
    with pytest.raises(UsageError, match="live"):
        session.image()
    assert session.is_passing
    assert not session.is_done
    clock.now += 2 * STILL
    for _ in range(40):
        session.advance(10.0, count=4)
    assert session.lag == 0.0
    assert not session.is_passing
    image = session.image()
    expected = rendered(session.scene, context, image.samples, **WAY)
    assert same_bits(image.radiance, expected.radiance)


def test_a_pause_ends_live_probes(opened: Opened) -> None:
    session = opened()
    dim(session, 0.5)
    frames(session, 1)
    session.paused = True
    before = session.restarts
    frames(session, 4)
    assert session.restarts == before


def test_methods_without_probes_are_left_alone() -> None:
    assert kept_by_probes(settings(), is_moving=True) == HYSTERESIS
    assert kept_by_probes(settings(), is_moving=False) is None
    assert kept_by_probes(settings_for(settings(), method="mis"), is_moving=True) is None


def test_the_lag_is_reported_while_there_is_one() -> None:
    assert notice_of_lag(0.0) == ""
    assert "61%" in notice_of_lag(0.97**16)
