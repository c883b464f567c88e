"""History in the window: shown while the camera moves, and not where an error is reported."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from glrt.analysis.motion.playing import read_texture
from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history import gbuffer, wrls
from glrt.rendering.history.temporal import END, Way
from glrt.scene.scene import with_lights
from glrt.settings import Cost, settings_for
from glrt.view.controls import replaced
from glrt.view.state.error_history import Progress
from glrt.view.state.preview_size import STILL
from glrt.view.state.session import Session
from tests.support.images import same_bits
from tests.support.renders import rendering
from tests.support.sessions import Clock, start, walked


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def still(clock: Clock) -> Callable[[], None]:
    """Lets so much time pass that edits have come to rest."""

    def pass_time() -> None:
        clock.now += 2 * STILL

    return pass_time


@pytest.fixture
def moving(context: Context, clock: Clock) -> Iterator[Session]:
    """A session that shows history; of 96 samples."""
    scene = load("lamps")
    settings = settings_for(scene.render, width=24, height=16, bounces=2, samples=96)
    session = Session(scene, settings, context, clock)
    session.moving.use(Way("reproject"))
    with context.gl:
        start(session)
        session.advance(0.01, count=8)
        yield session
        session.release()


def is_shown(session: Session) -> bool:
    return session.moving.is_shown(session.renderer, session.settings.samples)


def shows_the_film(session: Session) -> bool:
    """Whether the shown picture is the film, to the last bit."""
    assert session.renderer
    with session.context.gl:
        light = session.renderer.weighed(session.weights)
        texture = session.moving.texture(session.renderer, session.weights)
    with session.context.gl:
        found = read_texture(texture or light)[..., :3].copy()
    return same_bits(found, session.renderer.image(session.weights).radiance)


def walk(session: Session) -> None:
    session.edit(walked(session.scene), "camera")
    session.advance(0.01, count=1)


def test_a_moved_camera_shows_history_until_there_are_samples_enough(moving: Session) -> None:
    """Then the picture has the bits of the film; `image` has them at all times."""
    assert not is_shown(moving)
    walk(moving)
    assert is_shown(moving)
    assert not shows_the_film(moving)
    while moving.samples < END:
        assert is_shown(moving)
        moving.advance(0.01, count=16)
    assert not is_shown(moving)
    assert shows_the_film(moving)


def test_a_picture_of_few_samples_ends_without_history(moving: Session) -> None:
    moving.edit(samples=4)
    walk(moving)
    assert is_shown(moving)
    moving.advance(0.01, count=3)
    assert moving.is_done
    assert not is_shown(moving)


def test_no_error_is_reported_while_history_is_shown(moving: Session) -> None:
    progress = Progress()
    walk(moving)
    moving.advance(0.01, count=40)
    assert moving.samples >= moving.known_from
    assert is_shown(moving)
    with moving.context.gl:
        assert progress.follow(moving, 1000.0) is None
    moving.moving.forget()
    with moving.context.gl:
        assert progress.follow(moving, 2000.0)


def test_other_light_by_weights_ends_history(moving: Session) -> None:
    """The film is right at once: its layers are weighed."""
    walk(moving)
    assert is_shown(moving)
    moving.edit(with_lights(moving.scene, {"blue": 0.25}))
    moving.advance(0.01, count=1)
    assert moving.last_cost is Cost.RELIGHT
    assert not is_shown(moving)


def test_a_picture_begun_again_has_no_history(moving: Session) -> None:
    walk(moving)
    moving.restart()
    moving.advance(0.01, count=1)
    assert not is_shown(moving)


def test_reset_shows_none(moving: Session) -> None:
    moving.moving.use(Way("reset"))
    walk(moving)
    assert not is_shown(moving)


def test_without_room_the_picture_goes_on_without_history(
    moving: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise RenderError("no room")

    monkeypatch.setattr(gbuffer.Surfaces, "begin", refuse)
    walk(moving)
    assert "temporal reset" in moving.problem
    assert moving.samples == 1
    assert not is_shown(moving)


def test_without_room_for_models_the_picture_goes_on_without_history(
    moving: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are first needed where a view is left."""

    def refuse(*_: object) -> None:
        raise RenderError("no room")

    moving.moving.use(Way("wrls"))
    monkeypatch.setattr(wrls.Wrls, "_sized", refuse)
    walk(moving)
    assert "temporal reset" in moving.problem
    assert moving.samples == 1
    assert not is_shown(moving)


def test_without_room_to_show_a_picture_it_is_reported_once(
    moving: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise RenderError("no room")

    moving.moving.use(Way("wrls", "delayed"))
    walk(moving)
    assert is_shown(moving)
    monkeypatch.setattr(wrls.Wrls, "_sized", refuse)
    moving.advance(0.01, count=1)
    assert moving.renderer
    with moving.context.gl, pytest.raises(RenderError, match=r"no room.*temporal reset"):
        moving.moving.texture(moving.renderer, moving.weights)
    assert not is_shown(moving)


def test_views_of_a_move_have_noise_of_their_own_and_a_still_one_that_of_reset(
    moving: Session, still: Callable[[], None]
) -> None:
    """Random numbers that are the same in all views would not cancel."""
    seeds = []
    for step in (0.05, 0.1, 0.15):
        camera = moving.scene.camera
        moving.edit(replaced(moving.scene, camera=replaced(camera, position=(step, 1.9, 8.0))))
        moving.advance(0.01, count=1)
        assert moving.renderer
        seeds.append(moving.renderer.settings.seed)
    assert len({*seeds, moving.settings.seed}) == 4
    still()
    before = moving.restarts
    for _ in range(3):
        moving.advance(0.01, count=1)
    assert moving.restarts == before + 1  # no more than once
    assert moving.renderer
    assert moving.renderer.settings.seed == moving.settings.seed == 0
    assert is_shown(moving)  # over what was seen while it moved
    with rendering(moving.scene, moving.context, **dict(moving.renderer.settings)) as fresh:
        film = fresh.render(moving.samples).image().radiance
    assert same_bits(moving.image().radiance, film)


def test_another_seed_is_taken_at_once(moving: Session) -> None:
    walk(moving)
    moving.edit(seed=7)
    moving.advance(0.01, count=1)
    assert moving.last_cost is Cost.RESTART
    assert moving.renderer
    assert moving.renderer.settings.seed not in (0, 7)  # while edits come in a row


@pytest.mark.slow_cases("roulette", "sampler", "method")  # each compiles another kernel
@pytest.mark.parametrize("name", ["bounces", "roulette", "sampler", "method"])
def test_light_that_other_settings_transport_is_no_history(moving: Session, name: str) -> None:
    """It would be in the picture until END samples; a moved camera brings history again."""
    changes: dict[str, Any] = {
        "bounces": 1,
        "roulette": not moving.settings.roulette,
        "sampler": "independent",
        "method": "nee",
    }
    walk(moving)
    assert is_shown(moving)
    moving.edit(**{name: changes[name]})
    while moving.is_behind:
        moving.advance(0.01, count=1)
    assert moving.samples < END
    assert not is_shown(moving)
    assert shows_the_film(moving)
    back = replaced(moving.scene.camera, position=(0.1, 0.1, 2.6))
    moving.edit(replaced(moving.scene, camera=back), "camera")
    moving.advance(0.01, count=1)
    assert is_shown(moving)
