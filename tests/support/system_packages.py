"""What to do about a system package that is not there."""

import os

import pytest


def needs_package(is_there: bool, package: str) -> None:
    """Skip the test on a user's machine, fail it in CI: there, everything is installed."""
    if is_there:
        return
    message = f"needs the system package {package}"
    if os.environ.get("CI"):
        pytest.fail(message)
    pytest.skip(message)
