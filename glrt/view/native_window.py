"""The window on the desktop: its title, and files that are dropped on it."""

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
