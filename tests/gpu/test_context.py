"""Which of the contexts that a machine offers is taken, with routes that only say what they are."""

from types import SimpleNamespace
from typing import Any

import pytest

from glrt.core.errors import ContextError
from glrt.gpu import context
from glrt.gpu.context import open_context

CLOSED = "no access"  # to a device
Devices = list[str]  # of EGL: what renders, or CLOSED


def offered(monkeypatch: pytest.MonkeyPatch, devices: Devices) -> list[str]:
    """Let EGL offer these and no other route anything; the list holds what is given back."""
    released: list[str] = []

    def create(route: str, device: int, _required: int) -> Any:
        if route != "egl" or device >= len(devices):
            raise RuntimeError(f"there is no {route} {device}")
        name = devices[device]
        if name == CLOSED:
            raise RuntimeError(f"{name} to {device}")
        info = {"GL_RENDERER": name}
        return SimpleNamespace(info=info, version_code=460, release=lambda: released.append(name))

    monkeypatch.setattr(context, "_create", create)
    monkeypatch.setattr(context, "_has_display", lambda: True)
    return released


@pytest.mark.parametrize("choice", ["egl", "auto"])
@pytest.mark.parametrize("closed", [0, 1, 2])
def test_devices_that_are_closed_leave_the_next_one(
    monkeypatch: pytest.MonkeyPatch, choice: Any, closed: int
) -> None:
    offered(monkeypatch, [CLOSED] * closed + ["llvmpipe"])
    assert open_context(choice).renderer == "llvmpipe"


def test_hardware_is_taken_before_software_that_comes_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    released = offered(monkeypatch, [CLOSED, "llvmpipe", "NVIDIA H200", "AMD"])
    assert open_context("auto").renderer == "NVIDIA H200"
    assert released == ["llvmpipe"]


def test_why_the_first_device_failed_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, [CLOSED, CLOSED])
    with pytest.raises(ContextError, match="egl: no access to 0; window: there is no window 0"):
        open_context("auto")
