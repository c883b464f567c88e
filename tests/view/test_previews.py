"""Edits in a row are followed by coarse pictures; then the whole one comes back."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError, UsageError
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Cost
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_material, with_object
from glrt.view.state.preview_size import COARSEST, FACTORS, FIRST_SAMPLES, STILL
from glrt.view.state.session import Session
from tests.support.sessions import Clock, frames, start, walked

BALL = 2  # number of an object
NONE = 1e-9  # seconds: time for one dispatch of one tile


def shifted(scene: Scene, aside: float = 0.05) -> Scene:
    x, y, z = scene.objects[BALL].middle
    return with_object(scene, BALL, replaced(scene.objects[BALL], center=(x + aside, y, z)))


EDITS: dict[str, Callable[[Session], None]] = {
    "camera": lambda session: session.edit(walked(session.scene), "camera"),
    "place": lambda session: session.edit(shifted(session.scene), "object"),
    "color": lambda session: session.edit(
        with_material(session.scene, "white", color=(0.1, 0.2, 0.3)), "white"
    ),
    "bounces": lambda session: session.edit(gesture="bounces", bounces=2),
    "seed": lambda session: session.edit(seed=5),
    "size": lambda session: session.edit(gesture="width", width=32),
}


def learn(session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """Learn that a sample takes twice the time of a frame of 0.01 s."""
    start(session)
    clock.step = 0.02
    with monkeypatch.context() as patch:
        patch.setattr(Renderer, "advance", lambda renderer, *_: renderer.step(1))
        session.restart()
        for _ in range(FIRST_SAMPLES):
            session.advance(0.01)
    assert not session.is_preview


def size_of(session: Session) -> tuple[int, int]:
    assert session.renderer
    return session.renderer.size


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_that_restarts_is_shown_coarsely_when_samples_are_slow(
    session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    learn(session, clock, monkeypatch)
    EDITS[name](session)
    session.advance(0.01)
    whole = session.settings.size
    assert session.last_cost is Cost.RESTART
    assert session.is_preview
    assert not session.is_done
    shown = [tuple(round(side / factor) for side in whole) for factor in FACTORS[1:]]
    assert size_of(session) in shown
    clock.now += STILL
    session.advance(0.01)
    assert not session.is_preview
    assert size_of(session) == whole


@pytest.mark.slow_cases("{'method': 'naive'}")
@pytest.mark.parametrize(
    "edit", [{"exposure": 1.0}, {"samples": 2000}, {"method": "naive"}], ids=str
)
def test_other_edits_stay_at_full_size(
    session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch, edit: dict[str, Any]
) -> None:
    learn(session, clock, monkeypatch)
    session.edit(gesture="a slider", **edit)
    for _ in range(4):
        session.advance(0.01)
        assert not session.is_preview
    assert not session.is_behind


def test_a_fast_renderer_follows_at_full_size(session: Session) -> None:
    start(session)
    for edit in EDITS.values():
        edit(session)
        session.advance(10.0, count=1)
        assert not session.is_preview


def test_a_refused_edit_leaves_the_picture_as_it_is(
    session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise SceneError("too many shapes")

    learn(session, clock, monkeypatch)
    before, restarts = session.state, session.restarts
    with monkeypatch.context() as patch:
        patch.setattr(Renderer, "update", refuse)
        session.edit(shifted(session.scene), width=48)
        session.advance(0.01)
    session.advance(0.01)
    assert session.problem == "too many shapes"
    assert session.state == before
    assert session.restarts == restarts
    assert not session.is_preview


def test_a_coarse_picture_gets_its_sample_though_edits_go_on(
    context: Context, session: Session, clock: Clock
) -> None:
    """Each frame does a tile of four, and has an edit: the picture is never given up."""
    session.edit(width=16 * COARSEST, height=16 * COARSEST)
    start(session)
    clock.step = 1.0  # seconds: every frame takes longer than what counts as a pause
    pictures = set()
    for _ in range(24):
        session.edit(shifted(session.scene, 0.01), "object")
        session.advance(NONE)
        if session.samples:
            pictures.add(session.restarts)
    assert size_of(session) == (16, 16)
    assert len(pictures) >= 4
    assert session.is_preview
    clock.step = 0.001
    frames(session, 1)
    while session.is_preview or session.samples < 3:
        clock.now += STILL
        frames(session, 1)
    fresh = Renderer(session.scene, session.settings, context).render(session.samples)
    assert (fresh.image().radiance == session.image().radiance).all()
    fresh.release()


def test_a_coarse_picture_is_not_given_out(
    session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    learn(session, clock, monkeypatch)
    session.edit(shifted(session.scene), "object")
    session.advance(0.01)
    with pytest.raises(UsageError, match="all pixels"):
        session.image()


def test_an_output_that_the_driver_refuses_is_done_without(
    session: Session, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first surface of a preview takes two, which a scene may have no room for."""
    update = Renderer.update

    def refuse_aovs(renderer: Renderer, *scene: Any, **changes: Any) -> Any:
        if changes["aov"]:
            raise SceneError("beyond this driver's loop limit")
        return update(renderer, *scene, **changes)

    learn(session, clock, monkeypatch)
    session.surface.judge(np.random.default_rng(1).integers(0, 256, (60, 80, 4), np.uint8))
    monkeypatch.setattr(Renderer, "update", refuse_aovs)
    wanted = shifted(session.scene)
    session.edit(wanted, "object")
    for _ in range(4):
        session.advance(0.01)
    assert session.renderer
    assert session.renderer.scene == wanted
    assert session.surface.is_apt
    assert not session.surface.is_wanted
    assert not session.problem
