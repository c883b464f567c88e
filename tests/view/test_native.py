"""The full screen, on monitors that are played."""

from types import SimpleNamespace
from typing import Any

import pytest

from glrt.view import native
from glrt.view.native import Native

MONITORS = {"left": (0, 0), "right": (1920, 0)}
MODE = SimpleNamespace(size=(1920, 1080), refresh_rate=60)


class Desktop:
    """The functions of GLFW that the window uses, with a window at `place`."""

    FALSE, AUTO_ICONIFY = 0, 1

    def __init__(self, place: tuple[int, int, int, int]) -> None:
        self.place = place
        self.put: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        answers: dict[str, Any] = {
            "get_window_pos": self.place[:2],
            "get_window_size": self.place[2:],
            "get_monitors": list(MONITORS),
            "get_primary_monitor": "left",
            "get_video_mode": MODE,
        }
        return lambda *_: answers.get(name)

    def get_monitor_pos(self, monitor: str) -> tuple[int, int]:
        return MONITORS[monitor]

    def set_window_monitor(self, _window: Any, *where: Any) -> None:
        self.put.append(where)


def opened(monkeypatch: pytest.MonkeyPatch, place: tuple[int, int, int, int]) -> Any:
    desktop = Desktop(place)
    monkeypatch.setattr(native, "glfw", desktop)
    monkeypatch.setattr(native, "glfw_window_hello_imgui", object)
    return Native(print), desktop


@pytest.mark.parametrize(
    ("place", "monitor"),
    [
        ((100, 80, 1240, 800), "left"),
        ((1400, 80, 1240, 800), "right"),
        ((5000, 5000, 100, 100), "left"),
    ],
)
def test_the_monitor_of_the_windows_middle_is_filled(
    monkeypatch: pytest.MonkeyPatch, place: tuple[int, int, int, int], monitor: str
) -> None:
    window, desktop = opened(monkeypatch, place)
    window.toggle_full_screen()
    assert window.is_full_screen
    assert desktop.put == [(monitor, 0, 0, 1920, 1080, 60)]


def test_the_window_comes_back_to_its_place_once(monkeypatch: pytest.MonkeyPatch) -> None:
    place = 100, 80, 1240, 800
    window, desktop = opened(monkeypatch, place)
    window.leave_full_screen()
    assert desktop.put == []
    window.toggle_full_screen()
    desktop.place = 0, 0, 1920, 1080
    window.toggle_full_screen()
    assert not window.is_full_screen
    window.leave_full_screen()
    assert desktop.put[1:] == [(None, *place, 0)]
