"""The widget: it answers pages, and rests when the last one is closed."""

from base64 import b64decode
from types import SimpleNamespace
from typing import Any

import pytest

from glrt.notebook.messages import Reply
from glrt.settings import Settings
from tests.support.system_packages import needs_widgets


class Played:
    """A picture that records its questions."""

    def __init__(self) -> None:
        self.state = SimpleNamespace(settings=Settings(width=20, height=10), scene="a scene")
        self.asked: list[Any] = []
        self.rests = 0
        self.has_still = True

    def answer(self, message: Any) -> Reply:
        self.asked.append(message)
        return Reply({"wait": 0.0}, b"picture" if len(self.asked) > 1 else None)

    def still(self) -> Reply | None:
        return Reply({"type": "image/jpeg"}, b"still") if self.has_still else None

    def rest(self) -> None:
        self.rests += 1


@pytest.fixture
def live() -> Played:
    return Played()


@pytest.fixture
def widget(live: Any, monkeypatch: pytest.MonkeyPatch) -> Any:
    needs_widgets()
    from glrt.notebook.widget import LivePicture

    made: Any = LivePicture(live, "a room")
    made.sent = []
    monkeypatch.setattr(made, "send", lambda *message: made.sent.append(message))
    return made


def test_the_page_gets_the_title_the_size_and_its_program(widget: Any) -> None:
    state = widget.get_state()
    assert state["_title"] == "a room"
    assert state["_size"] == [20, 10]
    assert "export default { render }" in state["_esm"]
    assert ".glrt-show" in state["_css"]
    assert widget.scene == "a scene"


def test_a_saved_notebook_shows_a_still_picture(widget: Any, live: Played) -> None:
    data, _ = widget._repr_mimebundle_()
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == widget.model_id
    assert b64decode(data["image/jpeg"]) == b"still"
    live.has_still = False
    data, _ = widget._repr_mimebundle_()
    assert "image/jpeg" not in data


def test_each_question_gets_a_reply_with_the_name_of_its_page(widget: Any, live: Played) -> None:
    for number in (1, 2):
        widget._hear(widget, {"kind": "ask", "page": "p", "asked": {"wheel": number}}, [])
    assert live.asked == [{"wheel": 1}, {"wheel": 2}]
    assert widget.sent == [
        ({"wait": 0.0, "page": "p"}, None),
        ({"wait": 0.0, "page": "p"}, [b"picture"]),
    ]


def test_it_rests_when_the_last_page_is_closed(widget: Any, live: Played) -> None:
    for page in "pq":
        widget._hear(widget, {"kind": "ask", "page": page, "asked": {}}, [])
    for page, rests in (("x", 0), ("p", 0), ("p", 0), ("q", 1)):
        widget._hear(widget, {"kind": "close", "page": page}, [])
        assert live.rests == rests
    widget.close()
    assert live.rests == 2


def test_messages_of_another_form_are_ignored(widget: Any, live: Played) -> None:
    for message in ("ask", None, {"kind": "ask"}, {"page": "p", "kind": "paint"}):
        widget._hear(widget, message, [])
    assert (live.asked, live.rests) == ([], 0)
