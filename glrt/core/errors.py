"""Error classes of glrt, by who can correct the error; each has the exit code of a command."""

from glrt.core.text import escaped


class GlrtError(Exception):
    r"""An error with one paragraph for the user: what is wrong, where, and what to do.

    It is one line of printable text: a line break in a file name is shown as `\n`.
    """

    exit_code = 4

    def __init__(self, paragraph: str) -> None:
        """Escape unprintable characters: quoted text may come from a damaged file."""
        super().__init__(escaped(paragraph))


class UsageError(GlrtError):
    """A command line, a setting or a file name that cannot be used."""

    exit_code = 2


class SceneError(UsageError):
    """A scene that cannot be rendered: names the file and the key."""


class ContextError(GlrtError):
    """No usable OpenGL."""

    exit_code = 3


class RenderError(GlrtError):
    """The render failed: driver, memory or disk."""


class ContentError(ValueError):
    """The mistake in the content of a file, in words for its user: a part of a `SceneError`.

    Readers raise it. Other errors that a damaged file causes have words for programmers, in Python
    or a library: `of_content` says that the content makes no sense instead.
    """


class NothingShownError(ContentError):
    """A file of a model is whole, and shows no triangles; the message says why."""


def of_content(error: Exception) -> str:
    """Return the mistake in a file that has caused an error, without a full stop."""
    if isinstance(error, ContentError):
        return str(error).rstrip(".")
    return "its parts contradict each other, or it is cut off"
