"""The stated cost of an edit is true over the whole range of its control."""

import pytest

from glrt.plan.plan import Plan, prepare
from glrt.settings import Cost
from glrt.view.edits.scene_edits import with_material
from glrt.view.state.costs import (
    cost_of_light,
    cost_of_tint,
    limit_beyond,
    reach_of_bounces,
    reach_of_size,
    traced_bounces,
)
from glrt.view.state.session import Session
from tests.support.sessions import start


def live(session: Session, bounces: int) -> Plan:
    """The film of a session that keeps the light of each bounce apart."""
    session.edit(bounces=bounces)
    session.by_length = True
    start(session)
    assert session.renderer
    return session.renderer.plan


@pytest.mark.slow_cases("0-0-recompile")
@pytest.mark.parametrize(
    ("traced", "reach", "beyond"),
    [
        (0, 0, Cost.RECOMPILE),
        (3, 3, Cost.RECOMPILE),
        (5, 5, Cost.RESTART),
        (6, 4, Cost.RESTART),
        (10, 4, Cost.RESTART),
    ],
)
def test_the_label_of_bounces_reports_how_far_the_layers_reach(
    session: Session, traced: int, reach: int, beyond: Cost
) -> None:
    plan = live(session, traced)
    assert reach_of_bounces(session) == (reach, beyond)
    for bounces in range(12):
        settings = session.settings.model_copy(update={"bounces": bounces})
        cost = plan.cost_of(session.scene, settings, "lengths")
        if bounces == traced:
            assert cost is Cost.FREE
        else:
            assert cost is (Cost.RELIGHT if bounces <= reach else beyond), bounces


def test_an_edit_of_bounces_costs_what_its_label_says(session: Session) -> None:
    live(session, 10)
    for bounces, cost in ((4, Cost.RELIGHT), (1, Cost.RELIGHT), (7, Cost.RESTART)):
        reach, beyond = reach_of_bounces(session) or (-1, Cost.FREE)
        assert cost is (Cost.RELIGHT if bounces <= reach else beyond)
        session.edit(bounces=bounces)
        session.advance(0.01)
        assert session.last_cost is cost


def test_the_limit_that_was_traced_is_reported_while_fewer_bounces_are_shown(
    session: Session,
) -> None:
    live(session, 10)
    for bounces, traced in ((10, 10), (4, 10), (1, 10), (7, 7)):
        session.edit(bounces=bounces)
        start(session)
        assert traced_bounces(session) == traced
        assert limit_beyond(session) == (None if traced == bounces else traced)


def test_undo_covers_bounces_live(session: Session) -> None:
    start(session)
    session.by_length = True
    start(session)
    assert session.layering == "lengths"
    session.undo()
    assert not session.by_length
    session.redo()
    assert session.by_length


def test_a_channel_that_no_lamp_sent_has_no_light_to_weigh(session: Session) -> None:
    start(session)
    assert cost_of_tint(session, "lamp") is Cost.RELIGHT
    session.edit(with_material(session.scene, "lamp", emission=(3.0, 0.0, 3.0)))
    start(session)
    assert cost_of_tint(session, "lamp") is Cost.RELIGHT, "it was traced in white"
    session.edit(seed=3)
    start(session)
    assert cost_of_tint(session, "lamp") is Cost.RESTART
    assert cost_of_light(session, "lamp") is Cost.RELIGHT


def test_a_size_that_has_no_room_for_layers_is_another_kernel(session: Session) -> None:
    session.room.largest = 100  # pixels: three layers of 33 fit side by side
    session.edit(seed=3)
    start(session)
    assert session.renderer
    layers = session.renderer.plan.layers
    assert reach_of_size(session, "width") == (100 // layers, Cost.RECOMPILE)
    assert reach_of_size(session, "height") == (50, Cost.RECOMPILE)
    plain = prepare(session.scene, session.settings, "none")
    assert session.renderer.plan.cost_of(plain.scene, plain.settings, "none") is Cost.RECOMPILE
    session.edit(width=100 // layers + 1)
    start(session)
    assert session.last_cost is Cost.RECOMPILE
