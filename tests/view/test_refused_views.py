"""A view that cannot be had: the picture stays, and it can be had again; no window is opened."""

from typing import Any

import pytest

from glrt.view.state.session import Session
from glrt.view.viewport.picture_view import PictureView
from tests.support.sessions import start

BEYOND = 700  # bounces: more than the loops of software drivers hold for this view


def shown(session: Session, view: PictureView, frames: int = 6) -> None:
    for _ in range(frames):
        view.advance(session, 0.01, 1)


def wanted(show: PictureView) -> str:
    return show.view


@pytest.mark.slow
def test_a_refused_view_is_given_up_and_had_once_the_edit_is_undone(session: Session) -> None:
    """The refusal is of that edit: it is not kept for the view."""
    nothing: Any = None
    show = PictureView(nothing, nothing, nothing, nothing, nothing)
    start(session)
    session.edit(bounces=BEYOND)
    shown(session, show)
    assert not session.problem
    show.view = "bounces"
    shown(session, show)
    assert "--aov bounces is beyond" in session.problem
    assert wanted(show) == "picture"
    session.undo()
    shown(session, show)
    session.problem, show.view = "", "bounces"
    shown(session, show)
    assert wanted(show) == "bounces"
    assert not session.problem
    assert session.renderer
    assert session.renderer.aov_mean("bounces")
