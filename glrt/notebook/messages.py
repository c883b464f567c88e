"""Messages between a page and a picture: input in, a picture with its figures out."""

from typing import Any, Literal, NamedTuple, get_args

from pydantic import Field

from glrt.editable import Frozen
from glrt.view.controls import made

Edited = Literal["bounces", "samples"]  # settings that the page has sliders for
EDITED: tuple[Edited, ...] = get_args(Edited)
LIGHT = "light "  # before the name of a light group, in the key of a row


class Asked(Frozen):
    """Input since the page last asked for a picture."""

    turn: tuple[float, float] = Field(
        (0.0, 0.0), description="drag across and down, in shares of the picture's width and height"
    )
    wheel: float = Field(0.0, description="clicks of the wheel, above 0 towards the scene")
    home: bool = Field(False, description="whether to return to the first view, before all else")
    settings: dict[Edited, int] = Field({}, description="new values of settings")
    lights: dict[str, float] = Field({}, description="new intensities, by light group")


NOTHING = Asked()


class Reply(NamedTuple):
    """The reply of a picture: values of JSON, and a picture file if there is something new."""

    content: dict[str, Any]
    picture: bytes | None = None


def asked_of(message: Any) -> Asked:
    """Return the input in a message of the page; UsageError for a message of another form."""
    return made(Asked, message if isinstance(message, dict) else {"message": message})
