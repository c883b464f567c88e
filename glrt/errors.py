"""The errors of glrt, by who can correct them; each class has the exit code of the commands."""


class GlrtError(Exception):
    """An error with one paragraph for the user: what is wrong, where, and what to do.

    Control characters are removed: what it quotes may come from a damaged file.
    """

    exit_code = 4

    def __init__(self, paragraph: str) -> None:
        """Make one line of it, without control characters."""
        super().__init__("".join(sign if sign.isprintable() else " " for sign in paragraph))


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
