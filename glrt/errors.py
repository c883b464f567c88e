"""What can go wrong, by who can mend it; each class knows the exit code of the commands."""


class GlrtError(Exception):
    """An error with one paragraph for the user: what is wrong, where, and what to do."""

    exit_code = 4


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
