"""Replies of a picture without a notebook, and what their files show."""

import io
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glrt.notebook.live import Live
from glrt.notebook.messages import Reply
from glrt.view.state.session import ANNOUNCED

Opening = Callable[..., Live]


def codes(reply: Reply) -> NDArray[np.int64]:
    """Pixels of the picture in a reply, (H, W, 3)."""
    assert reply.picture
    with Image.open(io.BytesIO(reply.picture)) as shown:
        assert Image.MIME[shown.format or ""] == reply.content["type"]
        return np.asarray(shown.convert("RGB")).astype(np.int64)


def asked(live: Live, count: int = 1, **given: Any) -> Reply:
    """The last of so many replies; the first question has the input."""
    reply = live.answer(given)
    for _ in range(count - 1):
        reply = live.answer({})
    return reply


def begun(live: Live) -> Reply:
    """The first reply with a picture."""
    return asked(live, ANNOUNCED + 1)


def samples(reply: Reply) -> int:
    """The number of samples that a reply reports."""
    return int(reply.content["figures"][0].split()[0])


def row(reply: Reply, key: str) -> dict[str, Any]:
    """A row of a reply by its key."""
    found: dict[str, Any] = next(row for row in reply.content["rows"] if row["key"] == key)
    return found


def costs(reply: Reply, key: str) -> list[str]:
    """The costs of a row."""
    return [it["cost"] for it in row(reply, key)["costs"]]
