"""Skip or fail where a system package, or something else of a machine, is missing."""

import os
import platform
import shutil
import subprocess
import sys
from ctypes.util import find_library
from importlib.util import find_spec
from typing import Literal, NoReturn, overload

import pytest


@overload
def needs(is_there: Literal[False], what: str) -> NoReturn: ...
@overload
def needs(is_there: bool, what: str) -> None: ...
def needs(is_there: bool, what: str) -> None:
    """Skip the test on a user's machine, fail it in CI: there, everything is installed."""
    if is_there:
        return
    message = f"needs {what}"
    if os.environ.get("CI"):
        pytest.fail(message)
    pytest.skip(message)


def needs_package(is_there: bool, package: str) -> None:
    """The same of a system package, by its name."""
    needs(is_there, f"the system package {package}")


def needs_mitsuba() -> None:
    """Mitsuba, an extra of its own; it has no wheel for Linux except on x86-64."""
    is_there = find_spec("mitsuba") is not None
    if not is_there and sys.platform == "linux" and platform.machine() != "x86_64":
        pytest.skip("Mitsuba has no wheel for this system")
    needs(is_there, "Mitsuba: type pip install 'glrt[mitsuba]'")


def needs_widgets() -> None:
    """The widgets of notebooks, an extra."""
    needs(find_spec("anywidget") is not None, "anywidget: type pip install 'glrt[notebook]'")


def needs_jupyter() -> None:
    """JupyterLab with its kernel, an extra of its own."""
    needs(find_spec("jupyterlab") is not None, "JupyterLab: type pip install 'glrt[jupyter]'")


def needs_osmesa() -> None:
    """OSMesa. Mesa 25.1 removed it: where apt does not know its package, CI skips the test, too."""
    is_there = bool(find_library("OSMesa"))
    if not is_there and not offers("libosmesa6"):
        pytest.skip("this system has no OSMesa: Mesa 25.1 removed it")
    needs_package(is_there, "libosmesa6")


def offers(package: str) -> bool:
    """Whether apt knows a package."""
    command = ["apt-cache", "show", package]
    return (
        bool(shutil.which("apt-cache"))
        and not subprocess.run(command, capture_output=True).returncode
    )
