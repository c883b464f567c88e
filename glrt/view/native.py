"""The window of the desktop: its title, dropped files, and the full screen."""

from collections.abc import Callable
from typing import Any

from imgui_bundle.glfw_utils import glfw_window_hello_imgui

import glfw  # isort: skip  # the library of imgui_bundle, which must come first


class Native:
    """The open window of this process, for use on the window's thread."""

    def __init__(self, drop: Callable[[str], object]) -> None:
        """`drop` gets the path of a file dropped on the window; of several files, the first."""
        self._window: Any = glfw_window_hello_imgui()
        self._title = ""
        self._place: tuple[int, int, int, int] | None = None  # before the full screen

        def dropped(_window: Any, paths: Any) -> None:
            if paths:
                drop(paths[0])

        listen: Any = glfw.set_drop_callback  # its annotations are those of the C function
        listen(self._window, dropped)

    def entitle(self, title: str) -> None:
        """Set the title of the window."""
        if title != self._title:
            self._title = title
            glfw.set_window_title(self._window, title)

    @property
    def is_full_screen(self) -> bool:
        """Whether the window fills its monitor."""
        return self._place is not None

    def toggle_full_screen(self) -> None:
        """Fill the monitor that shows the middle of the window, or go back to the old place."""
        if self.is_full_screen:
            return self.leave_full_screen()
        x, y = glfw.get_window_pos(self._window)
        width, height = glfw.get_window_size(self._window)
        monitors: Any = glfw.get_monitors()
        middle = x + width / 2, y + height / 2
        chosen = next((it for it in monitors if _shows(it, middle)), glfw.get_primary_monitor())
        if not chosen:
            return None
        self._place = x, y, width, height
        # Without this, the window would vanish when another one is used on a second monitor.
        glfw.set_window_attrib(self._window, glfw.AUTO_ICONIFY, glfw.FALSE)
        mode: Any = glfw.get_video_mode(chosen)
        self._put(chosen, 0, 0, *mode.size, mode.refresh_rate)
        return None

    def leave_full_screen(self) -> None:
        """Go back to the place before the full screen; nothing happens elsewhere."""
        if self._place:
            place, self._place = self._place, None
            self._put(None, *place, 0)

    def _put(self, *where: Any) -> None:
        """Set monitor or None, corner, size in screen coordinates, and rate in Hz or 0."""
        put: Any = glfw.set_window_monitor  # its annotations are those of the C function
        put(self._window, *where)


def _shows(monitor: Any, place: tuple[float, float]) -> bool:
    """Whether a place of the desktop, in screen coordinates, is on a monitor."""
    mode: Any = glfw.get_video_mode(monitor)
    corner = glfw.get_monitor_pos(monitor)
    sides = zip(corner, place, mode.size, strict=True)
    return all(low <= at < low + length for low, at, length in sides)
