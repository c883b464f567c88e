"""What to do about a system package, or something else of a machine, that is not there."""

import os
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
