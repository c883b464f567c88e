"""The command's garbage collector, which has nothing to find in what imports leave: it stays."""

import gc

from glrt.signals import is_command


def leave_imports_alone() -> None:
    """Where the process is the command: do not look for garbage until `loaded`."""
    if is_command():
        gc.disable()


def loaded() -> None:
    """Look for it in what comes now, neither later nor at exit in what was imported."""
    if is_command():
        gc.freeze()
        gc.enable()
